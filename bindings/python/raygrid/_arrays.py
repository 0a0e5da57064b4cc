# SPDX-License-Identifier: MIT
"""NumPy arrays as the library's views: where they lie, in the type that they have, with their strides.

Arrays of float32 or float64 (integers: see each function) in the machine's byte order are read and written in place.
Anything else, lists and scalars among it, is first made such an array.

The functions here return the array that is read, to be kept until the call is over; how many records it has, None for
one record that serves all; and what they give to a view.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._raygrid import ffi, lib

F32, F64 = np.dtype(np.float32), np.dtype(np.float64)
U8, U32, U64, BOOL = np.dtype(np.uint8), np.dtype(np.uint32), np.dtype(np.uint64), np.dtype(np.bool_)

TYPES: dict[Any, int] = {
    F64: lib.RG_F64,
    F32: lib.RG_F32,
    U8: lib.RG_U8,
    BOOL: lib.RG_U8,
    np.dtype(np.uint16): lib.RG_U16,
    U32: lib.RG_U32,
    U64: lib.RG_U64,
}

from_buffer = ffi.from_buffer  # looking it up in ffi takes longer than in a module

# Array, count, pointer, step, type.
Numbers = tuple[NDArray[Any], int | None, Any, int, int]
# Array, count, pointer, step, component, type.
Vectors = tuple[NDArray[Any], int | None, Any, int, int, int]


def seen(array: NDArray[Any]) -> str:
    """What a message says of an array that does not fit."""
    return f"shape {array.shape} of {array.dtype}"


def pointer(array: NDArray[Any]) -> Any:
    """The address of the first element."""
    if array.flags.c_contiguous:
        return ffi.from_buffer(array)
    return ffi.cast("char *", array.__array_interface__["data"][0])


def aligned_native(array: NDArray[Any]) -> NDArray[Any]:
    """The array, or a copy if its byte order or alignment is not the machine's."""
    return np.require(array, dtype=array.dtype.newbyteorder("="), requirements="A")


def floats(value: ArrayLike, name: str) -> NDArray[Any]:
    """`value` itself if it is an array of float32 or float64, else what it says as float64."""
    array = np.asarray(value)
    if array.dtype.kind in "iub" or (array.dtype.kind == "f" and array.dtype.itemsize not in (4, 8)):
        return array.astype(F64)
    if array.dtype.kind != "f":
        raise TypeError(f"{name} must be numbers, not {seen(array)}")
    return aligned_native(array)


def vectors(value: ArrayLike, name: str) -> Vectors:
    """Three floats a record: of the shape (3,), for all records, or (N, 3)."""
    # Calls with one ray take longest here: so what an array is asked for is asked once, and the usual case first.
    array = value if type(value) is np.ndarray else floats(value, name)
    dtype, flags = array.dtype, array.flags
    if not ((dtype is F64 or dtype is F32) and flags.aligned):
        array = floats(array, name)
        dtype, flags = array.dtype, array.flags
    data = from_buffer(array) if flags.c_contiguous else pointer(array)
    shape, strides = array.shape, array.strides
    if len(shape) == 2 and shape[1] == 3:
        if shape[0] == 1:
            return array, None, data, 0, strides[1], TYPES[dtype]
        return array, shape[0], data, strides[0], strides[1], TYPES[dtype]
    if len(shape) == 1 and shape[0] == 3:
        return array, None, data, 0, strides[0], TYPES[dtype]
    raise ValueError(f"{name} must have the shape (3,) or (N, 3), not {seen(array)}")


def one_a_record(array: NDArray[Any], name: str) -> Numbers:
    if array.ndim == 1 and array.shape[0] != 1:
        return array, array.shape[0], pointer(array), array.strides[0], TYPES[array.dtype]
    if array.ndim < 2:
        return array, None, pointer(array), 0, TYPES[array.dtype]
    raise ValueError(f"{name} must be a number or have the shape (N,), not {seen(array)}")


def matrices(value: ArrayLike, name: str) -> tuple[NDArray[Any], int | None, list[tuple[Any, int, int, int]]]:
    """Three by three floats a record, by rows: of the shape (3, 3), for all records, or (N, 3, 3).

    Returns the array, the count, and for each column what it gives to a view.
    """
    array = floats(value, name)
    if array.shape[-2:] != (3, 3) or array.ndim > 3:
        raise ValueError(f"{name} must have the shape (3, 3) or (N, 3, 3), not {seen(array)}")
    one = array.ndim == 2 or array.shape[0] == 1
    columns = [
        (
            pointer(array) + column * array.strides[-1],
            0 if one else array.strides[0],
            array.strides[-2],
            TYPES[array.dtype],
        )
        for column in range(3)
    ]
    return array, None if one else array.shape[0], columns


def numbers(value: ArrayLike, name: str) -> Numbers:
    """A float a record: a number, for all records, or of the shape (N,)."""
    return one_a_record(floats(value, name), name)


def unsigned(value: ArrayLike, name: str, dtypes: Iterable[np.dtype[Any]]) -> NDArray[Any]:
    """Whole numbers as an array of one of the types `dtypes`; in place if they are, and if only the sign bit differs.

    Else they become the last of `dtypes`.
    """
    array = np.asarray(value)
    dtypes = tuple(dtypes)
    if array.size == 0 and not isinstance(value, np.ndarray):
        array = array.astype(dtypes[-1])
    if array.dtype.kind == "O":  # Python's own integers beyond 64 bits
        raise OverflowError(f"{name} has numbers that {dtypes[-1]} can't hold")
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} must be whole numbers, not {seen(array)}")
    array = aligned_native(array)
    if array.dtype in dtypes:
        return array
    if array.size and array.dtype.kind == "i" and array.min() < 0:
        raise ValueError(f"{name} has negative numbers, the least {array.min()}")
    as_unsigned = np.dtype(f"u{array.dtype.itemsize}")
    if as_unsigned in dtypes:
        return array.view(as_unsigned)
    if array.size and array.max() > np.iinfo(dtypes[-1]).max:
        raise OverflowError(f"{name} has numbers that {dtypes[-1]} can't hold, the largest {array.max()}")
    return array.astype(dtypes[-1])


def unsigned_numbers(value: ArrayLike, name: str, dtype: np.dtype[Any]) -> Numbers:
    """A whole number a record: one for all records, or of the shape (N,)."""
    return one_a_record(unsigned(value, name, (dtype,)), name)


def out(array: object, name: str, shape: tuple[int, ...], dtypes: tuple[np.dtype[Any], ...]) -> NDArray[Any]:
    """`array`, which results are to be written to, if they can be."""
    if not isinstance(array, np.ndarray):
        raise TypeError(f"out {name} must be a NumPy array, not {type(array).__name__}")
    if array.shape != shape or array.dtype not in dtypes:
        wanted = " or ".join(str(dtype) for dtype in dtypes)
        raise ValueError(f"out {name} must have the shape {shape} of {wanted}, not {seen(array)}")
    if not (array.flags.writeable and array.flags.aligned):
        raise ValueError(f"out {name} must be writable and aligned")
    return array


def count_of(**counts: int | None) -> int:
    """How many records a call has: what all its arrays agree on, 1 if each gives one for all."""
    agreed = None
    for name, count in counts.items():
        if count is None:
            continue
        if agreed is None:
            first, agreed = name, count
        elif count != agreed:
            raise ValueError(f"{name} has {count} records, {first} has {agreed}")
    return 1 if agreed is None else agreed
