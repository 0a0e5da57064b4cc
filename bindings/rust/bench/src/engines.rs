// SPDX-License-Identifier: MIT
//! What is measured: raygrid and its peers, each used as its documentation advises, on one thread.

use raygrid::{Hit, ObjectId, Ray, Scene, Shape};

use crate::world::{World, sphere_hit};

/// What a ray found: t, infinity for none, and the number of the sphere.
pub type Found = (f64, usize);
const NOTHING: Found = (f64::INFINITY, usize::MAX);

pub trait Engine {
    fn name(&self) -> &'static str;
    /// Some have moved; the next trace must see it.
    fn move_some(&mut self, world: &World, moved: &[usize]);
    /// All have moved, perhaps.
    fn move_all(&mut self, world: &World) {
        let all: Vec<usize> = (0..world.centres.len()).collect();
        self.move_some(world, &all);
    }
    fn trace(&self, world: &World, ray: &Ray) -> Found;
    /// Many rays: one by one, unless there is a call for many.
    fn trace_many(&mut self, world: &World, rays: &[Ray], found: &mut [Found]) {
        for (ray, found) in rays.iter().zip(found) {
            *found = self.trace(world, ray);
        }
    }
    fn has_batches(&self) -> bool {
        false
    }
}

/// All of them, with the spheres of a world.
pub fn all(world: &World) -> Vec<Box<dyn Engine>> {
    vec![
        Box::new(Raygrid::new(world)),
        Box::new(OfBvh::new(world)),
        Box::new(OfParry::new(world)),
        Box::new(OfRapier::new(world)),
        Box::new(OfObvhs::new(world)),
    ]
}

// ------------------------------------------------------------------------------------------------- raygrid

struct Raygrid {
    scene: Scene,
    ids: Vec<ObjectId>,
    hits: Vec<Hit>,
}

impl Raygrid {
    fn new(world: &World) -> Self {
        let scene = Scene::builder().workers(1).build().expect("a scene");
        let ball = Shape::sphere(world.radius.into()).expect("a sphere");
        let ids = scene.insert_many(&ball, &world.centres).expect("objects");
        Self { scene, ids, hits: Vec::new() }
    }

    fn found(&self, hit: &Hit) -> Found {
        hit.object.map_or(NOTHING, |id| (hit.t, id.slot() as usize))
    }
}

impl Engine for Raygrid {
    fn name(&self) -> &'static str {
        "raygrid"
    }

    fn move_some(&mut self, world: &World, moved: &[usize]) {
        let ids: Vec<ObjectId> = moved.iter().map(|&one| self.ids[one]).collect();
        let places: Vec<[f32; 3]> = moved.iter().map(|&one| world.centres[one]).collect();
        self.scene.move_many(&ids, &places).expect("all are there");
    }

    fn move_all(&mut self, world: &World) {
        self.scene.move_many(&self.ids, &world.centres).expect("all are there");
    }

    fn trace(&self, _: &World, ray: &Ray) -> Found {
        self.scene.trace(ray).expect("a valid ray").map_or(NOTHING, |hit| self.found(&hit))
    }

    fn trace_many(&mut self, _: &World, rays: &[Ray], found: &mut [Found]) {
        let mut hits = std::mem::take(&mut self.hits);
        hits.resize(rays.len(), Hit::MISS);
        self.scene.trace_many(rays, &mut hits).expect("valid rays");
        for (hit, found) in hits.iter().zip(found) {
            *found = self.found(hit);
        }
        self.hits = hits;
    }

    fn has_batches(&self) -> bool {
        true
    }
}

fn floats(all: [f64; 3]) -> [f32; 3] {
    all.map(|x| x as f32)
}

// ----------------------------------------------------------------------------------------------------- bvh

struct Ball {
    centre: nalgebra::Point3<f32>,
    radius: f32,
    node: usize,
}

impl bvh::aabb::Bounded<f32, 3> for Ball {
    fn aabb(&self) -> bvh::aabb::Aabb<f32, 3> {
        let half = nalgebra::Vector3::repeat(self.radius);
        bvh::aabb::Aabb::with_bounds(self.centre - half, self.centre + half)
    }
}

impl bvh::bounding_hierarchy::BHShape<f32, 3> for Ball {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// 1 % by `update_shapes`, all by a build: each is the cheaper way for that.
struct OfBvh {
    balls: Vec<Ball>,
    tree: bvh::bvh::Bvh<f32, 3>,
}

impl OfBvh {
    fn new(world: &World) -> Self {
        let ball = |&centre: &[f32; 3]| Ball { centre: centre.into(), radius: world.radius, node: 0 };
        let mut balls: Vec<Ball> = world.centres.iter().map(ball).collect();
        let tree = bvh::bvh::Bvh::build(&mut balls);
        Self { balls, tree }
    }
}

impl Engine for OfBvh {
    fn name(&self) -> &'static str {
        "bvh"
    }

    fn move_some(&mut self, world: &World, moved: &[usize]) {
        for &one in moved {
            self.balls[one].centre = world.centres[one].into();
        }
        self.tree.update_shapes(moved, &mut self.balls);
    }

    fn move_all(&mut self, world: &World) {
        for (ball, &centre) in self.balls.iter_mut().zip(&world.centres) {
            ball.centre = centre.into();
        }
        self.tree = bvh::bvh::Bvh::build(&mut self.balls);
    }

    fn trace(&self, world: &World, ray: &Ray) -> Found {
        let (origin, direction) = (floats(ray.origin), floats(ray.direction));
        let asked = bvh::ray::Ray::new(origin.into(), direction.into());
        let mut best = NOTHING;
        // Boxes come nearly by distance, not quite; so all are looked at that begin before the best hit.
        for ball in self.tree.nearest_traverse_iterator(&asked, &self.balls) {
            let centre = ball.centre.into();
            let to: [f32; 3] = std::array::from_fn(|axis| ball.centre[axis] - origin[axis]);
            let nearest = to.iter().zip(direction).map(|(a, b)| a * b).sum::<f32>() - 4.0 * world.radius;
            if f64::from(nearest) > best.0 {
                break;
            }
            let t = f64::from(sphere_hit(origin, direction, centre, world.radius));
            if t < best.0 {
                let first = std::ptr::from_ref(&self.balls[0]).addr();
                best = (t, (std::ptr::from_ref(ball).addr() - first) / size_of::<Ball>());
            }
        }
        best
    }
}

// ------------------------------------------------------------------------------------------------- parry3d

use parry3d::bounding_volume::Aabb;
use parry3d::math::Vector;
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};

fn vector([x, y, z]: [f32; 3]) -> Vector {
    Vector::new(x, y, z)
}

fn parry_box(world: &World, one: usize) -> Aabb {
    let (centre, half) = (vector(world.centres[one]), Vector::splat(world.radius));
    Aabb::new(centre - half, centre + half)
}

/// Leaves are changed in place, then the tree is refitted and optimised a little.
struct OfParry {
    tree: Bvh,
    workspace: BvhWorkspace,
}

impl OfParry {
    fn new(world: &World) -> Self {
        let boxes: Vec<Aabb> = (0..world.centres.len()).map(|one| parry_box(world, one)).collect();
        Self { tree: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes), workspace: BvhWorkspace::default() }
    }
}

impl Engine for OfParry {
    fn name(&self) -> &'static str {
        "parry3d"
    }

    fn move_some(&mut self, world: &World, moved: &[usize]) {
        for &one in moved {
            self.tree.insert_or_update_partially(parry_box(world, one), one as u32, 0.0);
        }
        self.tree.refit(&mut self.workspace);
        self.tree.optimize_incremental(&mut self.workspace);
    }

    fn trace(&self, world: &World, ray: &Ray) -> Found {
        let (origin, direction) = (floats(ray.origin), floats(ray.direction));
        let asked = parry3d::query::Ray::new(vector(origin), vector(direction));
        let hit = self.tree.cast_ray(&asked, f32::MAX, |one, _| {
            let t = sphere_hit(origin, direction, world.centres[one as usize], world.radius);
            t.is_finite().then_some(t)
        });
        hit.map_or(NOTHING, |(one, t)| (t.into(), one as usize))
    }
}

// ------------------------------------------------------------------------------------------------ rapier3d

use rapier3d::prelude::{
    BroadPhaseBvh, ColliderBuilder, ColliderHandle, ColliderSet, IntegrationParameters, QueryFilter, RigidBodySet,
};

/// Colliders without bodies, and the broad phase alone: no physics.
struct OfRapier {
    colliders: ColliderSet,
    bodies: RigidBodySet,
    handles: Vec<ColliderHandle>,
    broad: BroadPhaseBvh,
    parameters: IntegrationParameters,
}

impl OfRapier {
    fn new(world: &World) -> Self {
        let mut colliders = ColliderSet::new();
        let ball = |&centre: &[f32; 3]| {
            colliders.insert(ColliderBuilder::ball(world.radius).sensor(true).translation(vector(centre)))
        };
        let handles: Vec<ColliderHandle> = world.centres.iter().map(ball).collect();
        let parameters = IntegrationParameters { length_unit: world.radius, ..Default::default() };
        let broad = BroadPhaseBvh::new();
        let mut made = Self { colliders, bodies: RigidBodySet::new(), handles, broad, parameters };
        let all = made.handles.clone();
        made.update(&all);
        made
    }

    fn update(&mut self, changed: &[ColliderHandle]) {
        let mut pairs = Vec::new();
        self.broad.update(&self.parameters, &self.colliders, &self.bodies, changed, &[], &mut pairs);
    }
}

impl Engine for OfRapier {
    fn name(&self) -> &'static str {
        "rapier3d"
    }

    fn move_some(&mut self, world: &World, moved: &[usize]) {
        let changed: Vec<ColliderHandle> = moved.iter().map(|&one| self.handles[one]).collect();
        for (&one, &handle) in moved.iter().zip(&changed) {
            self.colliders[handle].set_translation(vector(world.centres[one]));
        }
        self.update(&changed);
    }

    fn trace(&self, _: &World, ray: &Ray) -> Found {
        let dispatcher = rapier3d::parry::query::DefaultQueryDispatcher;
        let query = self.broad.as_query_pipeline(&dispatcher, &self.bodies, &self.colliders, QueryFilter::default());
        let asked = rapier3d::prelude::Ray::new(vector(floats(ray.origin)), vector(floats(ray.direction)));
        // Not solid: a ray from inside hits the far side, as with the others.
        query
            .cast_ray(&asked, f32::MAX, false)
            .map_or(NOTHING, |(handle, t)| (t.into(), handle.into_raw_parts().0 as usize))
    }
}

// --------------------------------------------------------------------------------------------------- obvhs

use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::ray::RayHit;

fn obvhs_box(world: &World, one: usize) -> obvhs::aabb::Aabb {
    let (centre, half) = (glam::Vec3A::from_array(world.centres[one]), glam::Vec3A::splat(world.radius));
    obvhs::aabb::Aabb::new(centre - half, centre + half)
}

/// 1 % by moving leaves, all by a build.
struct OfObvhs {
    tree: Bvh2,
}

impl OfObvhs {
    fn build(world: &World) -> Bvh2 {
        let boxes: Vec<obvhs::aabb::Aabb> = (0..world.centres.len()).map(|one| obvhs_box(world, one)).collect();
        let one_each = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::fast_build() };
        let mut timed = std::time::Duration::ZERO;
        obvhs::bvh2::builder::build_bvh2(&boxes, one_each, &mut timed)
    }

    fn new(world: &World) -> Self {
        Self { tree: Self::build(world) }
    }
}

impl Engine for OfObvhs {
    fn name(&self) -> &'static str {
        "obvhs"
    }

    fn move_some(&mut self, world: &World, moved: &[usize]) {
        for &one in moved {
            self.tree.move_primitive(obvhs_box(world, one), one as u32);
        }
    }

    fn move_all(&mut self, world: &World) {
        self.tree = Self::build(world);
    }

    fn trace(&self, world: &World, ray: &Ray) -> Found {
        let (origin, direction) = (floats(ray.origin), floats(ray.direction));
        let asked = obvhs::ray::Ray::new_inf(origin.into(), direction.into());
        let mut hit = RayHit::none();
        self.tree.ray_traverse(asked, &mut hit, |_, at| {
            let one = self.tree.primitive_indices[at] as usize;
            sphere_hit(origin, direction, world.centres[one], world.radius)
        });
        if hit.t.is_finite() && hit.primitive_id != u32::MAX {
            (hit.t.into(), self.tree.primitive_indices[hit.primitive_id as usize] as usize)
        } else {
            NOTHING
        }
    }
}
