// SPDX-License-Identifier: MIT
//! The first steps: insert, trace, move, remove. Compare with `examples/hello.c` of the repository.

use raygrid::{Ray, Scene, Shape};

fn main() -> raygrid::Result<()> {
    let scene = Scene::new()?;
    let ball = scene.insert(&Shape::sphere(1.0)?, [0.0, 0.0, 5.0])?;
    let ray = Ray::new([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]);

    let distance = || scene.trace(&ray).map(|hit| hit.map_or(f64::INFINITY, |hit| hit.t));
    println!("inserted: {}", distance()?);
    scene.move_to(ball, [0.0, 0.0, 9.0])?;
    println!("moved: {}", distance()?);
    scene.remove(ball)?;
    println!("removed: {}", distance()?);
    Ok(())
}
