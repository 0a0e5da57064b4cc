// SPDX-License-Identifier: MIT
//! Meshes that read data of the host where it lies: the same answers, and when the data is dropped.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Weak};

use raygrid::views::{Indices, Vectors};
use raygrid::{ErrorKind, Hit, MeshData, MeshQuality, Ray, Result, Scene, Shape};

const TRIANGLES: u32 = 200;

/// A corner of a triangle; as it lies in the memory of some hosts.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Corner {
    colour: [f32; 4],
    at: [f64; 3],
}

/// Triangles that share nothing, by indices, the last first; counts how often it was dropped.
struct Model {
    corners: Vec<Corner>,
    faces: Vec<[u16; 3]>,
    drops: Arc<AtomicU32>,
}

impl Model {
    /// Coordinates that are no floats, or that are.
    fn new(phase: f64, floats: bool, drops: &Arc<AtomicU32>) -> Self {
        let place = |i: u32, axis: u32| {
            let x = (f64::from(i / 3) * [1.7, 2.3, 3.1][axis as usize]).sin()
                + 0.1 * f64::from(i * (axis + 1)).sin()
                + phase;
            if floats { f64::from(x as f32) } else { x }
        };
        let corner = |i| Corner { colour: [1.0; 4], at: [0, 1, 2].map(|axis| place(i, axis)) };
        let last = 3 * TRIANGLES as u16 - 1;
        Self {
            corners: (0..3 * TRIANGLES).map(corner).collect(),
            faces: (0..TRIANGLES as u16).map(|i| [0, 1, 2].map(|c| last - 3 * i - c)).collect(),
            drops: Arc::clone(drops),
        }
    }
}

impl Drop for Model {
    fn drop(&mut self) {
        self.drops.fetch_add(1, Ordering::Relaxed);
    }
}

impl MeshData for Model {
    fn vertices(&self) -> Vectors<'_> {
        Vectors::field(&self.corners, |corner| &corner.at)
    }

    fn triangles(&self) -> Option<Indices<'_>> {
        Some(Indices::from(&self.faces).rev())
    }
}

fn hits(mesh: &Shape) -> Result<Vec<Hit>> {
    let scene = Scene::builder().workers(1).build()?;
    scene.insert(mesh, [0.0; 3])?;
    let aim = |i: u32, axis: u32| (f64::from(i) * [0.7, 1.3, 1.9][axis as usize]).sin();
    let rays: Vec<Ray> =
        (0..500).map(|i| Ray::new([0, 1, 2].map(|a| 2.0 * aim(i, a)), [0, 1, 2].map(|a| -aim(i + 1, a)))).collect();
    let mut hits = vec![Hit::MISS; rays.len()];
    scene.trace_many(&rays, &mut hits)?;
    assert!(hits.iter().any(|hit| hit.t < f64::INFINITY));
    Ok(hits)
}

fn demand_same(one: &Shape, other: &Shape) -> Result<()> {
    for (a, b) in hits(one)?.iter().zip(&hits(other)?) {
        assert_eq!((a.t.to_bits(), a.primitive, a.normal), (b.t.to_bits(), b.primitive, b.normal));
    }
    Ok(())
}

#[test]
fn same_answers_in_less_memory() -> Result<()> {
    let drops = Arc::new(AtomicU32::new(0));
    let (home, bent) = (Arc::new(Model::new(0.0, false, &drops)), Arc::new(Model::new(0.1, false, &drops)));
    let copied = Shape::mesh(home.vertices(), home.triangles().expect("faces"))?;
    let mesh = Shape::mesh_of(Arc::clone(&home))?;
    let vertices = 3 * 24 * u64::from(TRIANGLES);
    assert_eq!(copied.stats()?.bytes - mesh.stats()?.bytes, vertices + 12 * u64::from(TRIANGLES));
    demand_same(&mesh, &copied)?;
    let making = Shape::mesh_builder().quality(MeshQuality::Fast);
    let (other, copied) = (making.deformed_of(&mesh, Arc::clone(&bent))?, making.deformed(&mesh, bent.vertices())?);
    drop(mesh);
    assert_eq!((Arc::strong_count(&home), Arc::strong_count(&bent)), (1, 2));
    drop(home);
    assert_eq!(copied.stats()?.bytes - other.stats()?.bytes, vertices);
    demand_same(&other, &copied)?;
    demand_same(
        &making.mesh_of((vec![[0.1; 3], [0.9, 0.0, 0.0], [0.0, 0.9, 0.0]], vec![[2_u64, 1, 0]]))?,
        &making.triangles(&[[0.0, 0.9, 0.0], [0.9, 0.0, 0.0], [0.1; 3]])?,
    )
}

#[test]
fn dropped_with_the_last_object() -> Result<()> {
    let drops = Arc::new(AtomicU32::new(0));
    let scene = Arc::new(Scene::new()?);
    let ids = scene.insert_many(&Shape::mesh_of(Model::new(0.0, false, &drops))?, &[[0.0; 3], [9.0, 0.0, 0.0]])?;
    let frame = scene.frame()?;
    scene.remove(ids[0])?;
    let other = Arc::clone(&scene);
    std::thread::spawn(move || other.remove(ids[1])).join().expect("a thread")?;
    assert_eq!(drops.load(Ordering::Relaxed), 0);
    frame.update()?;
    assert_eq!(drops.load(Ordering::Relaxed), 1);
    Ok(())
}

#[test]
fn dropped_at_once_where_nothing_is_needed() -> Result<()> {
    let drops = Arc::new(AtomicU32::new(0));
    let Model { corners, .. } = &Model::new(0.0, true, &drops);
    let vertices: Vec<[f64; 3]> = corners.iter().map(|corner| corner.at).collect();
    let data = Arc::new(vertices.clone());
    let mesh = Shape::mesh_of(Arc::clone(&data))?;
    assert_eq!(Arc::strong_count(&data), 1);
    demand_same(&mesh, &Shape::triangles(&vertices)?)
}

/// Data of one vertex for all; or none, but a panic, now or when it is dropped.
struct Odd {
    panics: bool,
    panics_later: bool,
    vertices: Vec<[f64; 3]>,
    _held: Arc<()>,
}

impl MeshData for Odd {
    fn vertices(&self) -> Vectors<'_> {
        assert!(!self.panics, "told to");
        if self.vertices.is_empty() { [0.1; 3].into() } else { (&self.vertices).into() }
    }
}

impl Drop for Odd {
    fn drop(&mut self) {
        assert!(!self.panics_later, "told to");
    }
}

#[test]
fn dropped_once_if_there_is_no_mesh() {
    let drops = Arc::new(AtomicU32::new(0));
    let mut wrong = Model::new(0.0, false, &drops);
    wrong.faces[7][1] = 3 * TRIANGLES as u16;
    assert_eq!(Shape::mesh_of(wrong).expect_err("an index").kind(), ErrorKind::InvalidValue);
    assert_eq!(drops.load(Ordering::Relaxed), 1);
    let held = Arc::new(());
    let odd = |panics| Odd { panics, panics_later: false, vertices: Vec::new(), _held: Arc::clone(&held) };
    assert_eq!(Shape::mesh_of(odd(false)).expect_err("one for all").kind(), ErrorKind::InvalidArgument);
    assert!(std::panic::catch_unwind(|| Shape::mesh_of(odd(true))).is_err());
    assert_eq!(Arc::strong_count(&held), 1);
}

#[test]
fn a_panic_of_a_drop_goes_no_further() -> Result<()> {
    let held = Arc::new(());
    let there: Weak<()> = Arc::downgrade(&held);
    let vertices = vec![[0.1; 3], [0.9, 0.0, 0.0], [0.0, 0.9, 0.0]];
    let mesh = Shape::mesh_of(Odd { panics: false, panics_later: true, vertices, _held: held })?;
    drop(mesh);
    assert!(there.upgrade().is_none());
    Ok(())
}
