// SPDX-License-Identifier: MIT
//! Shapes that the host intersects.

use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};

use raygrid_sys as sys;

use crate::host::forget_panic;
use crate::{Result, Shape, sized};

/// A ray as a [`UserShape`] sees it: `origin + t * direction`, in the shape's local frame.
///
/// It may be another ray along the same line than the one that was traced, so that nothing loses precision far away.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct LocalRay {
    /// Where t is 0.
    pub origin: [f64; 3],
    /// Of any length but 0.
    pub direction: [f64; 3],
    /// The least t that counts.
    pub t_min: f64,
    /// The largest t that counts.
    pub t_max: f64,
}

/// What a [`UserShape`] tells of a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalHit {
    /// Where, on the ray that was asked for. Outside its range it counts as none; NaN fails the trace.
    pub t: f64,
    /// Outward, of any length but 0, in the local frame.
    pub normal: [f64; 3],
    /// Handed on to [`Hit::u`](crate::Hit::u).
    pub u: f64,
    /// Handed on to [`Hit::v`](crate::Hit::v).
    pub v: f64,
    /// Handed on to [`Hit::primitive`](crate::Hit::primitive).
    pub primitive: u32,
}

impl LocalHit {
    /// The hit at `t` of a surface with this normal; primitive, u and v 0.
    pub fn new(t: f64, normal: impl Into<[f64; 3]>) -> Self {
        Self { t, normal: normal.into(), u: 0.0, v: 0.0, primitive: 0 }
    }
}

/// A shape of your own: make it with [`Shape::user`].
///
/// Its methods are called from several threads at once. They may trace and read any scene, but not change one that they
/// are called for: such calls return [`ErrorKind::Busy`](crate::ErrorKind::Busy). If one panics, the trace that asked
/// returns [`ErrorKind::CallbackFailed`](crate::ErrorKind::CallbackFailed) once all its other rays are done, and the
/// scene goes on as before; so a shape with state of its own must bear being asked again after a panic. It is dropped when the
/// call that took its last reference away is done, and may use the scene then.
///
/// ```
/// use raygrid::{LocalHit, LocalRay, Ray, Scene, Shape, UserShape};
///
/// /// The disc of radius 1 in the plane z = 0.
/// struct Disc;
///
/// impl UserShape for Disc {
///     fn bounds(&self) -> ([f64; 3], [f64; 3]) {
///         ([-1.0, -1.0, 0.0], [1.0, 1.0, 0.0])
///     }
///
///     fn intersect(&self, ray: &LocalRay) -> Option<LocalHit> {
///         let t = -ray.origin[2] / ray.direction[2];
///         let [x, y] = [0, 1].map(|axis| ray.origin[axis] + t * ray.direction[axis]);
///         (t.is_finite() && x * x + y * y <= 1.0).then(|| LocalHit::new(t, [0.0, 0.0, 1.0]))
///     }
/// }
///
/// let scene = Scene::new()?;
/// scene.insert(&Shape::user(Disc)?, [0.0, 0.0, 5.0])?;
/// assert_eq!(scene.trace(&Ray::new([0.5, 0.5, 0.0], [0.0, 0.0, 1.0]))?.unwrap().t, 5.0);
/// assert!(scene.trace(&Ray::new([0.9, 0.9, 0.0], [0.0, 0.0, 1.0]))?.is_none());
/// # Ok::<(), raygrid::Error>(())
/// ```
pub trait UserShape: Send + Sync + 'static {
    /// The low and the high corner of the local box that holds the shape: finite. Asked once.
    fn bounds(&self) -> ([f64; 3], [f64; 3]);

    /// The hit with the smallest t from `ray.t_min` to `ray.t_max`, if there is any. Where a hit does not count (for
    /// culling or a filter), it is asked again with `t_min` just beyond it.
    fn intersect(&self, ray: &LocalRay) -> Option<LocalHit>;

    /// Whether there is any hit from `ray.t_min` to `ray.t_max`.
    fn occluded(&self, ray: &LocalRay) -> bool {
        self.intersect(ray).is_some_and(|hit| ray.t_min <= hit.t && hit.t <= ray.t_max)
    }
}

// SAFETY (all three): the library hands back the `user` of the definition, which `create` made of a Box<T> and which
// `destroy` alone ends; rays and hits are there during the call. `LocalRay` is laid out as `rg_local_ray`.

unsafe extern "C" fn intersect<T: UserShape>(
    user: *mut c_void,
    ray: *const sys::rg_local_ray,
    hit: *mut sys::rg_local_hit,
) -> i32 {
    // SAFETY: see above.
    let (shape, ray, hit) = unsafe { (&*user.cast::<T>(), &*ray.cast::<LocalRay>(), &mut *hit) };
    match catch_unwind(AssertUnwindSafe(|| shape.intersect(ray))) {
        Ok(None) => 0,
        Ok(Some(LocalHit { t, normal, u, v, primitive })) => {
            *hit = sys::rg_local_hit { t, normal, u, v, primitive };
            1
        }
        Err(panic) => forget_panic(panic, -1),
    }
}

unsafe extern "C" fn occluded<T: UserShape>(user: *mut c_void, ray: *const sys::rg_local_ray) -> i32 {
    // SAFETY: see above.
    let (shape, ray) = unsafe { (&*user.cast::<T>(), &*ray.cast::<LocalRay>()) };
    match catch_unwind(AssertUnwindSafe(|| shape.occluded(ray))) {
        Ok(any) => i32::from(any),
        Err(panic) => forget_panic(panic, -1),
    }
}

unsafe extern "C" fn destroy<T: UserShape>(user: *mut c_void) {
    // SAFETY: see above.
    let shape = unsafe { Box::from_raw(user.cast::<T>()) };
    if let Err(panic) = catch_unwind(AssertUnwindSafe(|| drop(shape))) {
        forget_panic(panic, ());
    }
}

pub(crate) fn create<T: UserShape>(shape: T) -> Result<Shape> {
    let (lo, hi) = shape.bounds();
    let user = Box::into_raw(Box::new(shape));
    let definition = sized!(rg_user_shape {
        user: user.cast(),
        lo: lo,
        hi: hi,
        intersect: Some(intersect::<T>),
        occluded: Some(occluded::<T>),
        destroy: Some(destroy::<T>),
    });
    // SAFETY: the definition is copied; `out` is written on success.
    let made = Shape::made(|out| unsafe { sys::rg_shape_create_user(std::ptr::null(), &definition, out) });
    if made.is_err() {
        // SAFETY: destroy is not called then, so this is the only owner.
        drop(unsafe { Box::from_raw(user) });
    }
    made
}

const _: () = {
    use std::mem::offset_of;
    assert!(size_of::<LocalRay>() == size_of::<sys::rg_local_ray>());
    assert!(align_of::<LocalRay>() == align_of::<sys::rg_local_ray>());
    assert!(offset_of!(LocalRay, origin) == offset_of!(sys::rg_local_ray, origin));
    assert!(offset_of!(LocalRay, direction) == offset_of!(sys::rg_local_ray, direction));
    assert!(offset_of!(LocalRay, t_min) == offset_of!(sys::rg_local_ray, t_min));
    assert!(offset_of!(LocalRay, t_max) == offset_of!(sys::rg_local_ray, t_max));
};
