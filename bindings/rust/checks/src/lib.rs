// SPDX-License-Identifier: MIT
//! The generator of `raygrid-sys/src/bindings.rs`.
//!
//! `cargo run -p checks` writes that file anew; `cargo test -p checks` fails if it differs from what is made.

use std::path::{Path, PathBuf};

use bindgen::callbacks::{IntKind, ParseCallbacks};

/// What is committed starts with this.
const HEADER: &str = "\
// SPDX-License-Identifier: MIT
// Made from include/raygrid/*.h by `cargo run -p checks`. Not to be edited.
";

/// The folder with the crates.
pub fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("checks lies in the workspace").into()
}

/// The committed bindings.
pub fn committed() -> PathBuf {
    workspace().join("raygrid-sys/src/bindings.rs")
}

/// Makes comments of the headers fit for rustdoc.
#[derive(Debug)]
struct Comments;

impl ParseCallbacks for Comments {
    /// Of a macro that is a cast bindgen sees the value alone.
    fn int_macro(&self, name: &str, _: i64) -> Option<IntKind> {
        (name == "RG_NO_OBJECT").then_some(IntKind::U64)
    }

    fn process_comment(&self, comment: &str) -> Option<String> {
        let mut lines = Vec::new();
        for line in comment.lines() {
            // Indented lines would be code, and brackets links.
            let mut text = line.trim().to_owned();
            for special in ['[', ']', '<', '>', '*', '_'] {
                text = text.replace(special, &format!("\\{special}"));
            }
            lines.push(text);
        }
        Some(lines.join("\n"))
    }
}

/// The bindings that belong to the headers of this tree.
pub fn bindings() -> Result<String, bindgen::BindgenError> {
    let include = workspace().join("raygrid-sys/include");
    let made = bindgen::Builder::default()
        .header(include.join("raygrid/raygrid.h").to_string_lossy())
        .clang_arg(format!("-I{}", include.display()))
        .clang_arg("-std=c99")
        .allowlist_item("(rg|RG)_.*")
        .rust_target(bindgen::RustTarget::stable(85, 0).expect("the rust-version of the workspace"))
        .rust_edition(bindgen::RustEdition::Edition2024)
        .formatter(bindgen::Formatter::Prettyplease)
        .use_core()
        .derive_default(true)
        .disable_header_comment()
        .prepend_enum_name(false)
        .clang_macro_fallback()
        .clang_macro_fallback_build_dir(std::env::temp_dir())
        .parse_callbacks(Box::new(Comments))
        .generate()?
        .to_string();
    Ok(format!("{HEADER}{}", enumerators_as_int(&layouts_of_64_bits(&made))))
}

/// Sizes and offsets hold where pointers have 64 bits, whatever machine they were made on.
fn layouts_of_64_bits(made: &str) -> String {
    made.replace("const _: () = {", "#[cfg(target_pointer_width = \"64\")]\nconst _: () = {")
}

/// Enumerators are of the type int in C, and each enumeration of raygrid has a typedef of int32_t. bindgen makes an
/// unsigned type for each, numbered, so that a new one would rename those after it.
fn enumerators_as_int(made: &str) -> String {
    let mut text = String::new();
    for line in made.lines().filter(|line| !line.starts_with("pub type _bindgen_ty_")) {
        match line.split_once(": _bindgen_ty_") {
            Some((name, value)) => {
                let value = value.trim_start_matches(|digit: char| digit.is_ascii_digit());
                text.push_str(&format!("{name}: i32{value}"));
            }
            None => text.push_str(line),
        }
        text.push('\n');
    }
    text
}

/// The Rust in the repository's README, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../../../../README.md")]
pub struct Readme;
