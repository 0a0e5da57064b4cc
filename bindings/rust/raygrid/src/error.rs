// SPDX-License-Identifier: MIT
//! What the library refuses.

use std::ffi::CStr;
use std::fmt;

use raygrid_sys as sys;

/// What a call gives that can fail.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a call failed. Nothing has changed then, unless the call says otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Something required is missing, counts differ, or a value is none of an enumeration.
    InvalidArgument,
    /// A number is NaN, infinite or out of its range; a pose is singular; a mesh index has no vertex.
    InvalidValue,
    /// The id of an object or grid is stale, or none of this scene's.
    InvalidId,
    /// A count is beyond what the library can address.
    LimitExceeded,
    /// There is no memory left.
    OutOfMemory,
    /// The system refused to start a worker.
    OutOfThreads,
    /// The call would change a scene from inside a callback of that scene, or destroy what is in use.
    Busy,
    /// A user-defined shape or a filter panicked, or a shape gave NaN.
    CallbackFailed,
    /// A snapshot or recording is damaged, of another version, or not what the call takes.
    InvalidData,
    /// A failure that this version of the binding has no name for.
    Other,
}

impl ErrorKind {
    fn of(result: sys::rg_result) -> Self {
        match result {
            sys::RG_INVALID_ARGUMENT => Self::InvalidArgument,
            sys::RG_INVALID_VALUE => Self::InvalidValue,
            sys::RG_INVALID_ID => Self::InvalidId,
            sys::RG_LIMIT_EXCEEDED => Self::LimitExceeded,
            sys::RG_OUT_OF_MEMORY => Self::OutOfMemory,
            sys::RG_OUT_OF_THREADS => Self::OutOfThreads,
            sys::RG_BUSY => Self::Busy,
            sys::RG_CALLBACK_FAILED => Self::CallbackFailed,
            sys::RG_INVALID_DATA => Self::InvalidData,
            _ => Self::Other,
        }
    }
}

/// Why a call failed, in one word and in a sentence that names the value that was wrong.
///
/// ```
/// use raygrid::{ErrorKind, Shape};
///
/// let error = Shape::sphere(-1.0).unwrap_err();
/// assert_eq!(error.kind(), ErrorKind::InvalidValue);
/// assert!(error.to_string().contains("-1"));
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct Error(Box<Inside>); // one pointer: results of calls stay small

#[derive(Clone, PartialEq, Eq)]
struct Inside {
    kind: ErrorKind,
    message: String,
}

impl Error {
    pub(crate) fn new(kind: ErrorKind, message: impl Into<String>) -> Self {
        Self(Box::new(Inside { kind, message: message.into() }))
    }

    /// Why, in one word.
    pub fn kind(&self) -> ErrorKind {
        self.0.kind
    }

    /// What was wrong: a sentence that names the value.
    pub fn message(&self) -> &str {
        &self.0.message
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.message)
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {}", self.0.kind, self.0.message)
    }
}

impl std::error::Error for Error {}

/// The result of the call that this thread made last, with its message.
#[inline]
pub(crate) fn check(result: sys::rg_result) -> Result<()> {
    if result == sys::RG_OK { Ok(()) } else { Err(failed(result)) }
}

#[cold]
fn failed(result: sys::rg_result) -> Error {
    // SAFETY: the text belongs to this thread and holds until its next failing call.
    let message = unsafe { CStr::from_ptr(sys::rg_error_message()) };
    Error::new(ErrorKind::of(result), message.to_string_lossy())
}
