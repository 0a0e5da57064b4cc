# SPDX-License-Identifier: MIT
# For script/bench and script/precision, which set $root and define say: Python environments of their own in a build
# directory, and the peer in one of them. The tests need none of this.

# make_environment DIR REQUIREMENTS [PIP OPTIONS]: DIR gets those packages, unless it has them.
make_environment() {
    local directory=$1 wanted=$2
    shift 2
    if cmp -s "$wanted" "$directory/requirements.txt"; then
        return 0
    fi
    say "fetching what ${wanted#"$root"/} names into ${directory#"$root"/}"
    python3 -m venv --clear "$directory" &&
        "$directory/bin/python" -m pip install --quiet --disable-pip-version-check "$@" -r "$wanted" &&
        cp "$wanted" "$directory/requirements.txt"
}

# find_peer BUILD: prints what --embree is to be.
find_peer() {
    local found
    make_environment "$1/.venv" "$root/bench/requirements.txt" --no-deps >&2 ||
        say "could not: see the message above; the system's Embree is taken, if there is one"
    found=$(find "$1/.venv" -name 'libembree4*.so*' -print -quit 2>/dev/null || true)
    printf '%s\n' "${found:-auto}"
}
