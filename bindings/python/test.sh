#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the wheel anew, installs it and runs all tests of the Python package: test.sh DIRECTORY [PYTEST OPTIONS]
# DIRECTORY keeps the environment with the packages of tests/requirements.txt, which is made again when these change.
# Needs Python >= 3.11 with its headers and venv, git, and a C compiler.
set -euo pipefail

here=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
if [ $# -eq 0 ]; then
    echo "usage: test.sh DIRECTORY [PYTEST OPTIONS]" >&2
    exit 2
fi
mkdir -p "$1"
directory=$(CDPATH='' cd -- "$1" && pwd)
shift
python=$directory/venv/bin/python
wanted=$here/tests/requirements.txt

say() { printf 'python: %s\n' "$*"; }

make_environment() {
    cmp -s "$wanted" "$directory/requirements.txt" && "$python" -c '' 2>/dev/null && return 0
    say "making $directory/venv"
    python3 -m venv --clear "$directory/venv"
    "$python" -m pip install --quiet --disable-pip-version-check -r "$wanted"
    # trimesh's own tests are in its source distribution alone.
    local trimesh
    trimesh=$(grep '^trimesh==' "$wanted")
    rm -rf "$directory/trimesh"
    "$python" -m pip download --quiet --disable-pip-version-check --no-deps --no-binary :all: \
        -d "$directory/trimesh" "$trimesh"
    tar -xzf "$directory/trimesh"/*.tar.gz -C "$directory/trimesh" --strip-components=1
    cp "$wanted" "$directory/requirements.txt"
}

build_and_install() {
    rm -rf "$directory/build" "$directory/wheel"
    "$python" -m build --no-isolation --wheel --outdir "$directory/wheel" -C builddir="$directory/build" \
        "$here" >"$directory/build.log" 2>&1 || {
        cat "$directory/build.log"
        return 1
    }
    # Without a compiler, as elsewhere.
    CC=false "$python" -m pip install --quiet --disable-pip-version-check --no-deps --no-index --force-reinstall \
        "$directory/wheel"/*.whl
}

make_environment
export PATH="$directory/venv/bin:$PATH"
say "building the wheel"
build_and_install
export RAYGRID_TRIMESH_TESTS=$directory/trimesh/tests MYPY_CACHE_DIR=$directory/mypy PYTHONDONTWRITEBYTECODE=1
cd "$here/tests"
say "style: ruff; types: mypy --strict"
export RUFF_NO_CACHE=true HYPOTHESIS_STORAGE_DIRECTORY=$directory/hypothesis
ruff=(ruff --config "$here/pyproject.toml")
"${ruff[@]}" format --check --diff --quiet "$here" "$here/../../examples/python"
"${ruff[@]}" check --quiet "$here" "$here/../../examples/python"
"$python" -m mypy --strict "$here/raygrid"
"$python" -m mypy --strict typed_use.py
say "docstrings, the README, tests, conformance, examples"
"$python" -m pytest -q -p no:cacheprovider -c "$here/pyproject.toml" --doctest-modules --pyargs raygrid
"$python" -m pytest -q -p no:cacheprovider -c "$here/pyproject.toml" --junitxml "$directory/tests.xml" \
    "$@" . "$here/README.md" "$here/../../README.md"
