// SPDX-License-Identifier: MIT
//! Scenes: their objects, one at a time, and their queries.

use std::fmt;
use std::ptr::NonNull;
use std::sync::{Arc, Mutex};

use raygrid_sys as sys;

use crate::error::check;
use crate::host::Log;
use crate::sink::Recording;
use crate::views::agree;
use crate::{
    Builder, Error, ErrorKind, GridConfig, GridId, GridReport, Hit, ObjectId, ObjectReport, ParallelFor, Pose, Query,
    Ray, Result, SceneReport, Shape, sized,
};

/// Objects that rays hit. What a call changes, the very next trace sees: there is no commit and no step.
///
/// Any number of threads may trace and change a scene at once, all by `&self`. A change is seen whole or not at all; it
/// waits only for the rays under way, so the rays of a long call that overlaps with changes do not all see the same
/// instant. A [`Frame`](crate::Frame) is one that lasts.
///
/// ```
/// use raygrid::{Ray, Scene, Shape};
///
/// let scene = Scene::new()?;
/// let ball = scene.insert(&Shape::sphere(1.0)?, [0.0, 0.0, 5.0])?;
/// let ray = Ray::new([0.0; 3], [0.0, 0.0, 1.0]);
/// assert_eq!(scene.trace(&ray)?.unwrap().t, 4.0);
///
/// scene.move_to(ball, [0.0, 0.0, 9.0])?;
/// assert_eq!(scene.trace(&ray)?.unwrap().t, 8.0);
///
/// scene.remove(ball)?;
/// assert!(scene.trace(&ray)?.is_none());
/// # Ok::<(), raygrid::Error>(())
/// ```
pub struct Scene {
    raw: NonNull<sys::rg_scene>,
    keeper: Keeper,
}

// SAFETY: "a scene may be used by any number of threads at once" (raygrid/scene.h).
unsafe impl Send for Scene {}
// SAFETY: as above.
unsafe impl Sync for Scene {}

/// A share in a scene, which ends with the last: that of the `Scene`, and those of its frames.
pub(crate) type Keeper = Arc<Kept>;

/// A scene in the library, and what the library leads to as long as it has the scene.
pub(crate) struct Kept {
    raw: NonNull<sys::rg_scene>,
    log: Option<Box<Log>>,
    recording: Mutex<Option<Recording>>,
    _parallel_for: Option<Box<Box<dyn ParallelFor>>>,
    /// What it is a frame of, which must not end before it.
    _followed: Option<Keeper>,
}

// SAFETY: as a `Scene`; any thread may end it, and what is kept for the library is Send and Sync itself.
unsafe impl Send for Kept {}
// SAFETY: as above.
unsafe impl Sync for Kept {}

impl Scene {
    /// An empty scene with all defaults: one worker a processor.
    pub fn new() -> Result<Self> {
        Self::builder().build()
    }

    /// An empty scene, made as the builder says.
    pub fn builder() -> Builder {
        Builder::default()
    }

    pub(crate) fn of_parts(
        raw: NonNull<sys::rg_scene>,
        log: Option<Box<Log>>,
        host: Option<Box<Box<dyn ParallelFor>>>,
        followed: Option<Keeper>,
    ) -> Self {
        let kept = Kept { raw, log, recording: Mutex::default(), _parallel_for: host, _followed: followed };
        Self { raw, keeper: Arc::new(kept) }
    }

    pub(crate) fn keeper(&self) -> Keeper {
        Arc::clone(&self.keeper)
    }

    /// The recording that the library writes, if there is one.
    pub(crate) fn place_for_recording(&self) -> &Mutex<Option<Recording>> {
        &self.keeper.recording
    }

    #[inline]
    pub(crate) fn raw(&self) -> *mut sys::rg_scene {
        self.raw.as_ptr()
    }

    /// Ends a call that may have changed the scene.
    #[inline]
    pub(crate) fn changed<T>(&self, result: Result<T>) -> Result<T> {
        if let Some(log) = &self.keeper.log {
            log.deliver();
        }
        result
    }

    // ------------------------------------------------------------------------------------------------ objects

    /// Inserts an object into the scene's own grid; rays of all masks see it. It keeps the shape for itself.
    #[inline]
    pub fn insert(&self, shape: &Shape, pose: impl Into<Pose>) -> Result<ObjectId> {
        let (pose, mut id) = (pose.into(), 0);
        // SAFETY: scene and shape live as long as their references; pose and id are there during the call.
        let result = check(unsafe { sys::rg_scene_insert(self.raw(), shape.raw(), pose.raw(), &mut id) });
        self.changed(result.map(|()| ObjectId::from_bits(id).expect("an object that was inserted has an id")))
    }

    /// Gives an object a new position; it keeps its linear part and scale.
    #[inline]
    pub fn move_to(&self, object: ObjectId, position: impl Into<[f64; 3]>) -> Result<()> {
        let position = position.into();
        // SAFETY: the scene lives as long as self; the position is three doubles.
        self.changed(check(unsafe { sys::rg_scene_move_to(self.raw(), object.to_bits(), position.as_ptr()) }))
    }

    /// Gives an object a new pose, linear part and scale among it.
    #[inline]
    pub fn move_pose(&self, object: ObjectId, pose: impl Into<Pose>) -> Result<()> {
        let pose = pose.into();
        // SAFETY: the scene lives as long as self, the pose is there during the call.
        self.changed(check(unsafe { sys::rg_scene_move(self.raw(), object.to_bits(), pose.raw()) }))
    }

    /// Changes which rays see an object: those whose mask shares a bit with this one.
    pub fn set_mask(&self, object: ObjectId, mask: u32) -> Result<()> {
        // SAFETY: the scene lives as long as self.
        self.changed(check(unsafe { sys::rg_scene_set_mask(self.raw(), object.to_bits(), mask) }))
    }

    /// Removes an object; its id is stale from now on.
    #[inline]
    pub fn remove(&self, object: ObjectId) -> Result<()> {
        // SAFETY: the scene lives as long as self.
        self.changed(check(unsafe { sys::rg_scene_remove(self.raw(), object.to_bits()) }))
    }

    /// Gives every object of this scene that has the shape `old` the shape `new`: all, or on any error none. Ids, poses
    /// and masks stay: see [`Shape::deformed`].
    pub fn replace_shape(&self, old: &Shape, new: &Shape) -> Result<()> {
        // SAFETY: the scene lives as long as self, the shapes as long as their references.
        self.changed(check(unsafe { sys::rg_scene_replace_shape(self.raw(), old.raw(), new.raw()) }))
    }

    /// What is known of an object.
    pub fn lookup(&self, object: ObjectId) -> Result<ObjectReport> {
        let mut report = sized!(rg_object_report {});
        // SAFETY: the scene lives as long as self; the report says its size.
        check(unsafe { sys::rg_scene_lookup(self.raw(), object.to_bits(), &mut report) })?;
        Ok(ObjectReport::of_raw(report))
    }

    /// The shape of an object.
    pub fn shape_of(&self, object: ObjectId) -> Result<Shape> {
        // SAFETY: the scene lives as long as self; `out` is written on success, with a reference.
        Shape::made(|out| unsafe { sys::rg_scene_shape_of(self.raw(), object.to_bits(), out) })
    }

    /// What is known of the scene.
    pub fn stats(&self) -> Result<SceneReport> {
        let mut report = sized!(rg_scene_report {});
        // SAFETY: the scene lives as long as self; the report says its size.
        check(unsafe { sys::rg_scene_stats(self.raw(), &mut report) })?;
        Ok(SceneReport::of_raw(report))
    }

    // ------------------------------------------------------------------------------------------------ queries

    /// The closest hit of a ray, if there is any. Of hits at the same t it is that of the lowest object, then of the
    /// lowest primitive.
    ///
    /// An invalid ray, one with a NaN, an infinite origin or no direction, is [`ErrorKind::InvalidValue`].
    #[inline]
    pub fn trace(&self, ray: &Ray) -> Result<Option<Hit>> {
        let mut hit = Hit::MISS;
        self.trace_many(std::slice::from_ref(ray), std::slice::from_mut(&mut hit))?;
        hit.known()
    }

    /// The closest hits of many rays: `hits[i]` is that of `rays[i]`, [`Hit::MISS`] if there is none. Large calls are
    /// spread over the scene's workers.
    ///
    /// An invalid ray has [`Hit::is_invalid`] and harms no other. [`ErrorKind::CallbackFailed`]: a user-defined shape
    /// failed; t of the rays concerned is NaN, all others are complete.
    #[inline]
    pub fn trace_many(&self, rays: &[Ray], hits: &mut [Hit]) -> Result<()> {
        if rays.len() != hits.len() {
            return Err(differ("rays", rays.len(), "hits", hits.len()));
        }
        // SAFETY: Ray and Hit are laid out as in C; there are as many of both.
        check(unsafe {
            sys::rg_scene_trace(self.raw(), rays.as_ptr().cast(), hits.as_mut_ptr().cast(), rays.len() as u64)
        })
    }

    /// Whether a ray hits anything; false for an invalid ray.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> Result<bool> {
        let mut occluded = false;
        self.occluded_many(std::slice::from_ref(ray), std::slice::from_mut(&mut occluded))?;
        Ok(occluded)
    }

    /// Whether each of many rays hits anything. Errors: as [`trace_many`](Self::trace_many).
    #[inline]
    pub fn occluded_many(&self, rays: &[Ray], occluded: &mut [bool]) -> Result<()> {
        if rays.len() != occluded.len() {
            return Err(differ("rays", rays.len(), "occluded", occluded.len()));
        }
        // SAFETY: Ray is laid out as in C; there are as many answers; they are 0 or 1, which a bool may be.
        check(unsafe {
            sys::rg_scene_occluded(self.raw(), rays.as_ptr().cast(), occluded.as_mut_ptr().cast(), rays.len() as u64)
        })
    }

    /// Traces in other ways: with culling, with filters, to and from arrays of your own.
    pub fn query(&self) -> Query<'_> {
        Query::new(self)
    }

    // -------------------------------------------------------------------------------------------------- grids

    /// Adds an empty grid, for instance one for what never moves. A trace goes through all.
    pub fn create_grid(&self, config: &GridConfig) -> Result<GridId> {
        let (config, mut grid) = (config.raw(), 0);
        // SAFETY: the scene lives as long as self; config and grid are there during the call.
        self.changed(check(unsafe { sys::rg_grid_create(self.raw(), &config, &mut grid) }).map(|()| GridId(grid)))
    }

    /// Destroys an empty grid.
    pub fn destroy_grid(&self, grid: GridId) -> Result<()> {
        // SAFETY: the scene lives as long as self.
        self.changed(check(unsafe { sys::rg_grid_destroy(self.raw(), grid.0) }))
    }

    /// Makes a grid anew in another way, with the objects that it holds.
    pub fn configure_grid(&self, grid: GridId, config: &GridConfig) -> Result<()> {
        let config = config.raw();
        // SAFETY: the scene lives as long as self; config is there during the call.
        self.changed(check(unsafe { sys::rg_grid_configure(self.raw(), grid.0, &config) }))
    }

    /// Rebuilds a grid now, with a box and a resolution that fit its objects.
    pub fn rebuild_grid(&self, grid: GridId) -> Result<()> {
        // SAFETY: the scene lives as long as self.
        self.changed(check(unsafe { sys::rg_grid_rebuild(self.raw(), grid.0) }))
    }

    /// What is known of a grid.
    pub fn grid_stats(&self, grid: GridId) -> Result<GridReport> {
        let mut report = sized!(rg_grid_report {});
        // SAFETY: the scene lives as long as self; the report says its size.
        check(unsafe { sys::rg_grid_stats(self.raw(), grid.0, &mut report) })?;
        Ok(GridReport::of_raw(report))
    }
}

impl Hit {
    /// This hit of a single ray, or why there can't be any.
    #[inline]
    pub(crate) fn known(self) -> Result<Option<Self>> {
        if self.is_hit() {
            Ok(Some(self))
        } else if self.is_invalid() {
            Err(Error::new(
                ErrorKind::InvalidValue,
                "the ray has a NaN, an infinite origin, no direction or no range",
            ))
        } else {
            Ok(None)
        }
    }
}

#[cold]
fn differ(first: &str, wanted: usize, second: &str, count: usize) -> Error {
    let counts = [(first, Some(wanted)), (second, Some(count))];
    agree(counts).err().unwrap_or_else(|| unreachable!("only called for counts that differ"))
}

impl Drop for Kept {
    fn drop(&mut self) {
        let mut raw = self.raw.as_ptr();
        // SAFETY: nobody else has it. No call on it is running, nor is this one of its callbacks, which all come from
        // calls that borrow it; and its frames are gone.
        unsafe { sys::rg_scene_destroy(&mut raw) };
        if let Some(log) = &self.log {
            log.deliver();
        }
    }
}

impl fmt::Debug for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.stats() {
            Ok(report) => f.debug_tuple("Scene").field(&report).finish(),
            Err(error) => error.fmt(f),
        }
    }
}
