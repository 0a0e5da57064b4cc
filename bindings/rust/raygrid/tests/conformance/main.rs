// SPDX-License-Identifier: MIT
//! The cases that every language plays: tests/conformance of the repository, through this crate's interface.
//!
//! A case is played on each set-up of the scene's grid that it names, with one worker and with two.

mod calls;
mod compare;
mod expect;
mod script;
mod trace;

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use raygrid::Scene;
use script::{Fail, Outcome, Play, Setup, Step, field, known, list, malformed, record, text};
use serde_json::{Value, json};

fn play_step(play: &mut Play, step: &Step) -> Outcome {
    if field(step, "do")? == "trace" {
        trace::play_trace(play, step)
    } else if !expect::expect(play, step)? {
        calls::call(play, step)
    } else {
        Ok(())
    }
}

fn play_on(case: &Step, name: &str, workers: u32) -> Outcome {
    let setup = Setup::new(name)?;
    let scene = Scene::builder().workers(workers).grid(setup.grid(case.get("grid"))?).build()?;
    let costly = list(field(case, "flags")?)?.iter().any(|flag| flag == "costly");
    let (shapes, objects, grids) = (HashMap::new(), HashMap::new(), HashMap::new());
    let mut play = Play { setup, scene, workers, costly, shapes, objects, grids, last: None };
    for (i, value) in list(field(case, "steps")?)?.iter().enumerate() {
        let step = record(value)?;
        play_step(&mut play, step).map_err(|fail| match fail {
            Fail::Malformed(_) => fail,
            other => {
                let done = step.get("do").unwrap_or(&Value::Null);
                Fail::Wrong(format!("grid {name}, {workers} workers, step {i}, {done}: {other:?}"))
            }
        })?;
    }
    Ok(())
}

fn play_case(case: &Value) -> Outcome {
    let case = record(case)?;
    known(case, "name note numerics flags grids grid steps")?;
    let flags = list(field(case, "flags")?)?;
    if let Some(unknown) = flags.iter().find(|flag| *flag != "costly") {
        malformed!("unknown flag {unknown}");
    }
    let grids = list(field(case, "grids")?)?;
    if grids.is_empty() || list(field(case, "steps")?)?.is_empty() {
        malformed!("no steps or no grids");
    }
    for grid in grids {
        for workers in [1, 2] {
            play_on(case, text(grid)?, workers)?;
        }
    }
    Ok(())
}

fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../tests/conformance/cases")
}

/// Each file that there is to play, and how many cases it has.
fn index() -> Vec<(String, usize)> {
    let text = std::fs::read_to_string(cases().join("index.txt")).expect("index.txt can be read");
    let line = |line: &str| {
        let (name, count) = line.split_once(' ').expect("a name and a count");
        (name.to_owned(), count.parse().expect("a count"))
    };
    text.lines().map(line).collect()
}

fn read(name: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(cases().join(name)).expect("the file can be read");
    serde_json::from_str(&text).expect("an array of cases")
}

/// Plays all cases of a file; there must be as many as the index says.
fn play_file(name: &str) {
    let cases = read(name);
    let wanted = index().into_iter().find(|(other, _)| other == name).map(|(_, count)| count);
    assert_eq!(Some(cases.len()), wanted, "cases of {name}");
    let mut failed = Vec::new();
    for case in &cases {
        if let Err(fail) = play_case(case) {
            failed.push(format!("{}: {fail:?}", case["name"]));
        }
    }
    assert!(failed.is_empty(), "{} of {} cases failed:\n{}", failed.len(), cases.len(), failed.join("\n"));
}

/// A test for each file, and one that there is a test for each.
macro_rules! files {
    ($($topic:ident: $file:literal),*) => {
        $(#[test]
        fn $topic() {
            play_file($file);
        })*

        #[test]
        fn each_file_is_played() {
            let mut played = vec![$($file),*];
            played.sort_unstable();
            let mut named: Vec<_> = index().into_iter().map(|(name, _)| name).collect();
            named.sort_unstable();
            assert_eq!(played, named);
        }
    };
}
files! {
    boxes: "box.json",
    capsule: "capsule.json",
    grid: "grid.json",
    grids: "grids.json",
    loose: "loose.json",
    mesh: "mesh.json",
    paper: "paper.json",
    pose: "pose.json",
    query: "query.json",
    random: "random.json",
    scene: "scene.json",
    shapes: "shapes.json",
    sphere: "sphere.json",
    triangle: "triangle.json"
}

// ------------------------------------------------------------------------------------------- the runner itself

/// A case that passes, with a trace as its last step.
fn a_case() -> Value {
    let ends_with_trace = |case: &Value| {
        case["steps"].as_array().and_then(|steps| steps.last()).is_some_and(|step| step["do"] == "trace")
    };
    read("sphere.json").into_iter().find(ends_with_trace).expect("a case of a trace")
}

fn last_rays(case: &mut Value) -> &mut Vec<Value> {
    let steps = case["steps"].as_array_mut().expect("steps");
    steps.last_mut().expect("a step")["rays"].as_array_mut().expect("rays")
}

#[test]
fn what_is_unknown_fails() {
    let damages: [fn(&mut Value); 6] = [
        |case| case["steps"][0] = json!({"do": "explode"}),
        |case| case["flags"] = json!(["hasty"]),
        |case| case["grids"] = json!(["octree"]),
        |case| case["grids"] = json!(["loose-tiled"]),
        |case| case["steps"][0]["colour"] = json!("red"),
        |case| last_rays(case)[0]["hit"] = json!({"object": null, "colour": "red"}),
    ];
    for (i, damage) in damages.into_iter().enumerate() {
        let mut case = a_case();
        damage(&mut case);
        let played = play_case(&case);
        assert!(matches!(played, Err(Fail::Malformed(_))), "damage {i}: {played:?}");
    }
}

#[test]
fn a_wrong_answer_fails() {
    let mut case = a_case();
    last_rays(&mut case).iter_mut().for_each(|ray| ray["hit"] = Value::Null);
    let played = play_case(&case);
    assert!(matches!(&played, Err(Fail::Wrong(what)) if what.contains("ray 0: hit")), "{played:?}");
}
