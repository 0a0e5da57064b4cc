// SPDX-License-Identifier: MIT
//! The time that this thread has spent computing: other programs do not count.

use std::time::Duration;

/// Since some point in the past.
pub fn thread_time() -> Duration {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: writes the struct that it is handed.
    let result = unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    assert_eq!(result, 0, "there is no clock for the time of a thread");
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// How long `work` takes.
pub fn taken(work: impl FnOnce()) -> Duration {
    let start = thread_time();
    work();
    thread_time() - start
}
