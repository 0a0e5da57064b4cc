// SPDX-License-Identifier: MIT
//! A picture of balls and crates on a floor, in the sun: `cargo run --release --example picture [FILE [WIDTH]]`

use std::fs::File;
use std::io::BufWriter;

use raygrid::views::Poses;
use raygrid::{Coherence, Hit, ObjectId, Pose, Ray, Scene, Shape};

/// Where the light comes from.
const SUN: [f64; 3] = [0.5, 0.8, -0.4];
const EYE: [f64; 3] = [0.0, 3.0, -12.0];

type Colour = [f64; 3];

fn make(scene: &Scene) -> raygrid::Result<ObjectId> {
    let infinite = f64::INFINITY;
    let floor = Shape::box_between([-infinite, -1.0, -infinite], [infinite, 0.0, infinite])?;
    let floor = scene.insert(&floor, [0.0; 3])?;
    let (ball, brick) = (Shape::sphere(1.0)?, Shape::box_between([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5])?);
    // Balls on a spiral, each smaller than the last: one shape, a scale each.
    let turns: Vec<f64> = (0..60).map(|i| f64::from(i) * 0.4).collect();
    let scales: Vec<f64> = turns.iter().map(|turn| 1.6 / (1.0 + 0.22 * turn)).collect();
    let at = |(turn, scale): (&f64, &f64)| {
        let radius = 1.5 + 0.45 * turn;
        [radius * turn.cos(), *scale, 4.0 + radius * turn.sin()]
    };
    let places: Vec<[f64; 3]> = turns.iter().zip(&scales).map(at).collect();
    scene.insert_many(&ball, Poses::at(&places).scale(&scales))?;
    // Crates, turned about the vertical.
    for i in 0..14_u8 {
        let angle = f32::from(i);
        let (sin, cos) = angle.sin_cos();
        let turned = [[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]];
        let place = [f64::from(i) * 1.9 - 12.0, 0.0, f64::from(i % 3) * 2.0 - 5.0];
        scene.insert(&brick, Pose::at(place).linear(turned).scale(0.7 + 0.1 * f64::from(i % 4)))?;
    }
    Ok(floor)
}

fn camera(width: usize, height: usize) -> Vec<Ray> {
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let place = |at: usize, of: usize| (at as f64 + 0.5) / of as f64 - 0.5;
    let aspect = width as f64 / height as f64;
    pixels.map(|(x, y)| Ray::new(EYE, [place(x, width) * aspect, -0.12 - place(y, height), 1.0])).collect()
}

/// What a surface looks like that has no light but the sky's, and how much of the sun's falls on it.
fn surface(hit: &Hit, floor: ObjectId) -> (Colour, f64) {
    let normal = hit.normal.map(f64::from);
    let colour = match hit.object {
        Some(object) if object == floor => {
            let even = (hit.position[0].floor() + hit.position[2].floor()).rem_euclid(2.0) == 0.0;
            if even { [0.55, 0.53, 0.5] } else { [0.4, 0.42, 0.45] }
        }
        object => {
            let hue = f64::from(object.map_or(0, ObjectId::slot)) * 0.61;
            [0.0, 0.33, 0.67].map(|shift| 0.5 + 0.3 * ((hue + shift) * std::f64::consts::TAU).cos())
        }
    };
    let facing: f64 = (0..3).map(|axis| normal[axis] * SUN[axis]).sum();
    (colour, facing.max(0.0))
}

fn shade(scene: &Scene, rays: &[Ray], floor: ObjectId) -> raygrid::Result<Vec<Colour>> {
    let mut hits = vec![Hit::MISS; rays.len()];
    scene.query().coherence(Coherence::High).trace_many(rays, &mut hits)?;
    // From each hit to the sun; rays of misses have nowhere to go.
    let to_sun = |hit: &Hit| Ray::new(hit.leave(SUN), SUN).until(if hit.is_hit() { f64::INFINITY } else { 0.0 });
    let shadow_rays: Vec<Ray> = hits.iter().map(to_sun).collect();
    let mut shadowed = vec![false; rays.len()];
    scene.occluded_many(&shadow_rays, &mut shadowed)?;
    let pixels = rays.iter().zip(&hits).zip(shadowed);
    let colours = pixels.map(|((ray, hit), shadowed)| {
        let sky = |height: f64| [0.75 - 0.45 * height, 0.83 - 0.3 * height, 0.95 - 0.1 * height];
        if !hit.is_hit() {
            return sky(ray.direction[1].clamp(0.0, 1.0));
        }
        let (colour, facing) = surface(hit, floor);
        let light = 0.35 + if shadowed { 0.0 } else { 0.9 * facing };
        let haze = 1.0 - (-hit.t / 120.0).exp();
        std::array::from_fn(|i| colour[i] * light * (1.0 - haze) + sky(0.0)[i] * haze)
    });
    Ok(colours.collect())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().unwrap_or_else(|| "picture.png".into());
    let width = arguments.next().map_or(Ok(960), |text| text.parse::<u32>())?;
    let height = width * 9 / 16;
    let scene = Scene::new()?;
    let floor = make(&scene)?;
    let colours = shade(&scene, &camera(width as usize, height as usize), floor)?;

    let mut encoder = png::Encoder::new(BufWriter::new(File::create(&path)?), width, height);
    encoder.set_color(png::ColorType::Rgb);
    let bytes: Vec<u8> =
        colours.as_flattened().iter().map(|x| (x.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0) as u8).collect();
    encoder.write_header()?.write_image_data(&bytes)?;
    println!("{path}: {width} x {height} pixels, {} objects", scene.stats()?.objects);
    Ok(())
}
