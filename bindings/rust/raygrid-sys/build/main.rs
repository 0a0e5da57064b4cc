// SPDX-License-Identifier: MIT
//! Compiles the C sources that the package carries; with the feature `pkg-config` only if no library is installed.

mod native;

use std::path::Path;

fn main() {
    if !installed() {
        compile();
    }
}

/// Finds the installed library. Until 1.0 the interface may change with the second number.
#[cfg(feature = "pkg-config")]
fn installed() -> bool {
    let (least, next) = (env!("CARGO_PKG_VERSION"), "0.2.0");
    match pkg_config::Config::new().range_version(least..next).probe("raygrid") {
        Ok(library) => {
            for include in library.include_paths.iter().take(1) {
                println!("cargo::metadata=include={}", include.display());
            }
            true
        }
        Err(_) => {
            println!("cargo::warning=pkg-config knows no raygrid from {least} to below {next}: it is compiled");
            false
        }
    }
}

#[cfg(not(feature = "pkg-config"))]
fn installed() -> bool {
    false
}

fn compile() {
    let package = std::env::var("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR");
    let arch = std::env::var("CARGO_CFG_TARGET_ARCH").expect("cargo sets CARGO_CFG_TARGET_ARCH");
    let (lib, include) = (Path::new(&package).join("lib"), Path::new(&package).join("include"));
    for watched in [Path::new("build"), &lib, &include] {
        println!("cargo::rerun-if-changed={}", watched.display());
    }

    let mut common = cc::Build::new();
    // Optimised in every profile: who debugs a program does not debug this library, and needs its speed.
    common.std("c99").opt_level(3).define("NDEBUG", None).include(&include).warnings(false);
    for (name, value) in native::DEFINES {
        common.define(name, value);
    }
    common.flags(native::FLAGS).flag("-fvisibility=hidden");
    let compiler = common.get_compiler();
    if compiler.is_like_gnu() && !compiler.is_like_clang() {
        common.flags(native::GCC_FLAGS);
    }

    let mut all = common.clone();
    for (isa, flags) in native::kernels(&arch) {
        let mut kernel = common.clone();
        kernel.flags(native::KERNEL_FLAGS).flags(flags).file(native::kernel_source(&lib, isa));
        for flag in native::KERNEL_FLAGS_IF_KNOWN {
            kernel.flag_if_supported(flag);
        }
        all.objects(kernel.compile_intermediates());
    }
    all.files(native::sources(&lib).expect("the package has the folder lib")).compile("raygrid");
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux") {
        println!("cargo::rustc-link-lib=m");
        println!("cargo::rustc-link-lib=pthread");
    }
    println!("cargo::metadata=include={}", include.display());
}
