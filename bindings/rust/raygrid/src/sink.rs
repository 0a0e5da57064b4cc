// SPDX-License-Identifier: MIT
//! Scenes, written: snapshots and recordings.

use std::ffi::c_void;
use std::io::{self, Write};
use std::ptr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};

use raygrid_sys as sys;

use crate::error::check;
use crate::host::{caught, with_words};
use crate::{Error, ErrorKind, Result, Scene, Shape, sized};

/// Gives a user-defined shape the number by which it will be known.
type Number<'a> = dyn FnMut(&Shape) -> Option<u64> + Send + 'a;

/// Where a snapshot or a recording goes: a writer, and numbers for user-defined shapes. A writer alone is one, too.
///
/// The library hands over large pieces, and a recording's calls each in one: a buffer would only delay them. The writer
/// is called with the scene held: it may trace and read the scene; calls that would change it are
/// [`ErrorKind::Busy`].
///
/// See [`Source`](crate::Source) for an example with user-defined shapes.
#[must_use]
pub struct Sink<'a> {
    writer: Box<dyn Write + Send + 'a>,
    number: Option<Box<Number<'a>>>,
}

impl<'a> Sink<'a> {
    /// Writes here; user-defined shapes can't be written.
    pub fn new(writer: impl Write + Send + 'a) -> Self {
        Self { writer: Box::new(writer), number: None }
    }

    /// Gives each user-defined shape a number by which [`Source::find_shapes`](crate::Source::find_shapes) will know
    /// it: [`Shape::id`] tells which it is. Asked once for each. `None`: it can't be written.
    pub fn number_shapes(self, number: impl FnMut(&Shape) -> Option<u64> + Send + 'a) -> Self {
        Self { number: Some(Box::new(number)), ..self }
    }
}

impl<'a, W: Write + Send + 'a> From<W> for Sink<'a> {
    fn from(writer: W) -> Self {
        Self::new(writer)
    }
}

/// A sink in use, and what the host's part of it said when it first failed.
struct Writing<'a> {
    sink: Sink<'a>,
    failure: Option<String>,
}

/// A sink that outlives the call which it was given to. Not a Box: the library leads to it, too.
pub(crate) struct Recording(Arc<Mutex<Writing<'static>>>);

impl<'a> Writing<'a> {
    fn new(sink: Sink<'a>) -> Mutex<Self> {
        Mutex::new(Self { sink, failure: None })
    }

    fn fail(&mut self, words: String) -> i32 {
        self.failure.get_or_insert(words);
        -1
    }

    /// Has the writer do something: 0, or -1 for a failure, as the library wants to be told.
    fn attempt(&mut self, act: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> i32 {
        match caught(|| act(&mut *self.sink.writer)) {
            Ok(Ok(())) => 0,
            Ok(Err(error)) => self.fail(error.to_string()),
            Err(words) => self.fail(format!("the writer panicked: {words}")),
        }
    }

    /// Ends with what the library says; what waits in the writer goes out before.
    fn end(&mut self, result: Result<()>) -> Result<()> {
        if self.failure.is_none() {
            self.attempt(|writer| writer.flush());
        }
        with_words(result, "the last bytes can't be written", self.failure.take())
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

// SAFETY (both): `user` is the `Writing` that `raw` was made of, which is there as long as the library writes to it.

unsafe extern "C" fn write(user: *mut c_void, bytes: *const c_void, size: usize) -> i32 {
    // SAFETY: see above; the bytes are there during the call.
    let (writing, bytes) =
        unsafe { (&*user.cast::<Mutex<Writing<'_>>>(), std::slice::from_raw_parts(bytes.cast::<u8>(), size)) };
    lock(writing).attempt(|writer| writer.write_all(bytes))
}

unsafe extern "C" fn number_shape(
    user: *mut c_void,
    shape: *const sys::rg_shape,
    _: *mut c_void,
    number: *mut u64,
) -> i32 {
    // SAFETY: see above; a Shape is a pointer and nothing else, and the reference to this one does not leave the call.
    let (writing, shape) = unsafe { (&*user.cast::<Mutex<Writing<'_>>>(), &*ptr::from_ref(&shape).cast::<Shape>()) };
    let mut writing = lock(writing);
    let Some(give) = &mut writing.sink.number else { return -1 };
    match caught(|| give(shape)) {
        Ok(Some(given)) => {
            // SAFETY: the library has a place for it.
            unsafe { *number = given };
            0
        }
        Ok(None) => -1,
        Err(words) => writing.fail(format!("number_shapes panicked: {words}")),
    }
}

/// The sink in the library's words.
fn raw(writing: &Mutex<Writing<'_>>) -> sys::rg_sink {
    let numbers = lock(writing).sink.number.is_some();
    sized!(rg_sink {
        user: ptr::from_ref(writing).cast_mut().cast(),
        write: Some(write),
        number_shape: numbers.then_some(number_shape as _),
    })
}

impl Scene {
    /// The scene as it is, as bytes: shapes, grids, and objects with their ids. [`load`](Self::load) makes a scene of
    /// them that gives the same answers, to the last bit, and later the same ids. The same scene gives the same bytes.
    ///
    /// Traces go on meanwhile, changes wait; of a [`Frame`](crate::Frame) its scene's do not. A user-defined shape is
    /// [`ErrorKind::InvalidArgument`]: see [`save_to`](Self::save_to).
    ///
    /// ```
    /// use raygrid::{Ray, Scene, Shape};
    ///
    /// let scene = Scene::new()?;
    /// let ball = scene.insert(&Shape::sphere(1.0)?, [0.0, 0.0, 5.0])?;
    /// let copy = Scene::load(&scene.save()?)?;
    /// let hit = copy.trace(&Ray::new([0.0; 3], [0.0, 0.0, 1.0]))?.unwrap();
    /// assert_eq!((hit.object, hit.t), (Some(ball), 4.0));
    /// # Ok::<(), raygrid::Error>(())
    /// ```
    pub fn save(&self) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        self.save_to(&mut bytes)?;
        Ok(bytes)
    }

    /// Writes what [`save`](Self::save) gives, and flushes the writer. If it fails or panics, that is
    /// [`ErrorKind::CallbackFailed`], with what it said; the bytes before will be refused. A user-defined shape
    /// without a number is [`ErrorKind::InvalidArgument`], and the message names an object that has it.
    pub fn save_to<'a>(&self, sink: impl Into<Sink<'a>>) -> Result<()> {
        let writing = Writing::new(sink.into());
        let sink = raw(&writing);
        // SAFETY: the scene lives as long as self, the sink longer than the call.
        let result = check(unsafe { sys::rg_scene_save(self.raw(), &sink) });
        lock(&writing).end(result)
    }

    /// Begins a recording: a snapshot, and then each call that changes the scene, written before it returns. It can be
    /// played as a [`Replay`](crate::Replay) up to its last whole call: a bug report is a file.
    ///
    /// It goes on until [`end_recording`](Self::end_recording), or until the scene is dropped. If it can't (the writer
    /// fails or panics, a shape has no number), the call that was to be recorded succeeds all the same, the scene's
    /// log is told, and `end_recording` says why.
    ///
    /// Errors: as [`save_to`](Self::save_to); [`ErrorKind::Busy`] if there is a recording, if one is being begun
    /// or ended, of a frame, and from inside a callback.
    ///
    /// ```
    /// use raygrid::{Replay, Scene, Shape};
    ///
    /// # let path = std::env::temp_dir().join(format!("raygrid-{}.rg", std::process::id()));
    /// let scene = Scene::new()?;
    /// scene.record(std::fs::File::create(&path)?)?;
    /// let ball = scene.insert(&Shape::sphere(1.0)?, [0.0, 0.0, 5.0])?;
    /// scene.move_to(ball, [0.0, 0.0, 9.0])?;
    /// scene.end_recording()?;
    ///
    /// let bytes = std::fs::read(&path)?;
    /// # std::fs::remove_file(&path)?;
    /// let mut replay = Replay::new(&bytes)?;
    /// let steps = replay.by_ref().collect::<raygrid::Result<Vec<_>>>()?;
    /// assert_eq!(steps[1].call.name(), "rg_scene_move_to");
    /// assert_eq!(replay.scene().lookup(ball)?.pose, scene.lookup(ball)?.pose);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn record(&self, sink: impl Into<Sink<'static>>) -> Result<()> {
        let recording = Recording(Arc::new(Writing::new(sink.into())));
        let sink = raw(&recording.0);
        let mut slot = self.recording()?;
        // SAFETY: the scene lives as long as self; the sink is copied, and what it leads to is kept as long as the
        // scene may write to it, or is not written to any more.
        let result = check(unsafe { sys::rg_scene_record(self.raw(), &sink) });
        let result = if result.is_ok() {
            *slot = Some(recording);
            result
        } else {
            lock(&recording.0).end(result)
        };
        drop(slot); // a log may use the scene
        self.changed(result)
    }

    /// Ends the recording, if there is one, flushes its writer and drops it. It is over even if the error says that it
    /// could not be written to its end; only [`ErrorKind::Busy`], which is as for [`record`](Self::record), says
    /// that it goes on.
    pub fn end_recording(&self) -> Result<()> {
        let mut slot = self.recording()?;
        // SAFETY: the scene lives as long as self.
        let result = check(unsafe { sys::rg_scene_record(self.raw(), ptr::null()) });
        let goes_on = result.as_ref().is_err_and(|error| error.kind() == ErrorKind::Busy);
        let ended = if goes_on { None } else { slot.take() };
        drop(slot); // a log, or the drop of a writer, may use the scene
        let result = match &ended {
            Some(recording) => lock(&recording.0).end(result),
            None => result,
        };
        self.changed(result)
    }

    /// The place for the scene's recording. Nobody waits for it: who has it waits for the scene, which others may hold
    /// when they come here from inside a callback.
    fn recording(&self) -> Result<MutexGuard<'_, Option<Recording>>> {
        match self.place_for_recording().try_lock() {
            Ok(slot) => Ok(slot),
            Err(TryLockError::Poisoned(slot)) => Ok(slot.into_inner()),
            Err(TryLockError::WouldBlock) => {
                Err(Error::new(ErrorKind::Busy, "a recording of the scene is being begun or ended"))
            }
        }
    }
}
