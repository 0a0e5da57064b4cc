// SPDX-License-Identifier: MIT
//! What the library calls, called here as it does. Miri runs these.

use std::sync::atomic::{AtomicU32, Ordering};

use super::*;

/// How often each piece was done.
type Done = [AtomicU32; 50];

unsafe extern "C" fn body(context: *mut c_void, index: u64) {
    // SAFETY: what `pieces_done_by` hands in.
    let done = unsafe { &*context.cast::<Done>() };
    done[index as usize].fetch_add(1, Ordering::Relaxed);
}

/// Runs a loop of 50 pieces on a host.
fn pieces_done_by(host: impl ParallelFor) -> [u32; 50] {
    let host: Box<dyn ParallelFor> = Box::new(host);
    let done: Done = std::array::from_fn(|_| AtomicU32::new(0));
    let (user, context) = (ptr::from_ref(&host).cast_mut().cast(), ptr::from_ref(&done).cast_mut().cast());
    // SAFETY: both live until the loop has ended.
    unsafe { parallel_for(user, 50, Some(body), context) };
    done.map(AtomicU32::into_inner)
}

struct Host<F>(F);

impl<F: Fn(u64, &(dyn Fn() + Sync)) + Send + Sync + 'static> ParallelFor for Host<F> {
    fn run(&self, count: u64, work: &(dyn Fn() + Sync)) {
        (self.0)(count, work);
    }
}

#[test]
fn each_piece_is_done_once() {
    assert_eq!(pieces_done_by(Host(|count, work: &(dyn Fn() + Sync)| (0..count).for_each(|_| work()))), [1; 50]);
    assert_eq!(pieces_done_by(Host(|_, work: &(dyn Fn() + Sync)| (0..99).for_each(|_| work()))), [1; 50]);
    assert_eq!(pieces_done_by(Host(|_, _: &(dyn Fn() + Sync)| ())), [1; 50]);
    let threads = Host(|_, work: &(dyn Fn() + Sync)| {
        std::thread::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(|| (0..30).for_each(|_| work()));
            }
        });
    });
    assert_eq!(pieces_done_by(threads), [1; 50]);
}

#[test]
fn memory_comes_and_goes() {
    // SAFETY: what is released is what was allocated; no more than it is written.
    unsafe {
        let memory = allocate(ptr::null_mut(), 1000, 64);
        assert!(!memory.is_null() && memory.addr() % 64 == 0);
        memory.cast::<u8>().write_bytes(0xa5, 1000);
        release(ptr::null_mut(), memory, 1000, 64);
        assert!(allocate(ptr::null_mut(), usize::MAX / 2, 64).is_null());
    }
}

#[test]
fn lines_are_kept_until_they_are_delivered() {
    let (sender, receiver) = std::sync::mpsc::channel();
    let tell = Box::new(move |line: &str| sender.send(line.to_owned()).expect("somebody listens"));
    let receiving = Log { tell, lines: Mutex::default(), waiting: AtomicBool::new(false) };
    for line in [c"one", c"two"] {
        // SAFETY: both live during the call.
        unsafe { log(ptr::from_ref(&receiving).cast_mut().cast(), line.as_ptr()) };
    }
    assert!(receiver.try_recv().is_err());
    receiving.deliver();
    receiving.deliver();
    assert_eq!(receiver.try_iter().collect::<Vec<_>>(), ["one", "two"]);
}
