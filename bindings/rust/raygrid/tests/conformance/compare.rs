// SPDX-License-Identifier: MIT
//! What holds for every hit, and what the script expects of each.

use std::collections::HashMap;

use raygrid::{Hit, NO_PRIMITIVE, ObjectId, Ray};
use serde_json::Value;

use crate::script::{Fail, Outcome, Play, Step, ensure, field, known, malformed, mask, number, numbers};
use crate::trace::Batch;

/// Units in the last place of t that every hit is allowed.
const T_ULPS: f64 = 4.0;
/// What float normals and barycentrics are off at most.
const NORMAL_WITHIN: f64 = 1.0 / 1_048_576.0;
const WEIGHT_WITHIN: f64 = NORMAL_WITHIN;

/// The distance from |x| to the next larger double; infinity at the end of the range.
fn ulp(x: f64) -> f64 {
    if x.is_infinite() { f64::INFINITY } else { f64::from_bits(x.abs().to_bits() + 1) - x.abs() }
}

fn near(what: &str, got: f64, wanted: f64, within: f64) -> Outcome {
    let off = (got - wanted).abs();
    ensure!(
        got == wanted || off <= within,
        "{what} is {got:?}, expected {wanted:?} within {within:.3e}, off {off:.3e}"
    );
    Ok(())
}

fn check_miss(hit: &Hit, invalid: bool) -> Outcome {
    let t = if invalid { hit.t.is_nan() } else { hit.t == f64::INFINITY };
    ensure!(t, "t of a miss is {}", hit.t);
    let rest = Hit { t: 0.0, ..*hit };
    ensure!(rest == Hit { t: 0.0, ..Hit::MISS } && hit.primitive == NO_PRIMITIVE, "a miss is {hit:?}");
    Ok(())
}

/// What holds for every hit.
fn check_hit(play: &Play, ray: &Ray, hit: &Hit, masks: &mut HashMap<ObjectId, u32>) -> Outcome {
    let length: f64 = hit.normal.iter().map(|x| f64::from(*x) * f64::from(*x)).sum();
    ensure!((length - 1.0).abs() <= NORMAL_WITHIN, "length of the normal {:?}", hit.normal);
    ensure!(ray.t_min <= hit.t && hit.t <= ray.t_max, "t {} is out of the ray's range", hit.t);
    let farthest = hit.position.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let can_be_infinite = farthest > f64::from(f32::MAX);
    ensure!(hit.offset >= 0.0 && (hit.offset < f32::INFINITY || can_be_infinite), "offset {}", hit.offset);
    ensure!(hit.u >= 0.0 && hit.v >= 0.0 && hit.u + hit.v <= 1.0 + 2.0_f32.powi(-22), "weights {} {}", hit.u, hit.v);
    if let Some(object) = hit.object {
        let mask = match masks.get(&object) {
            Some(mask) => *mask,
            None => play.scene.lookup(object)?.mask,
        };
        masks.insert(object, mask);
        ensure!(mask & ray.mask != 0, "hit of {}, which the ray doesn't see", play.name_of(hit.object));
    }
    for axis in 0..3 {
        let right = hit.t.mul_add(ray.direction[axis], ray.origin[axis]);
        let got = hit.position[axis];
        ensure!(got == right, "position is {got:?}, origin + t * direction rounded once {right:?}");
    }
    Ok(())
}

fn check_vectors(ray: &Ray, hit: &Hit, expected: &Step, t_within: f64) -> Outcome {
    if let Some(normal) = expected.get("normal") {
        let within = expected.get("normal_within").map_or(Ok(NORMAL_WITHIN), number)?;
        for (got, wanted) in hit.normal.into_iter().zip(numbers::<3>(normal)?) {
            near("normal", got.into(), wanted, within)?;
        }
    }
    if let Some(position) = expected.get("position") {
        for (axis, wanted) in numbers::<3>(position)?.into_iter().enumerate() {
            let largest = wanted.abs().max(ray.origin[axis].abs());
            let within = t_within * ray.direction[axis].abs() + 2.0 * ulp(largest);
            near("position", hit.position[axis], wanted, within)?;
        }
    }
    Ok(())
}

/// A value, or any of an array.
fn any_of(value: &Value) -> &[Value] {
    value.as_array().map_or(std::slice::from_ref(value), Vec::as_slice)
}

fn check_expected(play: &Play, batch: &Batch, i: usize, expected: &Step) -> Outcome {
    known(expected, "object t within primitive normal normal_within u v position cells_max tests")?;
    let (ray, hit) = (&batch.rays[i], &batch.first.hits[i]);
    let object = field(expected, "object")?;
    let mut is_one = false;
    for wanted in any_of(object) {
        is_one |= hit.object == if wanted.is_null() { None } else { Some(play.object(wanted)?) };
    }
    ensure!(is_one, "hit {} at {:?}, expected {object}", play.name_of(hit.object), hit.t);
    if let Some(most) = expected.get("cells_max") {
        ensure!(batch.first.cells[i] <= mask(most)?, "looked into {} cells", batch.first.cells[i]);
    }
    if let Some(tests) = expected.get("tests") {
        ensure!(batch.first.tests[i] == mask(tests)?, "tested {} objects", batch.first.tests[i]);
    }
    if !hit.is_hit() {
        return Ok(());
    }
    if let Some(primitive) = expected.get("primitive") {
        let mut is_one = false;
        for wanted in any_of(primitive) {
            is_one |= hit.primitive == mask(wanted)?;
        }
        ensure!(is_one, "primitive is {}, expected {primitive}", hit.primitive);
    }
    let t = expected.get("t").map_or(Ok(hit.t), number)?;
    let within = T_ULPS * ulp(t) + expected.get("within").map_or(Ok(0.0), number)?;
    near("t", hit.t, t, within)?;
    for (name, got) in [("u", f64::from(hit.u)), ("v", f64::from(hit.v))] {
        near(name, got, expected.get(name).map_or(Ok(got), number)?, WEIGHT_WITHIN)?;
    }
    check_vectors(ray, hit, expected, within)
}

fn check_ray(play: &Play, batch: &Batch, i: usize, masks: &mut HashMap<ObjectId, u32>) -> Outcome {
    let hit = &batch.first.hits[i];
    let mut invalid = false;
    match batch.lines[i].get("hit") {
        Some(Value::Null) => ensure!(!hit.is_hit(), "hit {}", play.name_of(hit.object)),
        Some(Value::String(word)) if word == "invalid" => {
            invalid = true;
            let work = (batch.first.cells[i], batch.first.tests[i]);
            ensure!(work == (0, 0), "an invalid ray looked into cells");
        }
        Some(Value::Object(expected)) => check_expected(play, batch, i, expected)?,
        _ => malformed!("it has no hit"),
    }
    if hit.is_hit() { check_hit(play, &batch.rays[i], hit, masks) } else { check_miss(hit, invalid) }
}

pub fn with_script(play: &Play, batch: &Batch) -> Outcome {
    let mut masks = HashMap::new();
    for i in 0..batch.rays.len() {
        check_ray(play, batch, i, &mut masks).map_err(|fail| match fail {
            Fail::Wrong(what) => Fail::Wrong(format!("ray {i}: {what}")),
            other => other,
        })?;
    }
    Ok(())
}
