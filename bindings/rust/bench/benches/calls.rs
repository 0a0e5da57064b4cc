// SPDX-License-Identifier: MIT
//! What a call costs from Rust, beside the same call of the C interface: `cargo bench`. Times are the thread's.

use std::ptr;
use std::time::Duration;

use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{Criterion, criterion_group, criterion_main};
use raygrid::{Hit, ObjectId, Ray, Scene, Shape};
use raygrid_bench::clock::thread_time;
use raygrid_bench::world::World;
use raygrid_sys as sys;

/// The time that this thread has computed.
struct ThreadTime;

impl Measurement for ThreadTime {
    type Intermediate = Duration;
    type Value = Duration;

    fn start(&self) -> Duration {
        thread_time()
    }

    fn end(&self, start: Duration) -> Duration {
        thread_time() - start
    }

    fn add(&self, a: &Duration, b: &Duration) -> Duration {
        *a + *b
    }

    fn zero(&self) -> Duration {
        Duration::ZERO
    }

    fn to_f64(&self, value: &Duration) -> f64 {
        value.as_nanos() as f64
    }

    fn formatter(&self) -> &dyn ValueFormatter {
        WallTime.formatter()
    }
}

const COUNT: usize = 1000;

/// The same scene in C: made by the C calls alone.
struct InC {
    scene: *mut sys::rg_scene,
    ids: Vec<u64>,
}

impl InC {
    fn new(world: &World) -> Self {
        let mut config = sys::rg_scene_config { size: size_of::<sys::rg_scene_config>(), ..Default::default() };
        config.workers = 1;
        let (mut scene, mut shape) = (ptr::null_mut(), ptr::null_mut());
        let mut ids = vec![0; world.centres.len()];
        // SAFETY: what is written and read is there; the scene keeps the shape.
        unsafe {
            assert_eq!(sys::rg_scene_create(&config, &mut scene), sys::RG_OK);
            assert_eq!(sys::rg_shape_create_sphere(ptr::null(), world.radius.into(), &mut shape), sys::RG_OK);
            for (centre, id) in world.centres.iter().zip(&mut ids) {
                let [x, y, z] = centre.map(f64::from);
                assert_eq!(sys::rg_scene_insert(scene, shape, &sys::rg_pose_at(x, y, z), id), sys::RG_OK);
            }
            sys::rg_shape_release(&mut shape);
        }
        Self { scene, ids }
    }
}

impl Drop for InC {
    fn drop(&mut self) {
        // SAFETY: nobody uses it any more.
        unsafe { sys::rg_scene_destroy(&mut self.scene) };
    }
}

fn in_rust(world: &World) -> (Scene, Vec<ObjectId>) {
    let scene = Scene::builder().workers(1).build().expect("a scene");
    let ids = scene.insert_many(&Shape::sphere(world.radius.into()).expect("a sphere"), &world.centres);
    (scene, ids.expect("objects"))
}

/// Places near those of the spheres, to and fro.
fn places(world: &World) -> Vec<[f64; 3]> {
    let shifted = |centre: &[f32; 3], by: f32| centre.map(|x| f64::from(x + by * world.radius));
    world.centres.iter().map(|c| shifted(c, 0.1)).chain(world.centres.iter().map(|c| shifted(c, 0.0))).collect()
}

fn moves(criterion: &mut Criterion<ThreadTime>) {
    let world = World::new(COUNT);
    let (places, c, (scene, ids)) = (places(&world), InC::new(&world), in_rust(&world));
    let mut group = criterion.benchmark_group("move_to");
    let mut i = 0;
    group.bench_function("C", |bencher| {
        bencher.iter(|| {
            i = (i + 1) % places.len();
            // SAFETY: the scene is there, the place is three doubles.
            unsafe { sys::rg_scene_move_to(c.scene, c.ids[i % COUNT], places[i].as_ptr()) }
        });
    });
    group.bench_function("Rust", |bencher| {
        bencher.iter(|| {
            i = (i + 1) % places.len();
            scene.move_to(ids[i % COUNT], places[i])
        });
    });
    group.finish();
}

fn traces(criterion: &mut Criterion<ThreadTime>) {
    let mut world = World::new(COUNT);
    let (c, (scene, _)) = (InC::new(&world), in_rust(&world));
    let rays: Vec<Ray> = world.rays(4096);
    let mut group = criterion.benchmark_group("trace");
    let mut i = 0;
    group.bench_function("C", |bencher| {
        bencher.iter(|| {
            i = (i + 1) % rays.len();
            let mut hit = sys::rg_hit::default();
            // SAFETY: the scene is there; Ray is laid out as rg_ray.
            let result = unsafe { sys::rg_scene_trace(c.scene, (&raw const rays[i]).cast(), &mut hit, 1) };
            (result, hit.t)
        });
    });
    group.bench_function("Rust", |bencher| {
        bencher.iter(|| {
            i = (i + 1) % rays.len();
            scene.trace(&rays[i]).map(|hit| hit.map_or(f64::INFINITY, |hit| hit.t))
        });
    });
    group.bench_function("Rust, into a slice of one", |bencher| {
        bencher.iter(|| {
            i = (i + 1) % rays.len();
            let mut hit = [Hit::MISS];
            scene.trace_many(&rays[i..=i], &mut hit).map(|()| hit[0].t)
        });
    });
    group.finish();
}

criterion_group! {
    name = calls;
    config = Criterion::default().with_measurement(ThreadTime);
    targets = moves, traces
}
criterion_main!(calls);
