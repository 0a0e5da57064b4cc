// SPDX-License-Identifier: MIT
//! Snapshots and recordings: the same bytes and answers again, and what becomes of writers and shapes that fail.

use std::io::{self, Write};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, Weak};

use raygrid::{
    Call, ErrorKind, GridConfig, GridId, GridKind, Hit, LocalHit, LocalRay, ObjectId, Ray, Replay, Result, Scene,
    Shape, Sink, Source, UserShape,
};

/// A writer into memory that can be read meanwhile.
#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Vec<u8>>>);

impl Shared {
    fn bytes(&self) -> Vec<u8> {
        self.0.lock().expect("no writer panics").clone()
    }
}

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().expect("no writer panics").extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A writer that asks what becomes of each write and each flush.
struct Asking<F>(F);

impl<F: FnMut(usize) -> io::Result<()>> Write for Asking<F> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        (self.0)(bytes.len()).map(|()| bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        (self.0)(0)
    }
}

/// A square in the plane z = 0, which counts itself while it is there.
struct Square(f64, #[expect(dead_code, reason = "only counted")] Arc<()>);

impl UserShape for Square {
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        ([-self.0, -self.0, 0.0], [self.0, self.0, 0.0])
    }

    fn intersect(&self, ray: &LocalRay) -> Option<LocalHit> {
        let t = -ray.origin[2] / ray.direction[2];
        let inside = [0, 1].map(|axis| (ray.origin[axis] + t * ray.direction[axis]).abs() <= self.0);
        (inside == [true; 2]).then(|| LocalHit::new(t, [0.0, 0.0, 1.0]))
    }
}

/// A square of this size, and a way to see whether it is there.
fn square(size: f64) -> Result<(Shape, Weak<()>)> {
    let there = Arc::new(());
    let seen = Arc::downgrade(&there);
    Ok((Shape::user(Square(size, there))?, seen))
}

fn along_z(x: f64) -> Ray {
    Ray::new([x, 0.0, 0.0], [0.0, 0.0, 1.0])
}

fn hits(scene: &Scene) -> Result<Vec<Hit>> {
    let rays: Vec<_> = (0..20).map(|i| along_z(f64::from(i) * 0.5)).collect();
    let mut hits = vec![Hit::MISS; rays.len()];
    scene.trace_many(&rays, &mut hits)?;
    Ok(hits)
}

/// A scene of balls in a row, one of them gone.
fn balls() -> Result<(Scene, Vec<ObjectId>)> {
    let scene = Scene::builder().workers(1).build()?;
    let places: Vec<[f64; 3]> = (0..8).map(|i| [f64::from(i), 0.0, 5.0 + 0.1 * f64::from(i)]).collect();
    let ids = scene.insert_many(&Shape::sphere(0.4)?, &places)?;
    scene.remove(ids[3])?;
    Ok((scene, ids))
}

#[test]
fn what_is_loaded_is_the_same() -> Result<()> {
    let (scene, ids) = balls()?;
    let bytes = scene.save()?;
    let loaded = Scene::builder().workers(2).load(&bytes)?;
    assert_eq!(loaded.save()?, bytes);
    assert_eq!(hits(&loaded)?, hits(&scene)?);
    assert!(hits(&loaded)?.iter().any(Hit::is_hit));
    assert!(loaded.lookup(ids[3]).is_err());
    let shape = Shape::sphere(1.0)?;
    assert_eq!(loaded.insert(&shape, [0.0; 3])?, scene.insert(&shape, [0.0; 3])?);

    let frame = scene.frame()?;
    scene.remove(ids[0])?;
    assert_eq!(hits(&Scene::load(&frame.save()?)?)?, hits(&frame)?);
    Ok(())
}

#[test]
fn damaged_bytes_are_refused() -> Result<()> {
    let (scene, _) = balls()?;
    let bytes = scene.save()?;
    for end in [0, 7, bytes.len() / 2, bytes.len() - 1] {
        assert_eq!(Scene::load(&bytes[..end]).unwrap_err().kind(), ErrorKind::InvalidData);
    }
    for at in (0..bytes.len()).step_by(97) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 4;
        let error = Scene::load(&damaged).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidData, "{error}");
        assert_eq!(Replay::new(&damaged).unwrap_err(), error);
    }
    Ok(())
}

#[test]
fn every_call_is_recorded_and_played() -> Result<()> {
    let (scene, ids) = balls()?;
    let written = Shared::default();
    scene.record(written.clone())?;
    let ball = scene.insert(&Shape::sphere(2.0)?, [4.0, 0.0, 9.0])?;
    scene.move_to(ball, [4.0, 1.0, 9.0])?;
    scene.move_pose(ball, [4.0, 0.5, 9.0])?;
    scene.set_mask(ball, 2)?;
    assert!(scene.remove(ids[3]).is_err()); // not recorded
    let grid = scene.create_grid(&GridConfig::new(GridKind::Uniform))?;
    scene.configure_grid(grid, &GridConfig::new(GridKind::Hierarchical))?;
    scene.rebuild_grid(GridId::OF_SCENE)?;
    scene.destroy_grid(grid)?;
    let more = scene.insert_many(&Shape::sphere(0.1)?, &[[0.5, 0.0, 1.0], [1.5, 0.0, 1.0]])?;
    scene.move_many(&more, &[[0.5, 0.0, 2.0], [1.5, 0.0, 2.0]])?;
    scene.remove(ids[0])?;
    scene.remove_many(&[more[0], ids[1]])?;
    scene.replace_shape(&scene.shape_of(more[1])?, &Shape::box_between([-0.1; 3], [0.1; 3])?)?;
    scene.end_recording()?;
    scene.remove(ids[2])?; // not recorded either
    scene.end_recording()?; // there is none

    let bytes = written.bytes();
    let mut replay = Replay::new(&bytes)?;
    let steps: Vec<_> = replay.by_ref().collect::<Result<_>>()?;
    let calls: Vec<_> = steps.iter().map(|step| step.call).collect();
    #[rustfmt::skip]
    assert_eq!(calls, [
        Call::Insert, Call::MoveTo, Call::Move, Call::SetMask, Call::GridCreate, Call::GridConfigure, Call::GridRebuild,
        Call::GridDestroy, Call::InsertMany, Call::MoveMany, Call::Remove, Call::RemoveMany,
        Call::ReplaceShape,
    ]);
    assert!(Call::ALL[1..].iter().all(|call| calls.contains(call)), "each call is there");
    let names = ["rg_scene_insert", "rg_scene_move_to", "rg_scene_move", "rg_scene_set_mask", "rg_grid_create"];
    assert_eq!(calls[..5].iter().map(|call| call.name()).collect::<Vec<_>>(), names);
    assert_eq!((steps[0].object, steps[0].objects, steps[0].calls), (Some(ball), 1, 1));
    assert_eq!((steps[4].object, steps[4].grid), (None, grid));
    assert_eq!((steps[11].object, steps[11].objects, steps[11].calls), (Some(more[0]), 2, 12));
    assert_eq!((steps[12].object, steps[12].objects, steps[12].calls), (Some(more[1]), 1, 13));
    assert!(steps.is_sorted_by_key(|step| step.offset) && replay.step()?.is_none());

    let played = replay.into_scene();
    played.remove(ids[2])?;
    assert_eq!(played.save()?, scene.save()?);
    assert_eq!(hits(&played)?, hits(&scene)?);
    Ok(())
}

#[test]
fn a_recording_that_is_cut_off_is_played_up_to_there() -> Result<()> {
    let (scene, ids) = balls()?;
    let written = Shared::default();
    scene.record(written.clone())?;
    scene.move_to(ids[0], [0.0, 0.0, 20.0])?;
    let whole = written.bytes().len();
    scene.move_to(ids[0], [0.0, 0.0, 30.0])?;
    let bytes = written.bytes();
    let mut replay = Replay::new(&bytes[..whole + 8])?;
    let results: Vec<_> = replay.by_ref().take(9).collect();
    assert_eq!(results.len(), 2, "it ends after the error");
    assert_eq!(results[1].as_ref().unwrap_err().kind(), ErrorKind::InvalidData);
    assert_eq!(replay.scene().trace(&along_z(0.0))?.map(|hit| hit.t), Some(19.6));
    Ok(())
}

#[test]
fn dropping_the_scene_ends_the_recording() -> Result<()> {
    let (scene, ids) = balls()?;
    let written = Shared::default();
    scene.record(written.clone())?;
    scene.remove(ids[0])?;
    drop(scene);
    assert_eq!(Arc::strong_count(&written.0), 1, "the writer is dropped");
    assert_eq!(Replay::new(&written.bytes())?.collect::<Result<Vec<_>>>()?.len(), 1);
    Ok(())
}

#[test]
fn a_writer_that_fails_fails_a_snapshot() -> Result<()> {
    let (scene, _) = balls()?;
    for (sink, words) in [
        (Sink::new(Asking(|_| Err(io::Error::other("the disk is full")))), "the disk is full"),
        (Sink::new(Asking(|_| panic!("told to"))), "the writer panicked: told to"),
        (Sink::new(Asking(|n| if n > 0 { Ok(()) } else { Err(io::Error::other("at the end")) })), "at the end"),
    ] {
        let error = scene.save_to(sink).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::CallbackFailed);
        assert!(error.message().ends_with(words), "{error}");
    }
    let error = scene.record(Asking(|_| panic!("told to"))).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::CallbackFailed);
    scene.record(Shared::default())?; // that one never began
    assert_eq!(scene.record(Shared::default()).unwrap_err().kind(), ErrorKind::Busy);
    Ok(())
}

#[test]
fn a_writer_that_fails_ends_a_recording_and_no_call() -> Result<()> {
    for panics in [false, true] {
        let (sender, told) = std::sync::mpsc::channel();
        let scene = Scene::builder().workers(1).log(move |line| sender.send(line.to_owned()).unwrap()).build()?;
        let calls = Arc::new(AtomicUsize::new(0));
        let counted = Arc::clone(&calls);
        scene.record(Asking(move |_| match counted.fetch_add(1, Ordering::Relaxed) {
            0 => Ok(()),
            _ if panics => panic!("told to"),
            _ => Err(io::Error::other("told to")),
        }))?;
        let ball = scene.insert(&Shape::sphere(1.0)?, [0.0, 0.0, 5.0])?;
        scene.move_to(ball, [0.0, 0.0, 9.0])?;
        assert_eq!(scene.trace(&along_z(0.0))?.map(|hit| hit.t), Some(8.0));
        assert!(told.try_iter().any(|line| line.contains("recording")));
        let error = scene.end_recording().unwrap_err();
        assert_eq!(error.kind(), ErrorKind::CallbackFailed);
        assert!(error.message().ends_with("told to"), "{error}");
        assert_eq!(calls.load(Ordering::Relaxed), 2, "a writer that failed is left alone");
        assert_eq!(Arc::strong_count(&calls), 1, "and dropped");
        scene.end_recording()?; // it was over all the same
    }
    Ok(())
}

#[test]
fn a_writer_may_trace_but_not_change_its_scene() -> Result<()> {
    let (scene, ids) = balls()?;
    let scene = Arc::new(scene);
    let (own, ball, kinds) = (Arc::downgrade(&scene), ids[0], Arc::new(Mutex::new(Vec::new())));
    let seen = Arc::clone(&kinds);
    scene.record(Asking(move |count| {
        let Some(scene) = own.upgrade().filter(|_| count > 0) else { return Ok(()) };
        assert!(scene.occluded(&along_z(0.0)).is_ok_and(|hit| hit));
        let refused = [scene.remove(ball), scene.record(Shared::default()), scene.end_recording()];
        seen.lock().unwrap().extend(refused.map(|result| result.unwrap_err().kind()));
        Ok(())
    }))?;
    scene.remove(ids[1])?;
    scene.end_recording()?;
    let kinds = kinds.lock().unwrap();
    assert!(kinds.len() >= 9 && kinds.iter().all(|kind| *kind == ErrorKind::Busy), "{kinds:?}");
    Ok(())
}

#[test]
fn user_defined_shapes_go_by_their_numbers() -> Result<()> {
    let (first, first_seen) = square(1.0)?;
    let (second, _) = square(0.5)?;
    let scene = Scene::builder().workers(1).build()?;
    scene.insert(&first, [0.0, 0.0, 5.0])?;
    assert_eq!(scene.save().unwrap_err().kind(), ErrorKind::InvalidArgument);

    let known = [first.clone(), second.clone()];
    let ids = known.each_ref().map(Shape::id);
    let number = move |shape: &Shape| ids.iter().position(|id| *id == shape.id()).map(|i| i as u64 + 7);
    let written = Shared::default();
    scene.record(Sink::new(written.clone()).number_shapes(number))?;
    scene.insert(&second, [4.0, 0.0, 3.0])?;
    scene.end_recording()?;

    let bytes = written.bytes();
    let mut asked = Vec::new();
    let find = |number: u64, lo: [f64; 3], hi: [f64; 3]| {
        asked.push((number, lo[0], hi[1]));
        known.get(number as usize - 7).cloned()
    };
    let mut replay = Replay::new(Source::new(&bytes).find_shapes(find))?;
    assert_eq!(replay.by_ref().count(), 1);
    let played = replay.into_scene();
    assert_eq!(asked, [(7, -1.0, 1.0), (8, -0.5, 0.5)]);
    assert_eq!(hits(&played)?, hits(&scene)?);
    assert_eq!(played.trace(&along_z(4.5))?.map(|hit| hit.t), Some(3.0));

    drop((scene, played, first, second, known));
    assert!(first_seen.upgrade().is_none(), "no reference is left");
    Ok(())
}

#[test]
fn shapes_that_nobody_knows_are_errors() -> Result<()> {
    let (shape, seen) = square(1.0)?;
    let scene = Scene::builder().workers(1).build()?;
    scene.insert(&shape, [0.0, 0.0, 5.0])?;
    let panicking = Sink::new(io::sink()).number_shapes(|_| panic!("told to"));
    let error = scene.save_to(panicking).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::CallbackFailed);
    assert!(error.message().ends_with("told to"), "{error}");
    let none = scene.save_to(Sink::new(io::sink()).number_shapes(|_| None)).unwrap_err();
    assert_eq!(none.kind(), ErrorKind::InvalidArgument);

    let mut bytes = Vec::new();
    scene.save_to(Sink::new(&mut bytes).number_shapes(|_| Some(1)))?;
    let load = |find: fn(u64, [f64; 3], [f64; 3]) -> Option<Shape>| {
        Scene::builder().load(Source::new(&bytes).find_shapes(find)).unwrap_err()
    };
    let errors = [
        (load(|_, _, _| None), "there is no shape 1"),
        (load(|_, _, _| panic!("told to")), "told to"),
        (load(|_, _, _| square(2.0).ok().map(|(other, _)| other)), ""),
        (load(|_, _, _| Shape::sphere(1.0).ok()), ""),
    ];
    for (error, words) in errors {
        assert_eq!(error.kind(), ErrorKind::CallbackFailed, "{error}");
        assert!(error.message().ends_with(words), "{error}");
    }
    assert!(Scene::load(&bytes).is_err());

    let other = Scene::builder().load(Source::new(&bytes).find_shapes(|_, _, _| Some(shape.clone())))?;
    drop((scene, other, shape));
    assert!(seen.upgrade().is_none(), "no reference is left");
    Ok(())
}

#[test]
fn a_step_may_be_tried_again() -> Result<()> {
    let (shape, _) = square(1.0)?;
    let scene = Scene::builder().workers(1).build()?;
    let written = Shared::default();
    scene.record(Sink::new(written.clone()).number_shapes(|_| Some(1)))?;
    scene.insert(&shape, [0.0, 0.0, 5.0])?;
    scene.end_recording()?;

    let bytes = written.bytes();
    let mut tries = 0;
    let find = |_, _, _| {
        tries += 1;
        (tries > 2).then(|| shape.clone())
    };
    let mut replay = Replay::new(Source::new(&bytes).find_shapes(find))?;
    assert_eq!(replay.next().map(|step| step.unwrap_err().kind()), Some(ErrorKind::CallbackFailed));
    assert!(replay.next().is_none());
    assert!(replay.step().is_err());
    assert_eq!(replay.step()?.map(|step| step.call), Some(Call::Insert));
    assert_eq!(replay.scene().trace(&along_z(0.0))?.map(|hit| hit.t), Some(5.0));
    Ok(())
}
