// SPDX-License-Identifier: MIT
//! That the crate compiles what Meson compiles, with the same flags.

#[allow(dead_code, reason = "the build script uses the rest")]
#[path = "../../raygrid-sys/build/native.rs"]
mod native;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use checks::workspace;
use serde_json::Value;

/// Flags that Meson adds on its own, or that the compiler's driver in the crate cc has its own way for.
const MESONS_OWN: [&str; 9] = [
    "-fdiagnostics-color=",
    "-Winvalid-pch",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-fPIC",
    "-pthread",
    "-D_FILE_OFFSET_BITS=",
    "-M",
];

fn run(command: &mut Command) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stdout));
}

/// How Meson compiles each source of the library for release, by its name: the flags that matter.
fn by_meson() -> BTreeMap<String, BTreeSet<String>> {
    let build = Path::new(env!("CARGO_TARGET_TMPDIR")).join("meson");
    let _ = std::fs::remove_dir_all(&build);
    let options = ["--buildtype=release", "-Dtests=disabled", "-Dexamples=disabled", "-Dbench=disabled"];
    run(Command::new("meson").arg("setup").args(options).arg(&build).arg(workspace().join("../..")));
    let text = std::fs::read_to_string(build.join("compile_commands.json")).expect("Meson writes its commands");
    let commands: Vec<Value> = serde_json::from_str(&text).expect("commands");
    let mut flags = BTreeMap::new();
    for command in &commands {
        let source = PathBuf::from(command["file"].as_str().expect("a file"));
        let name = source.file_name().expect("a name").to_string_lossy().into_owned();
        let words = command["command"].as_str().expect("a command").split_whitespace();
        let that_matter = words.filter(|word| {
            let others = ["-I", "-o", "-c"].contains(word) || word.starts_with("-I");
            word.starts_with('-') && !others && !MESONS_OWN.iter().any(|own| word.starts_with(own))
        });
        flags.insert(name, that_matter.map(str::to_owned).collect());
    }
    flags
}

/// How the build script compiles each source with gcc.
fn by_cargo() -> BTreeMap<String, BTreeSet<String>> {
    let lib = workspace().join("raygrid-sys/lib");
    let mut common: Vec<String> = ["-std=c99", "-O3", "-DNDEBUG", "-fvisibility=hidden"].map(str::to_owned).into();
    common.extend(native::DEFINES.iter().map(|(name, value)| format!("-D{name}={value}")));
    common.extend(native::FLAGS.iter().chain(&native::GCC_FLAGS).map(|&flag| flag.to_owned()));
    let name = |path: PathBuf| path.file_name().expect("a name").to_string_lossy().into_owned();
    let mut flags = BTreeMap::new();
    for source in native::sources(&lib).expect("the folder lib") {
        flags.insert(name(source), common.iter().cloned().collect());
    }
    for (isa, own) in native::kernels(std::env::consts::ARCH) {
        let own = own.iter().chain(&native::KERNEL_FLAGS).chain(&native::KERNEL_FLAGS_IF_KNOWN);
        let all = common.iter().cloned().chain(own.map(|&flag| flag.to_owned())).collect();
        flags.insert(name(native::kernel_source(&lib, isa)), all);
    }
    flags
}

#[test]
fn the_crate_compiles_what_meson_compiles() {
    let (meson, cargo) = (by_meson(), by_cargo());
    assert!(meson.len() > 20, "Meson compiles only {meson:?}");
    assert_eq!(meson.keys().collect::<Vec<_>>(), cargo.keys().collect::<Vec<_>>());
    for (source, flags) in &meson {
        assert_eq!(flags, &cargo[source], "{source}: by Meson, and by the build script");
    }
}
