// SPDX-License-Identifier: MIT
//! Writes `raygrid-sys/src/bindings.rs`.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    Ok(std::fs::write(checks::committed(), checks::bindings()?)?)
}
