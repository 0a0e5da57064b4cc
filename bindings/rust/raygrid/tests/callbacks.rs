// SPDX-License-Identifier: MIT
//! User-defined shapes, filters, logs, job systems: what they may do, and what becomes of their panics.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, Once, OnceLock, Weak};

use raygrid::{
    ErrorKind, GridConfig, GridId, GridKind, Hit, LocalHit, LocalRay, ParallelFor, Ray, Result, Scene, Shape,
    UserShape,
};

/// Keeps quiet of panics that were asked for: those of the scene's own threads would fill the log.
fn told_to_panic() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            let words = info.payload().downcast_ref::<String>().map(String::as_str);
            let words = words.or_else(|| info.payload().downcast_ref::<&str>().copied()).unwrap_or_default();
            if !words.starts_with("told to") {
                before(info);
            }
        }));
    });
}

const ALONG_Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Rays along z through a lattice of x from 0 up.
fn rays(count: usize) -> Vec<Ray> {
    (0..count).map(|i| Ray::new([i as f64, 0.0, 0.0], ALONG_Z)).collect()
}

/// A disc of radius 1/4 in the plane z = 0, which asks something each time.
struct Disc<F>(F);

impl<F: Fn(&LocalRay) + Send + Sync + 'static> UserShape for Disc<F> {
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        ([-0.25, -0.25, 0.0], [0.25, 0.25, 0.0])
    }

    fn intersect(&self, ray: &LocalRay) -> Option<LocalHit> {
        (self.0)(ray);
        let t = -ray.origin[2] / ray.direction[2];
        let [x, y] = [0, 1].map(|axis| ray.origin[axis] + t * ray.direction[axis]);
        (x * x + y * y <= 0.0625).then(|| LocalHit { u: 0.5, primitive: 7, ..LocalHit::new(t, [0.0, 0.0, -2.0]) })
    }
}

/// A line of discs, and the panics of those at even places while `fails` is set.
fn discs_that_fail(workers: u32, count: usize) -> Result<(Scene, Arc<AtomicBool>)> {
    let fails = Arc::new(AtomicBool::new(false));
    let own = Arc::clone(&fails);
    let good = Shape::user(Disc(|_: &LocalRay| ()))?;
    let bad = Shape::user(Disc(move |_: &LocalRay| assert!(!own.load(Ordering::Relaxed), "told to")))?;
    let scene = Scene::builder().workers(workers).build()?;
    for i in 0..count {
        scene.insert(if i % 2 == 0 { &bad } else { &good }, [i as f64, 0.0, 5.0])?;
    }
    Ok((scene, fails))
}

#[test]
fn a_shape_of_ones_own() -> Result<()> {
    let (scene, _) = discs_that_fail(1, 2)?;
    let hit = scene.trace(&Ray::new([0.1, 0.1, 0.0], ALONG_Z))?.unwrap();
    assert_eq!((hit.t, hit.normal, hit.u, hit.v, hit.primitive), (5.0, [0.0, 0.0, -1.0], 0.5, 0.0, 7));
    assert!(scene.occluded(&Ray::new([0.1, 0.1, 0.0], ALONG_Z))?);
    assert!(!scene.occluded(&Ray::new([0.2, 0.2, 0.0], ALONG_Z))?);
    assert!(!scene.occluded(&Ray::new([0.1, 0.1, 0.0], ALONG_Z).until(4.0))?);
    Ok(())
}

#[test]
fn a_panic_of_a_shape_is_an_error_and_the_scene_goes_on() -> Result<()> {
    told_to_panic();
    const COUNT: usize = 3000;
    for workers in [1, 3] {
        let (scene, fails) = discs_that_fail(workers, COUNT)?;
        let (rays, mut before, mut hits) = (rays(COUNT), vec![Hit::MISS; COUNT], vec![Hit::MISS; COUNT]);
        scene.trace_many(&rays, &mut before)?;
        assert!(before.iter().all(|hit| hit.t == 5.0));
        fails.store(true, Ordering::Relaxed);
        assert_eq!(scene.trace_many(&rays, &mut hits).unwrap_err().kind(), ErrorKind::CallbackFailed);
        for (i, hit) in hits.iter().enumerate() {
            assert!(if i % 2 == 0 { hit.t.is_nan() } else { *hit == before[i] }, "ray {i}: {hit:?}");
        }
        assert_eq!(scene.trace(&rays[0]).unwrap_err().kind(), ErrorKind::CallbackFailed);
        assert_eq!(scene.occluded(&rays[0]).unwrap_err().kind(), ErrorKind::CallbackFailed);
        assert!(scene.trace(&rays[1])?.is_some());
        fails.store(false, Ordering::Relaxed);
        scene.trace_many(&rays, &mut hits)?;
        assert_eq!(hits, before);
    }
    Ok(())
}

#[test]
fn a_shape_that_says_nan_is_an_error() -> Result<()> {
    struct Nowhere;
    impl UserShape for Nowhere {
        fn bounds(&self) -> ([f64; 3], [f64; 3]) {
            ([-1.0; 3], [1.0; 3])
        }
        fn intersect(&self, _: &LocalRay) -> Option<LocalHit> {
            Some(LocalHit::new(f64::NAN, [1.0, 0.0, 0.0]))
        }
    }
    let scene = Scene::new()?;
    scene.insert(&Shape::user(Nowhere)?, [0.0; 3])?;
    let error = scene.trace(&Ray::new([0.0, 0.0, -9.0], ALONG_Z)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::CallbackFailed);
    Ok(())
}

/// Tells when it is dropped.
struct Tells(Arc<AtomicU64>);

impl Drop for Tells {
    fn drop(&mut self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

fn that_tells(drops: &Arc<AtomicU64>) -> Result<Shape> {
    let told = Tells(Arc::clone(drops));
    Shape::user(Disc(move |_: &LocalRay| {
        let _ = &told;
    }))
}

#[test]
fn a_shape_is_dropped_with_its_last_reference() -> Result<()> {
    let drops = Arc::new(AtomicU64::new(0));
    let dropped = || drops.load(Ordering::Relaxed);
    let (scene, other) = (Scene::new()?, Scene::new()?);
    let shape = that_tells(&drops)?;
    let first = scene.insert(&shape, [0.0; 3])?;
    other.insert_many(&shape, &[[0.0; 3]; 3])?;
    drop(shape.clone());
    drop(shape);
    scene.remove(first)?;
    assert_eq!(dropped(), 0);
    drop(other);
    assert_eq!(dropped(), 1);
    let last = scene.insert(&that_tells(&drops)?, [0.0; 3])?;
    scene.remove_many(&[last])?;
    assert_eq!(dropped(), 2);
    struct Flat(#[allow(dead_code)] Tells);
    impl UserShape for Flat {
        fn bounds(&self) -> ([f64; 3], [f64; 3]) {
            ([1.0; 3], [-1.0; 3])
        }
        fn intersect(&self, _: &LocalRay) -> Option<LocalHit> {
            None
        }
    }
    assert_eq!(Shape::user(Flat(Tells(Arc::clone(&drops)))).unwrap_err().kind(), ErrorKind::InvalidValue);
    assert_eq!(dropped(), 3, "also if it can't be made");
    Ok(())
}

/// A shape whose drop uses the very scene that it was removed from.
#[test]
fn what_is_dropped_may_use_the_scene() -> Result<()> {
    struct Leaving(Weak<Scene>, Shape);
    impl Drop for Leaving {
        fn drop(&mut self) {
            if let Some(scene) = self.0.upgrade() {
                scene.insert(&self.1, [0.0, 0.0, 9.0]).expect("the scene is free again");
            }
        }
    }
    let scene = Arc::new(Scene::new()?);
    let leaving = Leaving(Arc::downgrade(&scene), Shape::sphere(1.0)?);
    let shape = Shape::user(Disc(move |_: &LocalRay| {
        let _ = &leaving;
    }))?;
    let id = scene.insert(&shape, [0.0, 0.0, 5.0])?;
    drop(shape);
    scene.remove(id)?;
    assert_eq!(scene.trace(&Ray::new([0.0; 3], ALONG_Z))?.unwrap().t, 8.0);
    Ok(())
}

#[test]
fn callbacks_may_trace_but_not_change_their_scene() -> Result<()> {
    let scene = Arc::new(Scene::builder().workers(1).build()?);
    let wall = scene.insert(&Shape::box_between([-9.0, -9.0, 0.0], [9.0, 9.0, 1.0])?, [0.0, 0.0, 8.0])?;
    let told = Arc::new(Mutex::new(Vec::new()));
    let (own, own_told) = (Arc::downgrade(&scene), Arc::clone(&told));
    let asks = Disc(move |_: &LocalRay| {
        let Some(scene) = own.upgrade() else { return };
        let behind = scene.trace(&Ray::new([0.0, 0.0, 6.0], ALONG_Z)).map(|hit| hit.map(|hit| hit.t));
        let moved = scene.move_to(wall, [0.0; 3]).map_err(|error| error.kind());
        own_told.lock().unwrap().push((behind, moved, scene.stats().map(|report| report.objects)));
    });
    scene.insert(&Shape::user(asks)?, [0.0, 0.0, 5.0])?;
    assert_eq!(scene.trace(&Ray::new([0.0; 3], ALONG_Z))?.unwrap().t, 5.0);
    let told = told.lock().unwrap();
    assert!(!told.is_empty() && told.iter().all(|one| *one == (Ok(Some(2.0)), Err(ErrorKind::Busy), Ok(2))));
    Ok(())
}

#[test]
fn filters_see_each_ray_by_its_number() -> Result<()> {
    const COUNT: usize = 2000;
    let scene = Scene::builder().workers(3).build()?;
    let places: Vec<[f64; 3]> = (0..COUNT).flat_map(|i| [[i as f64, 0.0, 5.0], [i as f64, 0.0, 7.0]]).collect();
    let ids = scene.insert_many(&Shape::sphere(0.25)?, &places)?;
    let (rays, mut hits) = (rays(COUNT), vec![Hit::MISS; COUNT]);
    // Each third ray passes through what it meets first.
    let filter = |index: usize, hit: &Hit| index % 3 != 0 || hit.object != Some(ids[2 * index]);
    scene.query().filter(&filter).trace_many(&rays, &mut hits)?;
    for (i, hit) in hits.iter().enumerate() {
        assert_eq!(hit.object, Some(ids[2 * i + usize::from(i % 3 == 0)]), "ray {i}");
    }
    let mut occluded = vec![true; COUNT];
    scene.query().filter(&|index, _: &Hit| index % 2 == 0).occluded_views(&rays[..], &mut occluded)?;
    assert!(occluded.iter().enumerate().all(|(i, any)| *any == (i % 2 == 0)));
    Ok(())
}

#[test]
fn a_panic_of_a_filter_is_an_error_that_says_it() -> Result<()> {
    told_to_panic();
    const COUNT: usize = 2000;
    let scene = Scene::builder().workers(3).build()?;
    let places: Vec<[f64; 3]> = (0..COUNT).map(|i| [i as f64, 0.0, 5.0]).collect();
    scene.insert_many(&Shape::sphere(0.25)?, &places)?;
    let (rays, mut hits) = (rays(COUNT), vec![Hit::MISS; COUNT]);
    let filter = |index: usize, _: &Hit| {
        assert!(index != 1234, "told to at {index}");
        true
    };
    let error = scene.query().filter(&filter).trace_many(&rays, &mut hits).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::CallbackFailed);
    assert_eq!(error.message(), "the filter panicked: told to at 1234");
    assert!(hits.iter().enumerate().all(|(i, hit)| if i == 1234 { hit.is_invalid() } else { hit.t == 4.75 }));
    assert!(scene.trace(&rays[1234])?.is_some());
    Ok(())
}

#[test]
fn a_log_is_told_and_may_use_the_scene() -> Result<()> {
    static SCENE: OnceLock<Scene> = OnceLock::new();
    static LINES: Mutex<Vec<String>> = Mutex::new(Vec::new());
    let tell = |line: &str| {
        let objects = SCENE.get().map_or(0, |scene| scene.stats().map_or(0, |report| report.objects));
        LINES.lock().unwrap().push(format!("{objects}: {line}"));
    };
    let made = Scene::builder().grid(GridConfig::new(GridKind::Uniform)).log(tell).build()?;
    let scene = SCENE.get_or_init(|| made);
    scene.insert_many(&Shape::sphere(1.0)?, &[[0.0; 3]; 40])?;
    scene.rebuild_grid(GridId::OF_SCENE)?;
    let lines = LINES.lock().unwrap();
    assert!(!lines.is_empty() && lines.iter().all(|line| line.starts_with("40: ") && line.len() > 8), "{lines:?}");
    Ok(())
}

/// A job system that does what `work` says.
struct Host<F>(F);

impl<F: Fn(u64, &(dyn Fn() + Sync)) + Send + Sync + 'static> ParallelFor for Host<F> {
    fn run(&self, count: u64, work: &(dyn Fn() + Sync)) {
        (self.0)(count, work);
    }
}

/// Traces on a job system, and how often it was asked.
fn traced_by(host: impl Fn(u64, &(dyn Fn() + Sync)) + Send + Sync + 'static) -> Result<(Vec<Hit>, u64)> {
    const COUNT: usize = 5000;
    let asked = Arc::new(AtomicU64::new(0));
    let own = Arc::clone(&asked);
    let counting = Host(move |count, work: &(dyn Fn() + Sync)| {
        own.fetch_add(1, Ordering::Relaxed);
        host(count, work);
    });
    let scene = Scene::builder().parallel_for(counting).build()?;
    let places: Vec<[f64; 3]> = (0..COUNT).map(|i| [i as f64, 0.0, 5.0 + (i % 7) as f64]).collect();
    scene.insert_many(&Shape::sphere(0.25)?, &places)?;
    let mut hits = vec![Hit::MISS; COUNT];
    scene.trace_many(&rays(COUNT), &mut hits)?;
    Ok((hits, asked.load(Ordering::Relaxed)))
}

#[test]
fn job_systems_do_all_pieces_once_whatever_they_do() -> Result<()> {
    let each = |count: u64, work: &(dyn Fn() + Sync)| (0..count).for_each(|_| work());
    let (wanted, asked) = traced_by(each)?;
    assert!(asked > 0 && wanted.iter().enumerate().all(|(i, hit)| hit.t == 4.75 + (i % 7) as f64));
    let threads = |count: u64, work: &(dyn Fn() + Sync)| {
        std::thread::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(|| (0..count).for_each(|_| work()));
            }
        });
    };
    assert_eq!(traced_by(threads)?.0, wanted);
    assert_eq!(traced_by(|_, _: &(dyn Fn() + Sync)| ())?.0, wanted);
    told_to_panic();
    let panics = |_: u64, work: &(dyn Fn() + Sync)| {
        work();
        panic!("told to");
    };
    assert_eq!(traced_by(panics)?.0, wanted);
    Ok(())
}
