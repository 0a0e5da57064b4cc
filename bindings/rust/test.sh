#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs all tests of the Rust crates: test.sh DIRECTORY [--asan | --miri]
# DIRECTORY keeps what is built, and tests.log: a line for each test, as cargo test prints them.
# Needs a C compiler, Meson, libclang, and cargo: that of PATH or of rustup. Lints and formats are those of the oldest
# Rust that the crates promise to build with, which rustup or Debian's rustc-web may have.
# --asan: the tests of the crate raygrid, Rust and C with the address sanitizer. Needs clang, and a toolchain of rustup's.
# --miri: what can run without C, in Miri. Needs rustup's nightly toolchain with the component miri.
set -euo pipefail

here=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
if [ $# -eq 0 ] || [ $# -gt 2 ]; then
    echo "usage: test.sh DIRECTORY [--asan | --miri]" >&2
    exit 2
fi
mkdir -p "$1"
directory=$(CDPATH='' cd -- "$1" && pwd)
only=${2:-}
log=$directory/tests.log
features=raygrid/glam,raygrid/mint,raygrid/serde,raygrid/rayon
oldest=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' "$here/Cargo.toml")

say() { printf 'rust: %s\n' "$*"; }

# check NAME COMMAND...: a test that the command succeeds. Goes on after a failure, which the exit code tells of.
failed=0
check() {
    local name=$1 result=ok
    shift
    say "$name"
    "$@" 2>&1 | tee -a "$directory/all.log" || result=FAILED
    [ "$result" = ok ] || failed=1
    printf 'test %s ... %s\n' "$name" "$result" | tee -a "$directory/all.log"
}

# What runs the commands of the oldest Rust, as the start of a command; nothing if it is not here. Cargo itself would
# look for its subcommands where rustup has put those of another Rust: so they are called by name.
of_oldest() {
    local version
    if command -v rustup >/dev/null && rustup run "$oldest" cargo --version >/dev/null 2>&1; then
        echo "rustup run $oldest"
        return
    fi
    version=$(/usr/bin/rustc --version 2>/dev/null || true)
    [[ $version != "rustc $oldest."* ]] || echo "env PATH=/usr/bin:/bin CARGO=/usr/bin/cargo"
}

# shellcheck disable=SC2317 # called by a shell of its own
# Both packages, each built from what it holds alone. Cargo before 1.90 can't package one that needs another which is
# not published yet: so there the second is only listed. Cargo builds the second with the first from a registry in the
# target directory; but it takes what an earlier run unpacked in its home, or built, if name and version are the same.
packages() {
    local minor
    export CARGO_TARGET_DIR=$directory/target-packages
    rm -rf "$CARGO_TARGET_DIR" "${CARGO_HOME:-$HOME/.cargo}"/registry/src/-*/raygrid-sys-*
    minor=$(cargo --version | sed 's/^cargo 1\.\([0-9]*\).*/\1/')
    if [ "$minor" -ge 90 ]; then
        cargo package --locked --allow-dirty --quiet -p raygrid-sys -p raygrid
    else
        cargo package --locked --allow-dirty --quiet -p raygrid-sys
        cargo package --locked --allow-dirty --list -p raygrid
    fi
}

# shellcheck disable=SC2317
# The crates linked to a library that Meson installed, found by pkg-config.
installed() {
    local prefix=$directory/installed
    rm -rf "$directory/meson"
    meson setup "$directory/meson" "$here/../.." --prefix="$prefix" --libdir=lib -Dtests=disabled \
        -Dexamples=disabled -Dbench=disabled --buildtype=debug >/dev/null
    meson install -C "$directory/meson" --quiet
    export PKG_CONFIG_PATH=$prefix/lib/pkgconfig LD_LIBRARY_PATH=$prefix/lib
    cargo run --locked --quiet --features pkg-config --example hello -p raygrid
    ldd "$CARGO_TARGET_DIR/debug/examples/hello" | grep -F "$prefix/lib/libraygrid.so"
}

# Lines are what a failure names; more for a debugger takes its time to make and to link.
export CARGO_TARGET_DIR=$directory/target CARGO_TERM_COLOR=never CARGO_PROFILE_DEV_DEBUG=line-tables-only
command -v cargo >/dev/null || PATH=$HOME/.cargo/bin:$PATH
cd "$here"
case $only in
'') ;;
--asan)
    # Only what is for the target is instrumented, not build scripts; allocations that a test leaks are found, too.
    export RUSTC_BOOTSTRAP=1 RUSTFLAGS=-Zsanitizer=address CC=clang CFLAGS="-fsanitize=address -fno-omit-frame-pointer"
    exec cargo test --locked --target "$(rustc -vV | sed -n 's/^host: //p')" -p raygrid --features "$features" --tests
    ;;
--miri) exec cargo +nightly miri test --locked -p raygrid --features "$features" --lib ;;
*)
    echo "test.sh: unknown option $only" >&2
    exit 2
    ;;
esac

: >"$directory/all.log"
# What is only checked, not measured or tested, need not be optimised.
unoptimised=(env CFLAGS=-O0)
read -ra old <<<"$(of_oldest)"
say "tests, docs' examples, conformance; $(cargo --version)"
check "cargo test" cargo test --workspace --locked --no-fail-fast --features "$features"
check "docs without warnings" env RUSTDOCFLAGS=-Dwarnings \
    cargo doc --workspace --locked --no-deps --quiet --features "$features"
export directory here
check "packages that build" "${unoptimised[@]}" bash -c "$(declare -f packages); set -e; packages"
check "an installed library" bash -c "$(declare -f installed); set -e; installed"
if [ ${#old[@]} -eq 0 ]; then
    say "left out: lints and builds with Rust $oldest, which is not here"
else
    check "formatted" "${old[@]}" cargo-fmt fmt --all --check
    check "Rust $oldest, without warnings" "${unoptimised[@]}" "${old[@]}" cargo-clippy clippy --all-targets \
        -p raygrid-sys -p raygrid --locked --quiet --target-dir "$directory/target-oldest" --features "$features" -- -D warnings
fi
grep '^test .* \.\.\. ' "$directory/all.log" >"$log"
exit "$failed"
