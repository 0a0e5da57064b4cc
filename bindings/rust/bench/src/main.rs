// SPDX-License-Identifier: MIT
//! raygrid beside bvh, parry3d, rapier3d and obvhs: moving spheres, random rays, one thread, in one run.
//!
//! `cargo run --release [-- --quick]`. Times are those of the thread; each is the best of several rounds, in which
//! the engines take turns, so that what disturbs the machine disturbs all of them. Errors are against brute force in
//! doubles.

use std::time::Duration;

use raygrid_bench::clock::taken;
use raygrid_bench::engines::{self, Engine, Found};
use raygrid_bench::world::World;

/// Rays that are checked, and as many as brute force takes about a second for.
const CHECKED: usize = 300;

/// The best times of an engine, and its errors.
#[derive(Clone)]
struct Result {
    some: Duration,
    all: Duration,
    single: Duration,
    batch: Duration,
    wrong: usize,
    worst: f64,
}

impl Result {
    const NONE: Self = Self {
        some: Duration::MAX,
        all: Duration::MAX,
        single: Duration::MAX,
        batch: Duration::MAX,
        wrong: 0,
        worst: 0.0,
    };

    /// 1 % moved, and all rays in a batch.
    fn frame(&self) -> f64 {
        (self.some + self.batch).as_secs_f64()
    }
}

/// Counts what is wrong of the first rays: another sphere, or none; and the largest error of t, in radii.
fn check(world: &World, rays: &[raygrid::Ray], found: &[Found], result: &mut Result) {
    let checked = CHECKED.min(200_000_000 / world.centres.len() / 10).max(20);
    for (ray, &(t, one)) in rays.iter().zip(found).take(checked) {
        match world.brute(ray) {
            (_, false) => {}
            (None, true) => result.wrong += usize::from(one != usize::MAX),
            (Some((_, wanted)), true) if wanted != one => result.wrong += 1,
            (Some((wanted, _)), true) => {
                result.worst = result.worst.max((t - wanted).abs() / f64::from(world.radius));
            }
        }
    }
}

fn measure(count: usize, rounds: usize, ray_count: usize) {
    let mut world = World::new(count);
    let mut engines = engines::all(&world);
    let mut results = vec![Result::NONE; engines.len()];
    for round in 0..rounds {
        let rays = world.rays(ray_count);
        let mut found = vec![(0.0, 0); ray_count];
        // Each with the same moves: first a few spheres, then all of them.
        let moved = world.step(0.01);
        for (engine, result) in engines.iter_mut().zip(&mut results) {
            result.some = result.some.min(taken(|| engine.move_some(&world, &moved)));
        }
        for (engine, result) in engines.iter_mut().zip(&mut results) {
            let trace_all = |engine: &mut Box<dyn Engine>, found: &mut [Found]| {
                for (ray, found) in rays.iter().zip(found) {
                    *found = engine.trace(&world, ray);
                }
            };
            result.single = result.single.min(taken(|| trace_all(engine, &mut found)));
            if round == 0 {
                check(&world, &rays, &found, result);
            }
            let many = taken(|| engine.trace_many(&world, &rays, &mut found));
            result.batch = result.batch.min(if engine.has_batches() { many } else { many.min(result.single) });
        }
        world.step(1.0);
        for (engine, result) in engines.iter_mut().zip(&mut results) {
            result.all = result.all.min(taken(|| engine.move_all(&world)));
        }
    }
    print(count, ray_count, &engines, &results);
}

fn print(count: usize, ray_count: usize, engines: &[Box<dyn Engine>], results: &[Result]) {
    println!("\n{count} spheres, {ray_count} rays; times in ms, of the thread");
    let rays = "rays one by one, M/s | in a batch, M/s | 1 % and all rays";
    println!("| | 1 % moved | all moved | {rays} | to raygrid | wrong | t error, radii |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for (engine, result) in engines.iter().zip(results) {
        let ms = |time: Duration| 1e3 * time.as_secs_f64();
        let rate = |time: Duration| ray_count as f64 / time.as_secs_f64() / 1e6;
        println!(
            "| {} | {:.3} | {:.2} | {:.2} | {:.2} | {:.1} | {:.2} | {} | {:.0e} |",
            engine.name(),
            ms(result.some),
            ms(result.all),
            rate(result.single),
            rate(result.batch),
            1e3 * result.frame(),
            result.frame() / results[0].frame(),
            result.wrong,
            result.worst,
        );
    }
}

fn main() {
    let quick = std::env::args().any(|argument| argument == "--quick");
    let sizes: &[(usize, usize)] =
        if quick { &[(1_000, 5), (100_000, 3)] } else { &[(1_000, 15), (10_000, 9), (100_000, 5), (1_000_000, 2)] };
    for &(count, rounds) in sizes {
        measure(count, rounds, 100_000);
    }
}
