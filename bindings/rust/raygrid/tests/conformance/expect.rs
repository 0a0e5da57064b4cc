// SPDX-License-Identifier: MIT
//! The steps of a script that are expectations of reports and of errors.

use raygrid::{GridId, GridReport, SceneReport};
use serde_json::Value;

use crate::calls::call;
use crate::script::{
    Fail, NO_ID, Outcome, Play, Step, ensure, field, kind_of, known, list, numbers, record, result_of, text, vectors,
    whole,
};

/// Plays a step that is an expectation; false: it is none.
pub fn expect(play: &mut Play, step: &Step) -> Outcome<bool> {
    match text(field(step, "do")?)? {
        "expect_error" => expect_error(play, step)?,
        "expect_grid" => expect_grid(play, step)?,
        "expect_object" => expect_object(play, step)?,
        "expect_scene" => expect_scene(play, step)?,
        _ => return Ok(false),
    }
    Ok(true)
}

fn count(step: &Step, key: &str, got: u64) -> Outcome {
    let (least, most) = match step.get(key) {
        None => return Ok(()),
        Some(Value::Object(range)) => {
            known(range, "min max")?;
            let bound = |key: &str, other: u64| range.get(key).map_or(Ok(other), |value| whole(value, u64::MAX));
            (bound("min", 0)?, bound("max", u64::MAX)?)
        }
        Some(value) => (whole(value, u64::MAX)?, whole(value, u64::MAX)?),
    };
    ensure!((least..=most).contains(&got), "{key} is {got}, expected {least} to {most}");
    Ok(())
}

fn doubles<const N: usize>(step: &Step, key: &str, got: [f64; N]) -> Outcome {
    if let Some(value) = step.get(key) {
        let wanted: [f64; N] = numbers(value)?;
        ensure!(got == wanted, "{key} is {got:?}, expected {wanted:?}");
    }
    Ok(())
}

fn contains(step: &Step, key: &str, lo: [f64; 3], hi: [f64; 3]) -> Outcome {
    for point in step.get(key).map_or(Ok(Vec::new()), vectors)? {
        let inside = (0..3).all(|axis| lo[axis] <= point[axis] && point[axis] <= hi[axis]);
        ensure!(inside, "{key}: {point:?} is not from {lo:?} to {hi:?}");
    }
    Ok(())
}

fn expect_grid(play: &Play, step: &Step) -> Outcome {
    let boxes = "physical_lo physical_hi physical_contains logical_contains";
    let counts = "levels levels_used objects entries unbounded tiles rebuilds";
    known(step, &format!("do grid on kind resolution {boxes} {counts}"))?;
    if let Some(on) = step.get("on") {
        if !list(on)?.iter().any(|name| name == &play.setup.name) {
            return Ok(());
        }
    }
    let report = play.scene.grid_stats(play.grid(field(step, "grid")?)?)?;
    if let Some(kind) = step.get("kind") {
        ensure!(report.kind == kind_of(text(kind)?)?, "kind is {:?}", report.kind);
    }
    doubles(step, "resolution", report.resolution.map(f64::from))?;
    count(step, "levels", report.levels.into())?;
    count(step, "levels_used", report.levels_used.into())?;
    count(step, "objects", report.objects)?;
    count(step, "entries", report.entries)?;
    count(step, "unbounded", report.unbounded)?;
    count(step, "tiles", report.tiles)?;
    count(step, "rebuilds", report.rebuilds)?;
    doubles(step, "physical_lo", report.physical_lo)?;
    doubles(step, "physical_hi", report.physical_hi)?;
    contains(step, "physical_contains", report.physical_lo, report.physical_hi)?;
    contains(step, "logical_contains", report.logical_lo, report.logical_hi)
}

fn expect_object(play: &Play, step: &Step) -> Outcome {
    known(step, "do object position linear mask grid contains slot generation")?;
    let id = play.object(field(step, "object")?)?;
    let report = play.scene.lookup(id)?;
    doubles(step, "position", report.pose.position)?;
    let linear: [f64; 9] = std::array::from_fn(|i| report.pose.linear[i / 3][i % 3].into());
    doubles(step, "linear", linear)?;
    contains(step, "contains", report.lo, report.hi)?;
    count(step, "mask", report.mask.into())?;
    count(step, "slot", id.slot().into())?;
    count(step, "generation", id.generation().into())?;
    if let Some(grid) = step.get("grid") {
        ensure!(report.grid == play.grid(grid)?, "it is in another grid");
    }
    Ok(())
}

fn expect_scene(play: &Play, step: &Step) -> Outcome {
    known(step, "do objects slots grids")?;
    let report = play.scene.stats()?;
    count(step, "objects", report.objects)?;
    count(step, "slots", report.slots)?;
    count(step, "grids", report.grids.into())
}

/// What must not change when a call fails.
fn state(play: &Play) -> Outcome<(SceneReport, GridReport)> {
    Ok((play.scene.stats()?, play.scene.grid_stats(GridId::OF_SCENE)?))
}

fn expect_error(play: &mut Play, step: &Step) -> Outcome {
    known(step, "do result message call")?;
    let (wanted, message) = (result_of(text(field(step, "result")?)?)?, text(field(step, "message")?)?);
    let before = state(play)?;
    let made = record(field(step, "call")?)?;
    match call(play, made) {
        Err(Fail::Refused(error)) => {
            ensure!(error.kind() == wanted, "{error:?}, expected {wanted:?}");
            ensure!(error.message().contains(message), "the message {error} has no {message:?}");
        }
        // What scripts say of the id 0 is that it is refused, and there is no such id to begin with.
        Err(Fail::Malformed(why)) if why == NO_ID && wanted == raygrid::ErrorKind::InvalidId => {}
        Ok(()) => return Err(Fail::Wrong(format!("{made:?} succeeded"))),
        other => return other,
    }
    ensure!(state(play)? == before, "the failed call changed something");
    match play.last.take() {
        Some(batch) => {
            let again = batch.trace_again(play);
            play.last = Some(batch);
            again
        }
        None => Ok(()),
    }
}
