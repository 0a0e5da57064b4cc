// SPDX-License-Identifier: MIT
//! What is compiled, and how: the same as lib/meson.build says, which the tests of `checks` make sure of.

use std::path::{Path, PathBuf};

/// Prefix of the sources that are compiled for one set of instructions each.
const KERNELS: &str = "kernels_";

/// For all sources. Contraction off: the same bits on every machine (docs/numerics.md).
pub const FLAGS: [&str; 2] = ["-ffp-contract=off", "-fno-math-errno"];

/// For all sources, if the compiler is gcc: what its version 12 does in this pass to doubles rounded to float is wrong.
pub const GCC_FLAGS: [&str; 1] = ["-fno-tree-slp-vectorize"];

/// For kernels.
pub const KERNEL_FLAGS: [&str; 1] = ["-fno-trapping-math"];

/// For kernels, where the compiler knows it: they are too large for a debugger to follow each variable.
pub const KERNEL_FLAGS_IF_KNOWN: [&str; 1] = ["-fno-var-tracking-assignments"];

pub const DEFINES: [(&str, &str); 1] = [("_POSIX_C_SOURCE", "200809L")];

/// The kernels of a processor, each with the instructions that it is for.
pub fn kernels(arch: &str) -> Vec<(&'static str, &'static [&'static str])> {
    let mut kernels: Vec<(&str, &[&str])> = vec![("portable", &[])];
    match arch {
        "x86_64" => {
            kernels.push(("sse2", &[]));
            kernels.push(("avx2", &["-mavx2", "-mfma", "-mbmi", "-mbmi2", "-mlzcnt"]));
            kernels.push((
                "avx512",
                &[
                    "-mavx512f",
                    "-mavx512vl",
                    "-mavx512dq",
                    "-mavx512bw",
                    "-mavx2",
                    "-mfma",
                    "-mbmi",
                    "-mbmi2",
                    "-mlzcnt",
                    "-mprefer-vector-width=512",
                ],
            ));
        }
        "aarch64" => kernels.push(("neon", &[])),
        _ => {}
    }
    kernels
}

/// The source of a kernel.
pub fn kernel_source(lib: &Path, isa: &str) -> PathBuf {
    lib.join(format!("{KERNELS}{isa}.c"))
}

/// All sources but those of kernels: each one that is there, so that a new one needs no mention.
pub fn sources(lib: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut sources = Vec::new();
    for entry in lib.read_dir()? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.ends_with(".c") && !name.starts_with(KERNELS) {
            sources.push(path);
        }
    }
    sources.sort();
    Ok(sources)
}
