// SPDX-License-Identifier: MIT
//! What a scene takes from its host: threads, memory, a place for messages.

use std::alloc::{Layout, alloc, dealloc};
use std::any::Any;
use std::collections::VecDeque;
use std::ffi::{CStr, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::{self, NonNull};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use raygrid_sys as sys;

use crate::error::check;
use crate::scene::Keeper;
use crate::{Error, ErrorKind, GridConfig, Result, Scene, sized};

/// Leaves a panic behind that was caught at the border to C, and gives what C is told instead. Words are dropped; what
/// else a panic may carry is not: that might panic again.
pub(crate) fn forget_panic<T>(panic: Box<dyn Any + Send>, told: T) -> T {
    if !(panic.is::<String>() || panic.is::<&str>()) {
        std::mem::forget(panic);
    }
    told
}

/// Calls a function of the host from the border to C: what it gives, or what its panic said.
pub(crate) fn caught<T>(call: impl FnOnce() -> T) -> std::result::Result<T, String> {
    catch_unwind(AssertUnwindSafe(call)).map_err(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let words = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no words").to_owned();
        forget_panic(panic, words)
    })
}

/// The result of a call in which a function of the host failed and said why, if it did; `what` it was, if the call knows
/// of nothing.
pub(crate) fn with_words<T>(result: Result<T>, what: &str, words: Option<String>) -> Result<T> {
    let Some(words) = words else { return result };
    let what = result.as_ref().err().map_or(what, Error::message);
    Err(Error::new(ErrorKind::CallbackFailed, format!("{what}: {words}")))
}

/// A host's own job system, in place of a scene's workers.
///
/// ```
/// use raygrid::{ParallelFor, Scene};
///
/// /// Some threads for each call, as a simple job system.
/// struct Threads;
///
/// impl ParallelFor for Threads {
///     fn run(&self, count: u64, work: &(dyn Fn() + Sync)) {
///         let share = count.div_ceil(4);
///         std::thread::scope(|scope| {
///             for _ in 0..4 {
///                 scope.spawn(|| (0..share).for_each(|_| work()));
///             }
///         });
///     }
/// }
///
/// let scene = Scene::builder().parallel_for(Threads).build()?;
/// assert_eq!(scene.stats()?.workers, 0);
/// # Ok::<(), raygrid::Error>(())
/// ```
pub trait ParallelFor: Send + Sync + 'static {
    /// Calls `work` at least `count` times, on any threads, and returns when all calls have returned. They never fail
    /// and never wait for one another. What is called too often does nothing; what is called too seldom, or not because
    /// of a panic, is done after this has returned.
    fn run(&self, count: u64, work: &(dyn Fn() + Sync));
}

/// The pieces of one parallel loop, each of which is done once, whoever asks how often.
struct Pieces {
    next: AtomicU64,
    count: u64,
    body: unsafe extern "C" fn(context: *mut c_void, index: u64),
    context: *mut c_void,
}

// SAFETY: the library lets `body` be called with `context` from any threads.
unsafe impl Sync for Pieces {}

impl Pieces {
    /// Does the next piece; false: there is none left.
    fn do_next(&self) -> bool {
        let index = self.next.fetch_add(1, Ordering::Relaxed);
        if index < self.count {
            // SAFETY: each index below the count is given to body once, while the library waits for all of them.
            unsafe { (self.body)(self.context, index) };
        }
        index < self.count
    }
}

unsafe extern "C" fn parallel_for(
    user: *mut c_void,
    count: u64,
    body: Option<unsafe extern "C" fn(context: *mut c_void, index: u64)>,
    context: *mut c_void,
) {
    let Some(body) = body else { return };
    // SAFETY: `user` is the Box that the scene keeps as long as it is there.
    let host = unsafe { &*user.cast::<Box<dyn ParallelFor>>() };
    let pieces = Pieces { next: AtomicU64::new(0), count, body, context };
    let work = || {
        pieces.do_next();
    };
    // What a panic left undone is done below, as is what was forgotten.
    if let Err(panic) = catch_unwind(AssertUnwindSafe(|| host.run(count, &work))) {
        forget_panic(panic, ());
    }
    while pieces.do_next() {}
}

/// Receives lines of text.
type Tell = Box<dyn Fn(&str) + Send + Sync>;

/// Messages on their way to the host. The library tells them in the midst of its work, where the scene must not be used:
/// so they are kept until a call has returned.
pub(crate) struct Log {
    tell: Tell,
    lines: Mutex<VecDeque<String>>,
    waiting: AtomicBool,
}

impl Log {
    #[inline]
    pub(crate) fn deliver(&self) {
        if self.waiting.load(Ordering::Relaxed) {
            self.deliver_all();
        }
    }

    #[cold]
    fn deliver_all(&self) {
        self.waiting.store(false, Ordering::Relaxed);
        while let Some(line) = self.take() {
            (self.tell)(&line);
        }
    }

    fn take(&self) -> Option<String> {
        self.lines.lock().unwrap_or_else(PoisonError::into_inner).pop_front()
    }
}

unsafe extern "C" fn log(user: *mut c_void, message: *const c_char) {
    // SAFETY: `user` is the Log that the scene keeps as long as it is there; the message is a text that ends with 0.
    let (log, message) = unsafe { (&*user.cast::<Log>(), CStr::from_ptr(message)) };
    let line = message.to_string_lossy().into_owned();
    log.lines.lock().unwrap_or_else(PoisonError::into_inner).push_back(line);
    log.waiting.store(true, Ordering::Relaxed);
}

unsafe extern "C" fn allocate(_: *mut c_void, size: usize, alignment: usize) -> *mut c_void {
    match Layout::from_size_align(size, alignment) {
        // SAFETY: the library asks for more than 0 bytes.
        Ok(layout) => unsafe { alloc(layout) }.cast(),
        Err(_) => ptr::null_mut(),
    }
}

unsafe extern "C" fn release(_: *mut c_void, memory: *mut c_void, size: usize, alignment: usize) {
    // SAFETY: what `allocate` returned, with the same size and alignment.
    unsafe { dealloc(memory.cast(), Layout::from_size_align_unchecked(size, alignment)) };
}

/// How a scene is made: from [`Scene::builder`].
#[derive(Default)]
#[must_use]
pub struct Builder {
    workers: u32,
    grid: Option<GridConfig>,
    own_memory: bool,
    memory_limit: u64,
    parallel_for: Option<Box<dyn ParallelFor>>,
    log: Option<Tell>,
}

impl Builder {
    /// Threads that trace large calls together, the calling one among them: 0, the default, for one a processor; 1 for
    /// the calling thread alone.
    pub fn workers(self, workers: u32) -> Self {
        Self { workers, ..self }
    }

    /// How the scene's own grid is made.
    pub fn grid(self, grid: GridConfig) -> Self {
        Self { grid: Some(grid), ..self }
    }

    /// The host's job system in place of workers; then no thread is made.
    pub fn parallel_for(self, host: impl ParallelFor) -> Self {
        Self { parallel_for: Some(Box::new(host)), ..self }
    }

    /// Told, in a line of text, when a grid is rebuilt or could not be for want of memory. It is called by the thread
    /// whose call that happened in, or by that of the next call that changes the scene, which it may use freely.
    pub fn log(self, tell: impl Fn(&str) + Send + Sync + 'static) -> Self {
        Self { log: Some(Box::new(tell)), ..self }
    }

    /// Takes the scene's memory from Rust's global allocator. The default is malloc, and huge pages for large blocks.
    pub fn global_allocator(self) -> Self {
        Self { own_memory: true, ..self }
    }

    /// Bytes of memory that the scene may hold, shapes not counted; 0, the default: no limit. What would need more is
    /// [`ErrorKind::OutOfMemory`](crate::ErrorKind::OutOfMemory).
    pub fn memory_limit(self, memory_limit: u64) -> Self {
        Self { memory_limit, ..self }
    }

    /// Makes the scene, empty.
    pub fn build(self) -> Result<Scene> {
        // SAFETY: `make` hands in what rg_scene_create takes.
        self.make(None, |config, out| unsafe { sys::rg_scene_create(config, out) })
    }

    /// Makes a scene by a call of the library that takes a configuration and writes the scene; with a share in the one
    /// that it follows.
    pub(crate) fn make(
        self,
        followed: Option<Keeper>,
        create: impl FnOnce(*const sys::rg_scene_config, *mut *mut sys::rg_scene) -> sys::rg_result,
    ) -> Result<Scene> {
        let log =
            self.log.map(|tell| Box::new(Log { tell, lines: Mutex::default(), waiting: AtomicBool::new(false) }));
        let host = self.parallel_for.map(Box::new);
        let grid = self.grid.map(|grid| grid.raw());
        let host_at = host.as_ref().map_or(ptr::null(), |host| ptr::from_ref::<Box<dyn ParallelFor>>(host));
        let log_at = log.as_ref().map_or(ptr::null(), |log| ptr::from_ref::<Log>(log));
        let config = sized!(rg_scene_config {
            workers: self.workers,
            reserved: 0,
            allocator: sys::rg_allocator {
                user: ptr::null_mut(),
                allocate: self.own_memory.then_some(allocate),
                release: self.own_memory.then_some(release),
            },
            parallel_for: host.as_ref().map(|_| parallel_for as _),
            parallel_for_user: host_at.cast_mut().cast(),
            log: log.as_ref().map(|_| self::log as _),
            log_user: log_at.cast_mut().cast(),
            grid: grid.as_ref().map_or(ptr::null(), ptr::from_ref),
            memory_limit: self.memory_limit,
        });
        let mut raw = ptr::null_mut();
        // What `config` leads to is there during the call, log and host as long as the scene.
        check(create(&config, &mut raw))?;
        Ok(Scene::of_parts(NonNull::new(raw).expect("a scene that was made is there"), log, host, followed))
    }
}

#[cfg(test)]
#[path = "host_tests.rs"]
mod tests;
