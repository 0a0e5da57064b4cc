// SPDX-License-Identifier: MIT
//! Trace steps: their rays, all the ways to trace them from Rust, and that these give the same bits.

use raygrid::views::{Floats, FloatsMut, HitViews, IdsMut, Masks, PrimitivesMut, RayViews, Vectors, VectorsMut};
use raygrid::{Cull, ErrorKind, GridId, Hit, Query, Ray};
use serde_json::Value;

use crate::compare;
use crate::script::{
    Fail, Outcome, Play, Step, ensure, field, known, list, malformed, mask, number, numbers, record,
};

/// A batch of so many rays is large enough to be spread over workers.
const MANY_RAYS: usize = 4096;

/// The rays of a trace step.
pub struct Batch {
    /// What the script says of each ray.
    pub lines: Vec<Step>,
    pub rays: Vec<Ray>,
    cull: Cull,
    respawn: Vec<[f64; 3]>,
    /// How many are expected to be invalid.
    invalid: u64,
    pub first: Answer,
}

/// What a trace gave, the work that it took included.
#[derive(Clone, Default)]
pub struct Answer {
    pub hits: Vec<Hit>,
    pub cells: Vec<u32>,
    pub tests: Vec<u32>,
}

/// Hits in which what is not written does not look like a hit.
fn garbage(count: usize) -> Vec<Hit> {
    vec![bytemuck::pod_read_unaligned(&[0xa5; size_of::<Hit>()]); count]
}

/// Whether two hits are the same, bit for bit, or both those of invalid rays.
fn is_same(a: &Hit, b: &Hit) -> bool {
    let bits = |hit: &Hit| {
        let t = if hit.t.is_nan() { f64::NAN } else { hit.t };
        let numbers = [t, hit.position[0], hit.position[1], hit.position[2]].map(f64::to_bits);
        let [x, y, z] = hit.normal;
        (numbers, hit.object, [x, y, z, hit.offset, hit.u, hit.v].map(f32::to_bits), hit.primitive)
    };
    bits(a) == bits(b)
}

fn same(way: &str, wanted: &[Hit], got: &[Hit]) -> Outcome {
    ensure!(wanted.len() == got.len(), "{way}: {} hits", got.len());
    for (i, (wanted, got)) in wanted.iter().zip(got).enumerate() {
        ensure!(is_same(wanted, got), "{way}: ray {i}: {got:?}, by the first way {wanted:?}");
    }
    Ok(())
}

impl Batch {
    pub fn new(step: &Step) -> Outcome<Self> {
        let lines =
            list(field(step, "rays")?)?.iter().map(|ray| record(ray).cloned()).collect::<Outcome<Vec<_>>>()?;
        let cull = match step.get("cull") {
            None => Cull::None,
            Some(Value::String(name)) => {
                match Cull::ALL.iter().find(|cull| format!("{cull:?}").to_lowercase() == *name) {
                    Some(cull) => *cull,
                    None => malformed!("unknown cull {name}"),
                }
            }
            Some(value) => match value.as_i64().map(i32::try_from) {
                Some(Ok(number)) => Cull::try_from(number)?,
                _ => malformed!("{value} is no cull"),
            },
        };
        let mut rays = Vec::new();
        for line in &lines {
            known(line, "origin direction t_min t_max mask hit")?;
            let ray = Ray::new(numbers(field(line, "origin")?)?, numbers(field(line, "direction")?)?)
                .from(line.get("t_min").map_or(Ok(0.0), number)?)
                .until(line.get("t_max").map_or(Ok(f64::INFINITY), number)?)
                .mask(line.get("mask").map_or(Ok(u32::MAX), mask)?);
            rays.push(ray);
        }
        let respawn = step.get("respawn").map_or(Ok(Vec::new()), crate::script::vectors)?;
        let invalid = lines.iter().filter(|line| line.get("hit").is_some_and(|hit| hit == "invalid")).count() as u64;
        Ok(Self { lines, rays, cull, respawn, invalid, first: Answer::default() })
    }

    fn query<'a>(&self, play: &'a Play) -> Query<'a> {
        play.scene.query().cull(self.cull)
    }

    /// By separate arrays, with everything that can be asked for.
    pub fn trace_once(&self, play: &Play) -> Outcome<Answer> {
        let origins: Vec<[f64; 3]> = self.rays.iter().map(|ray| ray.origin).collect();
        let directions: Vec<[f64; 3]> = self.rays.iter().map(|ray| ray.direction).collect();
        let t_min: Vec<f64> = self.rays.iter().map(|ray| ray.t_min).collect();
        let t_max: Vec<f64> = self.rays.iter().map(|ray| ray.t_max).collect();
        let masks: Vec<u32> = self.rays.iter().map(|ray| ray.mask).collect();
        let rays = RayViews::new(&origins, &directions).t_min(&t_min).t_max(&t_max).mask(&masks);
        let count = self.rays.len();
        let (mut cells, mut tests) = (vec![0xa5a5_a5a5_u32; count], vec![0xa5a5_a5a5_u32; count]);
        let (mut t, mut object) = (vec![0.0_f64; count], vec![None; count]);
        let (mut primitive, mut normal) = (vec![0_u32; count], vec![[0.0_f32; 3]; count]);
        let (mut u, mut v) = (vec![0.0_f32; count], vec![0.0_f32; count]);
        let (mut position, mut offset) = (vec![[0.0_f64; 3]; count], vec![0.0_f32; count]);
        let views = HitViews::new().t(&mut t).object(&mut object).primitive(&mut primitive).normal(&mut normal);
        let views = views.u(&mut u).v(&mut v).position(&mut position).offset(&mut offset);
        let traced = self.query(play).trace_views(rays, views.cells(&mut cells).tests(&mut tests))?;
        ensure!(traced.invalid == self.invalid, "{} rays are invalid, expected {}", traced.invalid, self.invalid);
        let mut hits = vec![Hit::MISS; count];
        for (i, hit) in hits.iter_mut().enumerate() {
            (hit.t, hit.object, hit.primitive, hit.normal) = (t[i], object[i], primitive[i], normal[i]);
            (hit.u, hit.v, hit.position, hit.offset) = (u[i], v[i], position[i], offset[i]);
        }
        Ok(Answer { hits, cells, tests })
    }

    /// Traces the rays again: everything must be as it was.
    pub fn trace_again(&self, play: &Play) -> Outcome {
        let again = self.trace_once(play)?;
        same("again after the error", &self.first.hits, &again.hits)?;
        ensure!(self.first.cells == again.cells && self.first.tests == again.tests, "other cells or tests");
        Ok(())
    }

    /// Traces by a way and compares.
    fn by(&self, play: &Play, way: &str, trace: impl FnOnce(&mut [Hit]) -> Outcome) -> Outcome {
        let mut hits = garbage(self.rays.len());
        let before = play.scene.stats()?.invalid_rays;
        trace(&mut hits)?;
        same(way, &self.first.hits, &hits)?;
        let invalid = play.scene.stats()?.invalid_rays - before;
        ensure!(invalid == self.invalid, "{way}: {invalid} invalid rays, expected {}", self.invalid);
        Ok(())
    }

    fn ways(&self, play: &Play) -> Outcome {
        let (rays, query) = (&self.rays[..], self.query(play));
        self.by(play, "one by one", |hits| {
            for (ray, hit) in rays.iter().zip(hits) {
                query.trace_many(std::slice::from_ref(ray), std::slice::from_mut(hit))?;
            }
            Ok(())
        })?;
        self.by(play, "records", |hits| Ok(query.trace_many(rays, hits).map(drop)?))?;
        if self.cull == Cull::None {
            self.by(play, "plain", |hits| Ok(play.scene.trace_many(rays, hits)?))?;
            self.by(play, "plain, one by one", |hits| one_by_one(play, rays, hits))?;
        }
        self.by(play, "backward", |hits| {
            let (t, object, position) = fields_backward(play, self.cull, rays)?;
            hits.copy_from_slice(&self.first.hits);
            for (i, hit) in hits.iter_mut().enumerate() {
                (hit.t, hit.object, hit.position) = (t[i], object[i], position[i]);
            }
            Ok(())
        })?;
        self.by(play, "components", |hits| self.by_components(query, hits))?;
        if !play.costly {
            let accept = |index: usize, hit: &Hit| {
                let ray = &rays[index];
                assert!(ray.t_min <= hit.t && hit.t <= ray.t_max && hit.object.is_some(), "a candidate is {hit:?}");
                true
            };
            self.by(play, "filtered", |hits| Ok(query.filter(&accept).trace_many(rays, hits).map(drop)?))?;
        }
        Ok(())
    }

    /// Each component in an array of its own.
    fn by_components(&self, query: Query<'_>, hits: &mut [Hit]) -> Outcome {
        let columns = |of: fn(&Ray) -> [f64; 3]| {
            [0, 1, 2].map(|axis| self.rays.iter().map(|ray| of(ray)[axis]).collect::<Vec<f64>>())
        };
        let ([ox, oy, oz], [dx, dy, dz]) = (columns(|ray| ray.origin), columns(|ray| ray.direction));
        let (origin, direction) = (Vectors::components(&ox, &oy, &oz), Vectors::components(&dx, &dy, &dz));
        let rays = RayViews::new(origin, direction)
            .t_min(Floats::field(&self.rays, |ray| &ray.t_min))
            .t_max(Floats::field(&self.rays, |ray| &ray.t_max))
            .mask(Masks::field(&self.rays, |ray| &ray.mask));
        let count = self.rays.len();
        let [mut x, mut y, mut z] = [0, 1, 2].map(|_| vec![0.0_f32; count]);
        let normal = VectorsMut::components(&mut x, &mut y, &mut z);
        let mut primitive = vec![0_u64; count];
        query.trace_views(rays, HitViews::new().normal(normal).primitive(PrimitivesMut::from(&mut primitive)))?;
        hits.copy_from_slice(&self.first.hits);
        for (i, hit) in hits.iter_mut().enumerate() {
            (hit.normal, hit.primitive) = ([x[i], y[i], z[i]], primitive[i] as u32);
        }
        Ok(())
    }

    /// Floats in and out, if all numbers of the rays are floats.
    fn floats(&self, play: &Play) -> Outcome {
        let narrow = |all: [f64; 3]| all.map(|x| x as f32);
        let mut exact = true;
        let mut check = |x: f64| exact &= x.is_nan() || f64::from(x as f32) == x;
        for ray in &self.rays {
            ray.origin.into_iter().chain(ray.direction).chain([ray.t_min, ray.t_max]).for_each(&mut check);
        }
        if !exact {
            return Ok(());
        }
        let origins: Vec<[f32; 3]> = self.rays.iter().map(|ray| narrow(ray.origin)).collect();
        let directions: Vec<[f32; 3]> = self.rays.iter().map(|ray| narrow(ray.direction)).collect();
        let t_min: Vec<f32> = self.rays.iter().map(|ray| ray.t_min as f32).collect();
        let t_max: Vec<f32> = self.rays.iter().map(|ray| ray.t_max as f32).collect();
        let rays = RayViews::new(&origins, &directions).t_min(&t_min).t_max(&t_max);
        let rays = rays.mask(Masks::field(&self.rays, |ray| &ray.mask));
        let (mut t, mut position) = (vec![0.0_f32; self.rays.len()], vec![[0.0_f32; 3]; self.rays.len()]);
        self.query(play).trace_views(rays, HitViews::new().t(&mut t).position(&mut position))?;
        for (i, hit) in self.first.hits.iter().enumerate() {
            let wanted = hit.t as f32;
            ensure!(t[i].to_bits() == wanted.to_bits() || (t[i].is_nan() && wanted.is_nan()), "floats: ray {i}: t");
            ensure!(position[i] == narrow(hit.position), "floats: ray {i}: position is {:?}", position[i]);
        }
        Ok(())
    }

    /// One origin, direction and mask for all rays, where they are all the same.
    fn shared(&self, play: &Play) -> Outcome {
        let Some(first) = self.rays.first() else { return Ok(()) };
        let is_one = |of: fn(&Ray) -> [u64; 3]| self.rays.iter().all(|ray| of(ray) == of(first));
        let origin = is_one(|ray| ray.origin.map(f64::to_bits));
        let direction = is_one(|ray| ray.direction.map(f64::to_bits));
        if !origin && !direction {
            return Ok(());
        }
        let origins = match origin {
            true => first.origin.into(),
            false => Vectors::field(&self.rays, |ray| &ray.origin),
        };
        let directions = match direction {
            true => first.direction.into(),
            false => Vectors::field(&self.rays, |ray| &ray.direction),
        };
        let rays = RayViews::new(origins, directions)
            .t_min(Floats::field(&self.rays, |ray| &ray.t_min))
            .t_max(Floats::field(&self.rays, |ray| &ray.t_max))
            .mask(Masks::field(&self.rays, |ray| &ray.mask));
        let mut hits = self.first.hits.clone();
        let mut t = vec![0.0_f64; self.rays.len()];
        self.query(play).trace_views(rays, HitViews::new().t(&mut t))?;
        hits.iter_mut().zip(t).for_each(|(hit, t)| hit.t = t);
        same("shared", &self.first.hits, &hits)
    }

    fn occluded(&self, play: &Play) -> Outcome {
        let wanted: Vec<bool> = self.first.hits.iter().map(Hit::is_hit).collect();
        let query = self.query(play);
        let mut got = vec![false; self.rays.len()];
        query.occluded_views(&self.rays[..], &mut got)?;
        ensure!(got == wanted, "occluded: {got:?}, expected {wanted:?}");
        let mut bytes = vec![0x5a_u8; self.rays.len()];
        query.occluded_views(RayViews::from(&self.rays[..]).rev(), &mut bytes)?;
        bytes.reverse();
        ensure!(bytes.iter().zip(&wanted).all(|(got, wanted)| *got == u8::from(*wanted)), "occluded, backward");
        if !play.costly {
            query.filter(&|_: usize, _: &Hit| true).occluded_views(&self.rays[..], &mut got)?;
            ensure!(got == wanted, "occluded, filtered: {got:?}, expected {wanted:?}");
        }
        if self.cull == Cull::None {
            play.scene.occluded_many(&self.rays, &mut got)?;
            ensure!(got == wanted, "occluded, plain: {got:?}, expected {wanted:?}");
            for (ray, wanted) in self.rays.iter().zip(wanted) {
                ensure!(play.scene.occluded(ray)? == wanted, "occluded, one by one: {ray:?}");
            }
        }
        Ok(())
    }

    /// The batch again and again in one call: copies far apart are traced by different workers.
    fn many(&self, play: &Play) -> Outcome {
        let copies = MANY_RAYS / self.rays.len() + 1;
        let rays = self.rays.repeat(copies);
        let mut hits = garbage(rays.len());
        let traced = self.query(play).trace_many(&rays, &mut hits)?;
        ensure!(traced.invalid == self.invalid * copies as u64, "many: {} invalid rays", traced.invalid);
        hits.chunks(self.rays.len()).try_for_each(|copy| same("many", &self.first.hits, copy))
    }

    /// From each hit a ray in each direction of "respawn", moved by the offset, must not hit the same object.
    fn respawned(&self, play: &Play) -> Outcome {
        for (ray, hit) in self.rays.iter().zip(&self.first.hits).filter(|(_, hit)| hit.is_hit()) {
            let along = |way: [f64; 3]| (0..3).map(|axis| way[axis] * f64::from(hit.normal[axis])).sum::<f64>();
            for direction in &self.respawn {
                // To the side that the ray came from.
                let turn = if along(ray.direction) * along(*direction) > 0.0 { -1.0 } else { 1.0 };
                let direction = direction.map(|x| turn * x);
                let again = play.scene.trace(&Ray::new(hit.leave(direction), direction))?;
                let object = again.and_then(|hit| hit.object);
                ensure!(object != hit.object, "respawn {direction:?}: hits {} again", play.name_of(object));
            }
        }
        Ok(())
    }
}

/// The calls for one ray, which tell an invalid one by an error.
fn one_by_one(play: &Play, rays: &[Ray], hits: &mut [Hit]) -> Outcome {
    for (ray, hit) in rays.iter().zip(hits) {
        *hit = match play.scene.trace(ray) {
            Ok(found) => found.unwrap_or_default(),
            Err(error) if error.kind() == ErrorKind::InvalidValue => Hit { t: f64::NAN, ..Hit::MISS },
            Err(error) => return Err(Fail::Refused(error)),
        };
    }
    Ok(())
}

type Fields = (Vec<f64>, Vec<Option<raygrid::ObjectId>>, Vec<[f64; 3]>);

/// The rays from the last to the first, and their hits likewise; given back in the rays' order.
fn fields_backward(play: &Play, cull: Cull, rays: &[Ray]) -> Outcome<Fields> {
    let count = rays.len();
    let (mut t, mut object, mut position) = (vec![0.0; count], vec![None; count], vec![[0.0; 3]; count]);
    let views = HitViews::new()
        .t(FloatsMut::from(&mut t).rev())
        .object(IdsMut::from(&mut object).rev())
        .position(VectorsMut::from(&mut position).rev());
    play.scene.query().cull(cull).trace_views(RayViews::from(rays).rev(), views)?;
    Ok((t, object, position))
}

pub fn play_trace(play: &mut Play, step: &Step) -> Outcome {
    known(step, "do rays cull respawn")?;
    let mut batch = Batch::new(step)?;
    if play.setup.rebuilt {
        play.scene.rebuild_grid(GridId::OF_SCENE)?;
    }
    batch.first = batch.trace_once(play)?;
    compare::with_script(play, &batch)?;
    batch.ways(play)?;
    batch.floats(play)?;
    batch.shared(play)?;
    batch.occluded(play)?;
    if play.workers > 1 && !play.costly && !batch.rays.is_empty() {
        batch.many(play)?;
    }
    batch.respawned(play)?;
    play.last = Some(batch);
    Ok(())
}
