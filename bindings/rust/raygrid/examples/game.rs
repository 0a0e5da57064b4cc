// SPDX-License-Identifier: MIT
//! A game's loop without the engine: agents walk among pillars, each frame all of them move, and each looks whether it
//! sees those near it. `cargo run --release --example game [AGENTS [FRAMES]]`

use std::time::{Duration, Instant};

use raygrid::views::{Ids, Poses, RayViews, Vectors};
use raygrid::{GridConfig, Insert, ObjectId, Scene, Shape};

/// Half the side of the square that all happens in.
const WORLD: f32 = 200.0;
/// Which rays see what: lines of sight look for pillars alone.
const PILLAR: u32 = 1;
const AGENT: u32 = 2;
/// How many others each agent looks for.
const LOOKS: usize = 4;

/// Read where it lies, so it is plain data.
#[derive(Clone, Copy, bytemuck::NoUninit)]
#[repr(C)]
struct Agent {
    id: ObjectId,
    eye: [f32; 3],
    speed: [f32; 3],
}

/// Numbers that look random: a linear congruential generator, of which the high half is used.
struct Random(u64);

impl Random {
    fn within(&mut self, size: f32) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 40) as f32 / (1 << 23) as f32 - 1.0) * size
    }
}

fn make_pillars(scene: &Scene, random: &mut Random) -> raygrid::Result<()> {
    // What never moves has a grid of its own.
    let still = scene.create_grid(&GridConfig::default())?;
    let places: Vec<[f32; 3]> = (0..400).map(|_| [random.within(WORLD), 0.0, random.within(WORLD)]).collect();
    let pillar = Shape::capsule([0.0, 0.0, 0.0], [0.0, 8.0, 0.0], 1.5)?;
    scene.insert_all(Insert::new(&pillar, &places).mask(PILLAR).grid(still)).map(drop)
}

/// Agents in rows: who follows in the list is near.
fn make_agents(scene: &Scene, random: &mut Random, count: usize) -> raygrid::Result<Vec<Agent>> {
    let side = (count as f32).sqrt().ceil();
    let place = |i: usize| ((i as f32 % side) / side * 2.0 - 1.0, (i as f32 / side).floor() / side * 2.0 - 1.0);
    let eyes: Vec<[f32; 3]> = (0..count).map(place).map(|(x, z)| [x * WORLD, 1.7, z * WORLD]).collect();
    let ids = scene.insert_all(Insert::new(&Shape::sphere(0.4)?, &eyes).mask(AGENT))?;
    let agents = ids.into_iter().zip(eyes);
    Ok(agents.map(|(id, eye)| Agent { id, eye, speed: [random.within(0.1), 0.0, random.within(0.1)] }).collect())
}

/// Moves all agents: one call, which reads ids and places where the game has them.
fn walk(scene: &Scene, agents: &mut [Agent]) -> raygrid::Result<()> {
    for Agent { eye, speed, .. } in agents.iter_mut() {
        for axis in [0, 2] {
            eye[axis] += speed[axis];
            if eye[axis].abs() > WORLD {
                speed[axis] = -speed[axis];
            }
        }
    }
    let places = Poses::at(Vectors::field(agents, |agent| &agent.eye));
    scene.move_many(Ids::field(agents, |agent| &agent.id), places)
}

/// How many of those that follow it in the list each one sees: any-hit queries for the ways between their eyes.
fn look(scene: &Scene, agents: &[Agent], blocked: &mut Vec<bool>) -> raygrid::Result<usize> {
    let pairs = (0..agents.len()).flat_map(|i| (1..=LOOKS).map(move |step| (i, (i + step) % agents.len())));
    let ways: Vec<[[f32; 3]; 2]> = pairs
        .map(|(from, to)| {
            let (from, to) = (agents[from].eye, agents[to].eye);
            [from, [to[0] - from[0], to[1] - from[1], to[2] - from[2]]]
        })
        .collect();
    blocked.resize(ways.len(), false);
    let rays = RayViews::new(Vectors::field(&ways, |way| &way[0]), Vectors::field(&ways, |way| &way[1]));
    scene.query().occluded_views(rays.t_max(1.0).mask(PILLAR), &mut *blocked)?;
    Ok(blocked.iter().filter(|&&blocked| !blocked).count())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let count = arguments.next().map_or(Ok(20_000), |text| text.parse::<usize>())?;
    let frames = arguments.next().map_or(Ok(60), |text| text.parse::<u32>())?;
    let (scene, mut random) = (Scene::new()?, Random(1));
    make_pillars(&scene, &mut random)?;
    let mut agents = make_agents(&scene, &mut random, count)?;
    let (mut blocked, mut seen) = (Vec::new(), 0);
    let (mut walking, mut looking) = (Duration::ZERO, Duration::ZERO);
    for _ in 0..frames {
        let start = Instant::now();
        walk(&scene, &mut agents)?;
        let moved = Instant::now();
        seen += look(&scene, &agents, &mut blocked)?;
        walking += moved - start;
        looking += moved.elapsed();
    }
    let done = count as f64 * f64::from(frames);
    let looks = done * LOOKS as f64;
    println!(
        "{count} agents, {frames} frames, {}",
        if scene.stats()?.workers == 1 { "one thread" } else { "threads" }
    );
    println!("{:.1} million moves a second", done / walking.as_secs_f64() / 1e6);
    println!("{:.1} million lines of sight a second", looks / looking.as_secs_f64() / 1e6);
    println!("{:.0} % of the others are in sight", 100.0 * seen as f64 / looks);
    Ok(())
}
