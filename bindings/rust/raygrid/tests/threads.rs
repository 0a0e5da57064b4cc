// SPDX-License-Identifier: MIT
//! One scene, many threads: traces beside changes, and rayon's threads in place of workers.

use std::sync::atomic::{AtomicBool, Ordering};

use raygrid::{Hit, Ray, Result, Scene, Shape};

/// Objects that are moved together, so that a change seen by half shows.
const PAIR: [f64; 2] = [0.0, 100.0];

fn pair_at(z: f64) -> [[f64; 3]; 2] {
    PAIR.map(|x| [x, 0.0, z])
}

/// What rays at both of the pair hit, which must be the same.
fn seen(scene: &Scene) -> Result<f64> {
    let rays = PAIR.map(|x| Ray::new([x, 0.0, 0.0], [0.0, 0.0, 1.0]));
    let mut hits = [Hit::MISS; 2];
    scene.trace_many(&rays, &mut hits)?;
    assert_eq!(hits[0].t, hits[1].t, "a change was seen by half");
    Ok(hits[0].t)
}

#[test]
fn changes_are_seen_whole_or_not_at_all() -> Result<()> {
    const MOVES: u32 = 20_000;
    let scene = Scene::builder().workers(2).build()?;
    let ids = scene.insert_many(&Shape::sphere(1.0)?, &pair_at(2.0))?;
    let done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let readers: Vec<_> = (0..3)
            .map(|_| {
                scope.spawn(|| {
                    let mut last = 0.0;
                    while !done.load(Ordering::Relaxed) {
                        let t = seen(&scene)?;
                        assert!(t >= last, "the pair went back from {last} to {t}");
                        last = t;
                    }
                    Ok(())
                })
            })
            .collect();
        for i in 0..MOVES {
            scene.move_many(&ids, &pair_at(2.0 + f64::from(i)))?;
        }
        done.store(true, Ordering::Relaxed);
        readers.into_iter().try_for_each(|reader| reader.join().expect("no panic"))
    })?;
    assert_eq!(seen(&scene)?, f64::from(MOVES));
    Ok(())
}

#[test]
fn inserts_and_removes_from_many_threads() -> Result<()> {
    let scene = Scene::new()?;
    let shape = Shape::sphere(0.5)?;
    std::thread::scope(|scope| {
        let (scene, shape) = (&scene, &shape);
        let threads: Vec<_> = (0..4)
            .map(|thread| {
                scope.spawn(move || {
                    let mut own = Vec::new();
                    for i in 0..500 {
                        let place = [f64::from(thread) * 10.0, f64::from(i) * 2.0, 5.0];
                        own.push((scene.insert(shape, place)?, place));
                        if i % 3 == 2 {
                            scene.remove(own.remove(0).0)?;
                        }
                        let (id, [x, y, _]) = own[own.len() / 2];
                        let hit = scene.trace(&Ray::new([x, y, 0.0], [0.0, 0.0, 1.0]))?;
                        assert_eq!(hit.and_then(|hit| hit.object), Some(id));
                    }
                    Ok(own.len() as u64)
                })
            })
            .collect();
        let left = threads.into_iter().map(|thread| thread.join().expect("no panic")).sum::<Result<u64>>()?;
        assert_eq!(scene.stats()?.objects, left);
        Ok(())
    })
}

#[test]
fn a_scene_goes_from_thread_to_thread() -> Result<()> {
    let scene = Scene::new()?;
    let shape = Shape::sphere(1.0)?;
    let scene = std::thread::spawn(move || scene.insert(&shape, [0.0, 0.0, 5.0]).map(|_| scene)).join().unwrap()?;
    assert_eq!(scene.trace(&Ray::new([0.0; 3], [0.0, 0.0, 1.0]))?.unwrap().t, 4.0);
    Ok(())
}

/// Threads of rayon that trace and change a scene which traces on rayon: none may wait for itself.
#[cfg(feature = "rayon")]
#[test]
fn rayon_traces_and_changes_without_waiting_for_itself() -> Result<()> {
    use rayon::prelude::*;

    const RAYS: usize = 3000;
    let scene = Scene::builder().rayon().build()?;
    let places: Vec<[f64; 3]> = (0..RAYS).map(|i| [i as f64, 0.0, 5.0]).collect();
    let ids = scene.insert_many(&Shape::sphere(0.25)?, &places)?;
    let rays: Vec<Ray> = places.iter().map(|place| Ray::new([place[0], 0.0, 0.0], [0.0, 0.0, 1.0])).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().expect("a pool");
    pool.install(|| {
        (0..400_usize).into_par_iter().try_for_each(|i| {
            if i % 2 == 0 {
                let mut hits = vec![Hit::MISS; RAYS];
                scene.trace_many(&rays, &mut hits)?;
                assert!(hits.iter().zip(&ids).all(|(hit, id)| hit.object == Some(*id)));
                Ok(())
            } else {
                scene.move_to(ids[i], [i as f64, 0.0, 5.0 + i as f64])
            }
        })
    })?;
    assert_eq!(scene.trace(&rays[399])?.unwrap().t, 403.75);
    Ok(())
}
