// SPDX-License-Identifier: MIT
//! How to trace, if not as by default.

use std::ffi::c_void;
use std::ptr;
use std::sync::{Mutex, PoisonError};

use raygrid_sys as sys;

use crate::error::check;
use crate::host::caught;
use crate::views::{Flags, HitViews, RayViews, agree};
use crate::{Coherence, Cull, Error, ErrorKind, Hit, Ray, Result, Scene, sized};

/// Decides on a possible hit of a ray, given by its number in the call: whether it counts.
type Filter<'a> = dyn Fn(usize, &Hit) -> bool + Sync + 'a;

/// What a trace of many rays tells beside their hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Traced {
    /// How many rays were invalid.
    pub invalid: u64,
}

/// How to trace a scene: culling, filters, fields by views. From [`Scene::query`].
///
/// ```
/// use raygrid::{Cull, Ray, Scene, Shape};
///
/// let scene = Scene::new()?;
/// let near = scene.insert(&Shape::sphere(1.0)?, [0.0, 0.0, 5.0])?;
/// let far = scene.insert(&Shape::sphere(1.0)?, [0.0, 0.0, 9.0])?;
/// let ray = Ray::new([0.0; 3], [0.0, 0.0, 1.0]);
///
/// let others = |_: usize, hit: &raygrid::Hit| hit.object != Some(near);
/// let hit = scene.query().filter(&others).trace(&ray)?.unwrap();
/// assert_eq!((hit.object, hit.t), (Some(far), 8.0));
///
/// let hit = scene.query().cull(Cull::Front).trace(&ray)?.unwrap(); // the back of the near one
/// assert_eq!((hit.object, hit.t), (Some(near), 6.0));
/// # Ok::<(), raygrid::Error>(())
/// ```
#[derive(Clone, Copy)]
pub struct Query<'a> {
    scene: &'a Scene,
    cull: Cull,
    coherence: Coherence,
    filter: Option<&'a Filter<'a>>,
}

/// A filter while a trace runs, and the first panic of it.
struct Filtering<'a> {
    filter: &'a Filter<'a>,
    panicked: Mutex<Option<String>>,
}

unsafe extern "C" fn filter(user: *mut c_void, index: u64, candidate: *const sys::rg_hit) -> i32 {
    // SAFETY: `user` is the `Filtering` of the running trace, the candidate a hit; `Hit` is laid out as `rg_hit`.
    let (filtering, candidate) = unsafe { (&*user.cast::<Filtering<'_>>(), &*candidate.cast::<Hit>()) };
    // The library has no larger indices than there are rays in a slice.
    match caught(|| (filtering.filter)(index as usize, candidate)) {
        Ok(counts) => i32::from(counts),
        Err(words) => {
            filtering.panicked.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(words);
            -1
        }
    }
}

impl<'a> Query<'a> {
    pub(crate) fn new(scene: &'a Scene) -> Self {
        Self { scene, cull: Cull::None, coherence: Coherence::Unknown, filter: None }
    }

    /// Which sides of surfaces count.
    #[must_use]
    pub fn cull(self, cull: Cull) -> Self {
        Self { cull, ..self }
    }

    /// Whether rays that follow one another go nearly the same way.
    #[must_use]
    pub fn coherence(self, coherence: Coherence) -> Self {
        Self { coherence, ..self }
    }

    /// Lets rays pass through hits that `filter` is false for. It is called with the number of the ray in the call and
    /// a candidate, whose `offset` is not known yet: in any order, not only for the closest ones, perhaps more than
    /// once for the same one, and from several threads at once. It may trace and read the scene, but not change it.
    /// If it panics, the call returns [`ErrorKind::CallbackFailed`] with what it said; t of that ray is NaN then, and all
    /// other rays are complete.
    #[must_use]
    pub fn filter(self, filter: &'a (impl Fn(usize, &Hit) -> bool + Sync)) -> Self {
        Self { filter: Some(filter), ..self }
    }

    /// Makes a call with this configuration.
    fn run(&self, call: impl FnOnce(&sys::rg_trace_config) -> sys::rg_result) -> Result<Traced> {
        let mut invalid = 0;
        let mut config = sized!(rg_trace_config {
            cull: self.cull as i32,
            coherence: self.coherence as i32,
            filter: None,
            filter_user: ptr::null_mut(),
            invalid: &mut invalid,
        });
        let Some(function) = self.filter else {
            check(call(&config))?;
            return Ok(Traced { invalid });
        };
        let filtering = Filtering { filter: function, panicked: Mutex::new(None) };
        config.filter = Some(filter);
        config.filter_user = ptr::from_ref(&filtering).cast_mut().cast();
        let result = check(call(&config));
        match filtering.panicked.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(words) => Err(Error::new(ErrorKind::CallbackFailed, format!("the filter panicked: {words}"))),
            None => result.map(|()| Traced { invalid }),
        }
    }

    /// The closest hit of a ray. Otherwise as [`Scene::trace`].
    pub fn trace(&self, ray: &Ray) -> Result<Option<Hit>> {
        let mut hit = [Hit::MISS];
        self.trace_many(std::slice::from_ref(ray), &mut hit)?;
        hit[0].known()
    }

    /// The closest hits of many rays: `hits[i]` is that of `rays[i]`.
    pub fn trace_many(&self, rays: &[Ray], hits: &mut [Hit]) -> Result<Traced> {
        let count = agree([("rays", Some(rays.len())), ("hits", Some(hits.len()))])?;
        let (rays, hits) = (RayViews::from(rays).raw(), all_fields(hits));
        self.run(|config| {
            // SAFETY: the views lead to `count` records each.
            unsafe { sys::rg_scene_trace_views(self.scene.raw(), config, &rays, &hits, count.unwrap_or(0) as u64) }
        })
    }

    /// The closest hits of many rays, field by field, where they lie and where they are wanted.
    pub fn trace_views<'v>(&self, rays: impl Into<RayViews<'v>>, hits: HitViews<'v>) -> Result<Traced> {
        let rays = rays.into();
        let count = agree(rays.counts().into_iter().chain(hits.counts()))?.unwrap_or(1);
        let (rays, hits) = (rays.raw(), hits.raw());
        self.run(|config| {
            // SAFETY: the views lead to `count` records each.
            unsafe { sys::rg_scene_trace_views(self.scene.raw(), config, &rays, &hits, count as u64) }
        })
    }

    /// Whether a ray hits anything. Otherwise as [`Scene::occluded`].
    pub fn occluded(&self, ray: &Ray) -> Result<bool> {
        let mut answer = [false];
        self.occluded_views(std::slice::from_ref(ray), &mut answer)?;
        Ok(answer[0])
    }

    /// Whether each of many rays hits anything; false for an invalid ray.
    pub fn occluded_views<'v>(
        &self,
        rays: impl Into<RayViews<'v>>,
        occluded: impl Into<Flags<'v>>,
    ) -> Result<Traced> {
        let (rays, answers) = (rays.into(), occluded.into());
        let own = [("occluded", Some(answers.count()))];
        let count = agree(rays.counts().into_iter().chain(own))?.unwrap_or(1);
        let (rays, answers) = (rays.raw(), answers.raw());
        self.run(|config| {
            // SAFETY: the views lead to `count` records each; what is written is 0 or 1, which a bool may be.
            unsafe { sys::rg_scene_occluded_views(self.scene.raw(), config, &rays, &answers, count as u64) }
        })
    }
}

/// Views of all fields of records.
fn all_fields(hits: &mut [Hit]) -> sys::rg_hit_views {
    let (first, stride) = (hits.as_mut_ptr().cast::<u8>(), size_of::<Hit>() as isize);
    let at = |offset: usize, type_: sys::rg_type| sys::rg_output {
        data: first.wrapping_add(offset).cast(),
        stride,
        type_,
    };
    let three = |offset: usize, size: usize, type_: sys::rg_type| {
        let [x, y, z] = [0, 1, 2].map(|axis| first.wrapping_add(offset + axis * size).cast());
        sys::rg_output3 { x, y, z, stride, type_ }
    };
    use std::mem::offset_of;
    let none = sys::rg_output::default();
    sized!(rg_hit_views {
        t: at(offset_of!(Hit, t), sys::RG_F64),
        object: at(offset_of!(Hit, object), sys::RG_U64),
        primitive: at(offset_of!(Hit, primitive), sys::RG_U32),
        normal: three(offset_of!(Hit, normal), size_of::<f32>(), sys::RG_F32),
        u: at(offset_of!(Hit, u), sys::RG_F32),
        v: at(offset_of!(Hit, v), sys::RG_F32),
        position: three(offset_of!(Hit, position), size_of::<f64>(), sys::RG_F64),
        offset: at(offset_of!(Hit, offset), sys::RG_F32),
        cells: none,
        tests: none,
    })
}
