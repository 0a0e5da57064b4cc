// SPDX-License-Identifier: MIT
//! Random scenes and random changes: after each, every query agrees with brute force.

mod brute;

use std::collections::BTreeMap;

use brute::Plain;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use raygrid::views::{Floats, Poses, Vectors};
use raygrid::{ErrorKind, GridConfig, GridId, GridKind, Hit, ObjectId, Pose, Ray, Scene, Shape};

/// A change of a scene. Numbers of objects are taken modulo how many there are.
#[derive(Clone, Debug)]
enum Change {
    Insert(Plain, Vec<Pose>),
    Move(Vec<(usize, Pose)>),
    MoveTo(usize, [f64; 3]),
    Rescale(Vec<(usize, [f64; 3], f64)>),
    Remove(Vec<usize>),
    UseWhatIsGone,
    Rebuild,
}

fn vector(size: f64) -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-size..size)
}

fn place() -> impl Strategy<Value = [f64; 3]> {
    prop_oneof![vector(0.1), vector(3.0), vector(30.0), vector(1e4)]
}

/// A turned, stretched and perhaps mirrored frame, well conditioned: a rotation by a quaternion, its columns scaled.
fn linear() -> impl Strategy<Value = [[f32; 3]; 3]> {
    let stretch = prop::array::uniform3(prop_oneof![0.5..2.0, -2.0..-0.5]);
    let turned = (prop::array::uniform4(-1.0..1.0_f64), stretch).prop_filter_map("a quaternion of 0", |(q, s)| {
        let norm = q.iter().map(|x| x * x).sum::<f64>();
        let [w, x, y, z] = q.map(|part| part / norm.sqrt());
        let rows = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ];
        (norm > 0.01).then(|| rows.map(|row| [0, 1, 2].map(|axis| (row[axis] * s[axis]) as f32)))
    });
    prop_oneof![Just(Pose::default().linear), turned]
}

fn pose() -> impl Strategy<Value = Pose> {
    (place(), linear(), 0.2..3.0).prop_map(|(place, linear, scale)| Pose::at(place).linear(linear).scale(scale))
}

fn plain() -> impl Strategy<Value = Plain> {
    let corners = (vector(1.5), prop::array::uniform3(0.2..2.0));
    let boxes = corners.prop_map(|(lo, size)| Plain::Box(lo, [0, 1, 2].map(|axis| lo[axis] + size[axis])));
    // Corners are floats, as the mesh will have them.
    let corner = || vector(1.5).prop_map(|corner| corner.map(|x| f64::from(x as f32)));
    let triangles = prop::collection::vec([corner(), corner(), corner()], 1..5).prop_map(Plain::Triangles);
    prop_oneof![Just(Plain::Sphere), boxes, triangles]
}

fn change() -> impl Strategy<Value = Change> {
    let some = |most| prop::collection::vec(any::<usize>(), 1..most);
    prop_oneof![
        3 => (plain(), prop::collection::vec(pose(), 1..12)).prop_map(|(plain, poses)| Change::Insert(plain, poses)),
        2 => prop::collection::vec((any::<usize>(), pose()), 1..12).prop_map(Change::Move),
        1 => (any::<usize>(), place()).prop_map(|(one, place)| Change::MoveTo(one, place)),
        1 => prop::collection::vec((any::<usize>(), place(), 0.2..3.0), 1..12).prop_map(Change::Rescale),
        1 => some(6).prop_map(Change::Remove),
        1 => Just(Change::UseWhatIsGone),
        1 => Just(Change::Rebuild),
    ]
}

/// Rays, the first ones aimed at objects.
fn rays() -> impl Strategy<Value = Vec<(Ray, usize)>> {
    let origin = prop_oneof![vector(0.3), vector(10.0), vector(2e3)];
    let one = (origin, vector(1.0), any::<usize>());
    prop::collection::vec(one.prop_map(|(origin, to, at)| (Ray::new(origin, to), at)), 48)
}

/// A scene, and what is in it, changed together.
struct Twin {
    scene: Scene,
    objects: BTreeMap<ObjectId, (Plain, Pose)>,
    gone: Vec<ObjectId>,
}

fn shape_of(plain: &Plain) -> raygrid::Result<Shape> {
    match plain {
        Plain::Sphere => Shape::sphere(1.0),
        Plain::Box(lo, hi) => Shape::box_between(*lo, *hi),
        Plain::Triangles(triangles) => {
            let corners: Vec<[f32; 3]> = triangles.as_flattened().iter().map(|c| c.map(|x| x as f32)).collect();
            Shape::triangles(&corners)
        }
    }
}

impl Twin {
    fn nth(&self, number: usize) -> ObjectId {
        *self.objects.keys().nth(number % self.objects.len()).expect("it is one of them")
    }

    fn make(&mut self, change: &Change) -> raygrid::Result<()> {
        match change {
            Change::Insert(plain, poses) => {
                let ids = self.scene.insert_many(&shape_of(plain)?, poses)?;
                for (id, pose) in ids.into_iter().zip(poses) {
                    assert!(!self.gone.contains(&id), "{id:?} was given out again");
                    assert!(self.objects.insert(id, (plain.clone(), *pose)).is_none(), "{id:?} was given out twice");
                }
            }
            Change::Rebuild => self.scene.rebuild_grid(GridId::OF_SCENE)?,
            Change::UseWhatIsGone => {
                let Some(last) = self.gone.last() else { return Ok(()) };
                let ids: Vec<ObjectId> = self.objects.keys().chain([last]).copied().collect();
                let refused = [self.scene.remove_many(&ids), self.scene.move_many(&ids, [1.0, 2.0, 3.0])];
                assert!(refused.iter().all(|one| matches!(one, Err(e) if e.kind() == ErrorKind::InvalidId)));
            }
            _ if self.objects.is_empty() => {}
            Change::Move(moves) => {
                let ids: Vec<ObjectId> = moves.iter().map(|(one, _)| self.nth(*one)).collect();
                let poses: Vec<Pose> = moves.iter().map(|(_, pose)| *pose).collect();
                self.scene.move_many(&ids, &poses)?;
                ids.into_iter().zip(poses).for_each(|(id, pose)| self.pose_of(id, |old| *old = pose));
            }
            Change::MoveTo(one, place) => {
                let id = self.nth(*one);
                self.scene.move_to(id, *place)?;
                self.pose_of(id, |pose| pose.position = *place);
            }
            Change::Rescale(moves) => {
                let ids: Vec<ObjectId> = moves.iter().map(|(one, ..)| self.nth(*one)).collect();
                let places: Vec<[f64; 3]> = moves.iter().map(|(_, place, _)| *place).collect();
                let scales: Vec<f64> = moves.iter().map(|(.., scale)| *scale).collect();
                // The last first: so the first pose of one that is named twice is what stays.
                let poses = Poses::at(Vectors::from(&places).rev()).scale(Floats::from(&scales).rev());
                self.scene.move_many(raygrid::views::Ids::from(&ids).rev(), poses)?;
                for (id, (_, place, scale)) in ids.into_iter().zip(moves).rev() {
                    self.pose_of(id, |pose| (pose.position, pose.scale) = (*place, *scale));
                }
            }
            Change::Remove(which) => {
                let mut ids: Vec<ObjectId> = which.iter().map(|one| self.nth(*one)).collect();
                ids.sort_unstable();
                ids.dedup();
                self.scene.remove_many(&ids)?;
                ids.iter().for_each(|id| drop(self.objects.remove(id)));
                self.gone.extend(ids);
            }
        }
        Ok(())
    }

    fn pose_of(&mut self, id: ObjectId, change: impl FnOnce(&mut Pose)) {
        change(&mut self.objects.get_mut(&id).expect("it is there").1);
    }

    /// Compares all queries with brute force; returns how many rays were sure.
    fn agrees(&self, rays: &[(Ray, usize)]) -> Result<usize, TestCaseError> {
        let mut all: Vec<Ray> = rays.iter().map(|(ray, _)| *ray).collect();
        if !self.objects.is_empty() {
            for (ray, (_, at)) in all.iter_mut().zip(rays).take(rays.len() / 2) {
                let (way, aim) = (ray.direction, self.objects[&self.nth(*at)].1.position);
                ray.direction = [0, 1, 2].map(|axis| aim[axis] + way[axis] / 2.0 - ray.origin[axis]);
            }
        }
        let (mut hits, mut occluded) = (vec![Hit::MISS; all.len()], vec![false; all.len()]);
        self.scene.trace_many(&all, &mut hits)?;
        self.scene.occluded_many(&all, &mut occluded)?;
        let mut judged = 0;
        for ((ray, hit), occluded) in all.iter().zip(&hits).zip(occluded) {
            prop_assert_eq!(occluded, hit.is_hit());
            let (mut best, mut owner, mut sure) = (f64::INFINITY, None, true);
            for (id, (plain, pose)) in &self.objects {
                let found = brute::hit(plain, pose, ray);
                sure &= found.sure || found.t > best;
                if found.t < best {
                    (best, owner) = (found.t, Some(*id));
                }
            }
            if sure {
                prop_assert_eq!(hit.object, owner, "{:?}: t {} and by brute force {}", ray, hit.t, best);
                let near = hit.t == best || (hit.t - best).abs() <= 1e-6 * best + 1e-7;
                prop_assert!(near, "{:?}: t {} and by brute force {}", ray, hit.t, best);
                judged += 1;
            }
        }
        Ok(judged)
    }
}

fn play(kind: GridKind, workers: u32, steps: &[(Change, Vec<(Ray, usize)>)]) -> TestCaseResult {
    let scene = Scene::builder().workers(workers).grid(GridConfig::new(kind)).build()?;
    let mut twin = Twin { scene, objects: BTreeMap::new(), gone: Vec::new() };
    let (mut judged, mut asked) = (0, 0);
    for (change, rays) in steps {
        twin.make(change)?;
        prop_assert_eq!(twin.scene.stats()?.objects, twin.objects.len() as u64);
        judged += twin.agrees(rays)?;
        asked += rays.len();
    }
    prop_assert!(2 * judged > asked, "brute force judges only {} of {} rays", judged, asked);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_query_agrees_with_brute_force(
        kind in prop::sample::select(GridKind::ALL),
        workers in 1..3_u32,
        steps in prop::collection::vec((change(), rays()), 1..20),
    ) {
        play(kind, workers, &steps)?;
    }
}
