// SPDX-License-Identifier: MIT
//! Recordings, played.

use std::ffi::CStr;
use std::fmt;
use std::ptr::{self, NonNull};
use std::sync::{Arc, Mutex};

use raygrid_sys as sys;

use crate::error::check;
use crate::source::{self, Reading};
use crate::{Builder, Call, GridId, ObjectId, Result, Scene, Source, sized};

/// A call of a recording that was played.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Step {
    /// Which it was.
    pub call: Call,
    /// Calls played so far, this one among them.
    pub calls: u64,
    /// Bytes of the recording up to here.
    pub offset: u64,
    /// How many objects it was about.
    pub objects: u64,
    /// The first of them.
    pub object: Option<ObjectId>,
    /// The grid that it was about or inserted into; else the scene's own.
    pub grid: GridId,
}

/// A recording that is played, call by call, on a scene of its own: an iterator of [`Step`]s. It ends after the last
/// call, or after an error.
///
/// ```
/// use raygrid::{Ray, Replay, Scene};
///
/// fn look_for_the_first_hit(recording: &[u8], ray: &Ray) -> raygrid::Result<Option<u64>> {
///     let mut replay = Replay::new(recording)?;
///     while let Some(step) = replay.step()? {
///         if replay.scene().occluded(ray)? {
///             return Ok(Some(step.calls));
///         }
///     }
///     Ok(None)
/// }
///
/// let snapshot = Scene::new()?.save()?; // a recording of no calls
/// assert_eq!(look_for_the_first_hit(&snapshot, &Ray::new([0.0; 3], [0.0, 0.0, 1.0]))?, None);
/// # Ok::<(), raygrid::Error>(())
/// ```
pub struct Replay<'a> {
    played: Played,
    scene: Scene,
    /// Shared, so that it does not move: `played` leads to it.
    reading: Arc<Mutex<Reading<'a>>>,
    failed: bool,
}

/// A replay in the library.
struct Played(NonNull<sys::rg_replay>);

// SAFETY: "a replay is to be used by one thread at a time" (raygrid/record.h), whichever: only `&mut self` uses it.
unsafe impl Send for Played {}
// SAFETY: as above.
unsafe impl Sync for Played {}

impl Drop for Played {
    fn drop(&mut self) {
        let mut raw = self.0.as_ptr();
        // SAFETY: nobody else has it.
        unsafe { sys::rg_replay_destroy(&mut raw) };
    }
}

impl<'a> Replay<'a> {
    /// Makes the scene with which a recording, or a snapshot, begins. Errors: as [`Builder::load`].
    pub fn new(source: impl Into<Source<'a>>) -> Result<Self> {
        Scene::builder().replay(source)
    }

    /// The scene as it is after the last step.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Ends the replay; the scene is the caller's.
    pub fn into_scene(self) -> Scene {
        self.scene
    }

    /// Plays the next call; `None`: there is no more.
    ///
    /// [`ErrorKind::InvalidData`](crate::ErrorKind::InvalidData): the recording is damaged or cut off, or the call did
    /// otherwise than when it was recorded; the scene is as after the step before, unless an id was another. After
    /// other errors (no memory, a shape that was not found) the step may be tried again.
    pub fn step(&mut self) -> Result<Option<Step>> {
        let mut report = sized!(rg_replay_report {});
        // SAFETY: the replay lives as long as self, and so do its scene and its source; the report says its size.
        let result = check(unsafe { sys::rg_replay_step(self.played.0.as_ptr(), &mut report) });
        self.failed = result.is_err();
        self.scene.changed(source::read(&self.reading, result))?;
        let sys::rg_replay_report { size: _, calls, offset, objects, object, call, grid } = report;
        let step = Step {
            call: Call::try_from(call).unwrap_or_default(),
            calls,
            offset,
            objects,
            object: ObjectId::from_bits(object),
            grid: GridId(grid),
        };
        Ok((call != sys::RG_CALL_NONE).then_some(step))
    }
}

impl Iterator for Replay<'_> {
    type Item = Result<Step>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.failed { None } else { self.step().transpose() }
    }
}

impl fmt::Debug for Replay<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Replay").field("scene", &self.scene).field("failed", &self.failed).finish_non_exhaustive()
    }
}

impl Builder {
    /// Makes a scene from the beginning of a recording, and a replay that plays the rest on it. As [`load`](Self::load)
    /// in all else.
    pub fn replay<'a>(self, source: impl Into<Source<'a>>) -> Result<Replay<'a>> {
        let reading = Arc::new(Reading::new(source.into()));
        let (source, mut raw) = (source::raw(&reading), ptr::null_mut());
        // SAFETY: `make` hands in what rg_replay_create takes; the replay keeps what the source leads to.
        let made = self.make(None, |config, out| unsafe { sys::rg_replay_create(config, &source, &mut raw, out) });
        let scene = source::read(&reading, made)?;
        let played = Played(NonNull::new(raw).expect("a replay that was made is there"));
        Ok(Replay { played, scene, reading, failed: false })
    }
}

impl Call {
    /// The name of the function that makes it in C, such as `rg_scene_insert`.
    pub fn name(self) -> &'static str {
        // SAFETY: the library's own text, which lasts.
        let name = unsafe { CStr::from_ptr(sys::rg_call_name(self as i32)) };
        name.to_str().unwrap_or_default()
    }
}
