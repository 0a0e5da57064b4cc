# SPDX-License-Identifier: MIT
"""What the library refuses, as exceptions."""

from __future__ import annotations

from ._raygrid import ffi, lib


class Error(Exception):
    """The library refused a call; nothing has changed. The message names the value that was wrong."""


class InvalidArgument(Error, ValueError):
    """RG_INVALID_ARGUMENT: a value that is none of an enumeration, or something required is missing."""


class InvalidValue(Error, ValueError):
    """RG_INVALID_VALUE: a number is NaN, infinite or out of its range; a pose is singular; an index has no vertex."""


class InvalidId(Error, LookupError):
    """RG_INVALID_ID: the id of an object or grid is stale, of another scene, or was never given out."""


class LimitExceeded(Error, OverflowError):
    """RG_LIMIT_EXCEEDED: a count is beyond what the library can address."""


class OutOfMemory(Error, MemoryError):
    """RG_OUT_OF_MEMORY: there is no memory left."""


class OutOfThreads(Error, RuntimeError):
    """RG_OUT_OF_THREADS: the system refused to start a worker."""


class Busy(Error, RuntimeError):
    """RG_BUSY: the call would change a scene from inside a callback of that scene, or destroy what is in use."""


class CallbackFailed(Error, RuntimeError):
    """RG_CALLBACK_FAILED: a callback raised; its exception is the cause of this one."""


class InvalidData(Error, ValueError):
    """RG_INVALID_DATA: a snapshot or recording is damaged, of another version, or not what the call takes."""


ERRORS: dict[int, type[Error]] = {
    lib.RG_INVALID_ARGUMENT: InvalidArgument,
    lib.RG_INVALID_VALUE: InvalidValue,
    lib.RG_INVALID_ID: InvalidId,
    lib.RG_LIMIT_EXCEEDED: LimitExceeded,
    lib.RG_OUT_OF_MEMORY: OutOfMemory,
    lib.RG_OUT_OF_THREADS: OutOfThreads,
    lib.RG_BUSY: Busy,
    lib.RG_CALLBACK_FAILED: CallbackFailed,
    lib.RG_INVALID_DATA: InvalidData,
}


def error(result: int) -> Error:
    """The exception for a result other than RG_OK of the call that this thread made last."""
    return ERRORS.get(result, Error)(ffi.string(lib.rg_error_message()).decode(errors="replace"))


def check(result: int) -> None:
    """Raises if `result` is not RG_OK."""
    if result:
        raise error(result)
