// SPDX-License-Identifier: MIT
//! Scenes, read: snapshots, and what recordings begin with.

use std::ffi::c_void;
use std::ptr;
use std::sync::{Mutex, PoisonError};

use raygrid_sys as sys;

use crate::host::{caught, with_words};
use crate::{Builder, Result, Scene, Shape, sized};

/// Gives the user-defined shape of a number and a local box.
type Find<'a> = dyn FnMut(u64, [f64; 3], [f64; 3]) -> Option<Shape> + Send + 'a;

/// Where a snapshot or a recording comes from: bytes, and shapes for the numbers of user-defined ones. Bytes alone
/// (`&[u8]`, `&Vec<u8>`, a mapped file) are one, too.
///
/// ```
/// use raygrid::{LocalHit, LocalRay, Scene, Shape, Sink, Source, UserShape};
///
/// /// A plane of a heightfield's size, which stands for it here.
/// struct Ground;
///
/// impl UserShape for Ground {
///     fn bounds(&self) -> ([f64; 3], [f64; 3]) {
///         ([-9.0, 0.0, -9.0], [9.0, 0.0, 9.0])
///     }
///
///     fn intersect(&self, ray: &LocalRay) -> Option<LocalHit> {
///         Some(LocalHit::new(-ray.origin[1] / ray.direction[1], [0.0, 1.0, 0.0])).filter(|hit| hit.t.is_finite())
///     }
/// }
///
/// const GROUND: u64 = 1;
/// let ground = Shape::user(Ground)?;
/// let scene = Scene::new()?;
/// scene.insert(&ground, [0.0; 3])?;
/// let mut bytes = Vec::new();
/// scene.save_to(Sink::new(&mut bytes).number_shapes(|shape| (shape.id() == ground.id()).then_some(GROUND)))?;
///
/// let find = |number, _, _| (number == GROUND).then(|| ground.clone());
/// let copy = Scene::builder().load(Source::new(&bytes).find_shapes(find))?;
/// assert_eq!(copy.stats()?.objects, 1);
/// assert!(Scene::load(&bytes).is_err()); // nobody there who knows the ground
/// # Ok::<(), raygrid::Error>(())
/// ```
#[must_use]
pub struct Source<'a> {
    bytes: &'a [u8],
    find: Option<Box<Find<'a>>>,
}

impl<'a> Source<'a> {
    /// Reads these bytes; user-defined shapes are refused.
    pub fn new(bytes: &'a (impl AsRef<[u8]> + ?Sized)) -> Self {
        Self { bytes: bytes.as_ref(), find: None }
    }

    /// Gives the user-defined shapes: called with the number that [`Sink::number_shapes`](crate::Sink::number_shapes)
    /// gave it, and the corners of the local box that it had and must have again. `None`: there is none, and the call
    /// fails.
    pub fn find_shapes(self, find: impl FnMut(u64, [f64; 3], [f64; 3]) -> Option<Shape> + Send + 'a) -> Self {
        Self { find: Some(Box::new(find)), ..self }
    }
}

impl<'a, B: AsRef<[u8]> + ?Sized> From<&'a B> for Source<'a> {
    fn from(bytes: &'a B) -> Self {
        Self::new(bytes)
    }
}

/// A source in use, and what the host's part of it said when it last failed.
pub(crate) struct Reading<'a> {
    source: Source<'a>,
    failure: Option<String>,
}

impl<'a> Reading<'a> {
    pub(crate) fn new(source: Source<'a>) -> Mutex<Self> {
        Mutex::new(Self { source, failure: None })
    }
}

/// The source in the library's words. Of what is behind it, nothing may move or end before the library is done.
pub(crate) fn raw(reading: &Mutex<Reading<'_>>) -> sys::rg_source {
    let Reading { source, .. } = &*reading.lock().unwrap_or_else(PoisonError::into_inner);
    sized!(rg_source {
        bytes: source.bytes.as_ptr().cast(),
        byte_count: source.bytes.len() as u64,
        user: ptr::from_ref(reading).cast_mut().cast(),
        find_shape: source.find.is_some().then_some(find_shape as _),
        shapes: ptr::null(),
    })
}

/// Ends a call that may have asked for shapes.
pub(crate) fn read<T>(reading: &Mutex<Reading<'_>>, result: Result<T>) -> Result<T> {
    let failure = reading.lock().unwrap_or_else(PoisonError::into_inner).failure.take();
    with_words(result, "find_shapes failed", failure)
}

unsafe extern "C" fn find_shape(
    user: *mut c_void,
    number: u64,
    lo: *const f64,
    hi: *const f64,
    shape: *mut *mut sys::rg_shape,
) -> i32 {
    // SAFETY: `user` is the `Reading` that `raw` was made of; the corners are three doubles each.
    let (reading, lo, hi) =
        unsafe { (&*user.cast::<Mutex<Reading<'_>>>(), *lo.cast::<[f64; 3]>(), *hi.cast::<[f64; 3]>()) };
    let mut reading = reading.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(find) = &mut reading.source.find else { return -1 };
    reading.failure = match caught(|| find(number, lo, hi)) {
        Ok(Some(found)) => {
            // SAFETY: there is a place for it, and for its reference.
            unsafe { *shape = found.into_raw() };
            return 0;
        }
        Ok(None) => Some(format!("there is no shape {number}")),
        Err(words) => Some(format!("find_shapes panicked: {words}")),
    };
    -1
}

impl Scene {
    /// The scene that was saved: see [`save`](Self::save). [`Builder::load`] does it with other workers, memory or log.
    pub fn load<'a>(source: impl Into<Source<'a>>) -> Result<Self> {
        Self::builder().load(source)
    }
}

impl Builder {
    /// Makes the scene from a snapshot, grids among it: what [`grid`](Self::grid) says is ignored. It takes as long as
    /// inserting all objects at once.
    ///
    /// Any bytes may come: they are checked while they are read, and
    /// [`ErrorKind::InvalidData`](crate::ErrorKind::InvalidData) names the one where something was wrong. Who reads what
    /// strangers send sets a [`memory_limit`](Self::memory_limit).
    /// [`ErrorKind::CallbackFailed`](crate::ErrorKind::CallbackFailed): [`find_shapes`](Source::find_shapes) panicked,
    /// or gave no shape, or another one.
    pub fn load<'a>(self, source: impl Into<Source<'a>>) -> Result<Scene> {
        let reading = Reading::new(source.into());
        let source = raw(&reading);
        // SAFETY: `make` hands in what rg_scene_load takes; the source lives longer than the call.
        let made = self.make(None, |config, out| unsafe { sys::rg_scene_load(config, &source, out) });
        read(&reading, made)
    }
}
