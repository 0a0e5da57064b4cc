// SPDX-License-Identifier: MIT
//! That raygrid-sys says what the headers say, and that raygrid has a word for all of it.

use std::collections::BTreeSet;
use std::fmt::Debug;

use checks::{bindings, committed, workspace};
use raygrid::{Call, Coherence, Cull, GridKind, Isa, MeshQuality, ShapeKind, Without};

fn read(path: std::path::PathBuf) -> String {
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn committed_bindings_are_those_of_the_headers() {
    let made = bindings().expect("the headers can be read");
    assert!(made == read(committed()), "the headers have changed: `cargo run -p checks` makes the bindings anew");
}

/// The enumerators that start with `prefix`, without it and without underscores, and their values.
fn constants(prefix: &str) -> BTreeSet<(String, i32)> {
    let text = read(committed());
    let lines = text.lines().filter_map(|line| line.strip_prefix("pub const ")?.strip_prefix(prefix));
    let values = lines.filter_map(|line| {
        let (name, value) = line.split_once(": i32 = ")?;
        Some((name.replace('_', ""), value.trim_end_matches(';').parse().ok()?))
    });
    values.collect()
}

/// The values of an enum, as the headers call them.
fn values<E: Debug + Copy>(all: &[E], value: fn(E) -> i32) -> BTreeSet<(String, i32)> {
    all.iter().map(|&one| (format!("{one:?}").to_uppercase(), value(one))).collect()
}

#[test]
fn enums_have_all_values() {
    assert_eq!(values(Call::ALL, |call| call as i32), constants("RG_CALL_"));
    assert_eq!(values(GridKind::ALL, |kind| kind as i32), constants("RG_GRID_"));
    assert_eq!(values(Cull::ALL, |cull| cull as i32), constants("RG_CULL_"));
    assert_eq!(values(Coherence::ALL, |coherence| coherence as i32), constants("RG_COHERENCE_"));
    assert_eq!(values(Isa::ALL, |isa| isa as i32), constants("RG_ISA_"));
    assert_eq!(values(ShapeKind::ALL, |kind| kind as i32), constants("RG_SHAPE_"));
    assert_eq!(values(MeshQuality::ALL, |quality| quality as i32), constants("RG_MESH_"));
    let flags = Without::NAMES.iter().map(|(name, flag)| ((*name).to_owned(), flag.bits() as i32));
    assert_eq!(flags.collect::<BTreeSet<_>>(), constants("RG_WITHOUT_"));
}

/// All that the safe crate's sources say.
fn sources() -> String {
    let mut text = String::new();
    let mut folders = vec![workspace().join("raygrid/src")];
    while let Some(folder) = folders.pop() {
        for entry in folder.read_dir().expect("a folder of sources") {
            let path = entry.expect("an entry").path();
            if path.is_dir() { folders.push(path) } else { text.push_str(&read(path)) }
        }
    }
    text
}

#[test]
fn every_function_and_result_is_used() {
    // What Rust has a value for: structs with all fields given, poses, rays, views of arrays, names of errors.
    let otherwise = [
        "rg_grid_config_default",
        "rg_input3_packed",
        "rg_output3_packed",
        "rg_pose_at",
        "rg_ray_from",
        "rg_result_name",
        "rg_scene_config_default",
        "rg_shape_config_default",
        "rg_trace_config_default",
    ];
    let (text, sources) = (read(committed()), sources());
    let functions = text.lines().filter_map(|line| line.trim().strip_prefix("pub fn ")?.split('(').next());
    let results = text.lines().filter_map(|line| line.strip_prefix("pub const ")?.split(": ").next());
    let errors = results.skip_while(|name| *name != "RG_OK").take_while(|name| *name != "RG_F64");
    let mut count = 0;
    for name in functions.chain(errors) {
        let used = sources.contains(&format!("sys::{name}"));
        assert!(used != otherwise.contains(&name), "{name}: used is {used}");
        count += 1;
    }
    assert!(count > 40, "only {count} names were found");
}

#[test]
fn versions_are_one() {
    let (major, minor, patch) = raygrid::version();
    assert_eq!(format!("{major}.{minor}.{patch}"), env!("CARGO_PKG_VERSION"));
}
