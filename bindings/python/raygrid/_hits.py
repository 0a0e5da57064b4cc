# SPDX-License-Identifier: MIT
"""What a trace found."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._arrays import F32, F64, TYPES, U32, U64
from ._raygrid import ffi, lib


class Field(NamedTuple):
    """An array of Hits: where its view is in a py_trace, the shape of a record, and which dtypes it may have.

    Arrays that the caller does not bring have the first of these.
    """

    at: int
    shape: tuple[int, ...]
    dtypes: tuple[np.dtype[Any], ...]


def at(view: str) -> int:
    return int(ffi.offsetof("py_trace", "hits", view))


FIELDS = {
    "t": Field(at("t"), (), (F64, F32)),
    "object": Field(at("object"), (), (U64,)),
    "primitive": Field(at("primitive"), (), (U32, U64)),
    "normal": Field(at("normal"), (3,), (F32, F64)),
    "uv": Field(at("u"), (2,), (F32, F64)),
    "position": Field(at("position"), (3,), (F64, F32)),
    "offset": Field(at("offset"), (), (F32, F64)),
    "cells": Field(at("cells"), (), (U32,)),
    "tests": Field(at("tests"), (), (U32,)),
}
V_AT = at("v")

# Looking these up in their modules takes longer, and calls with one ray feel it.
empty, from_buffer = np.empty, ffi.from_buffer


class Hits:
    """The closest hit of each of N rays, as arrays. Only those that were asked for are there.

    ========== ============ ======= ======================================================================
    t          (N,)         float64 distance, in lengths of the direction; inf: no hit; NaN: an invalid ray
    object     (N,)         uint64  id of the object; 0: no hit
    primitive  (N,)         uint32  number of the triangle or face; 2**32 - 1: no hit
    normal     (N, 3)       float32 geometric, outward, of length 1, world
    uv         (N, 2)       float32 barycentric weights of the triangle's second and third corner
    position   (N, 3)       float64 origin + t * direction, world, rounded once
    offset     (N,)         float32 how far to lift the origin of a next ray off the surface, along the normal
    cells      (N,)         uint32  cells of the grids that the ray looked into
    tests      (N,)         uint32  objects that the ray was tested against
    ========== ============ ======= ======================================================================

    The dtypes are those of arrays made by the call; arrays of the caller (`out=`) may be float32 or float64, and
    primitive uint64. `invalid` is the number of invalid rays.
    """

    __slots__ = ("t", "object", "primitive", "normal", "uv", "position", "offset", "cells", "tests", "invalid")

    t: NDArray[np.floating[Any]]
    object: NDArray[np.uint64]
    primitive: NDArray[np.unsignedinteger[Any]]
    normal: NDArray[np.floating[Any]]
    uv: NDArray[np.floating[Any]]
    position: NDArray[np.floating[Any]]
    offset: NDArray[np.floating[Any]]
    cells: NDArray[np.uint32]
    tests: NDArray[np.uint32]
    invalid: int

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of the arrays that are there."""
        return tuple(name for name in FIELDS if hasattr(self, name))

    if not TYPE_CHECKING:  # else a name that does not exist would be no error of types

        def __getattr__(self, name: str) -> Any:
            if name in FIELDS:
                raise AttributeError(f"{name} was not asked for: trace(..., fields=({name!r}, ...))")
            raise AttributeError(f"Hits has no {name!r}")

    def __repr__(self) -> str:
        fields = self.fields
        rays = f"{len(getattr(self, fields[0]))} rays" if fields else "no fields"
        if "object" in fields:
            rays += f", {np.count_nonzero(self.object)} hits"
        elif "t" in fields:
            rays += f", {np.count_nonzero(np.isfinite(self.t))} hits"
        return f"<raygrid.Hits: {rays}, {self.invalid} invalid; {', '.join(fields)}>"


def unknown(name: str) -> ValueError:
    return ValueError(f"{name!r} is no field of a hit; there are {', '.join(FIELDS)}")


def prepare(call: Any, count: int, fields: Iterable[str]) -> Hits:
    """Makes the arrays for `fields`, and tells the call their addresses."""
    hits = Hits()
    for name in fields:
        if name not in FIELDS:
            raise unknown(name)
        _, shape, dtypes = FIELDS[name]
        array = empty((count, *shape) if shape else count, dtypes[0])
        setattr(call, name, from_buffer(array))
        setattr(hits, name, array)
    return hits


def prepare_out(call: Any, count: int, out: Hits | Mapping[str, NDArray[Any]]) -> Hits:
    """Views the arrays that the caller brings."""
    hits = Hits()
    for name in out.fields if isinstance(out, Hits) else out:
        if name not in FIELDS:
            raise unknown(name)
        at, shape, dtypes = FIELDS[name]
        given = getattr(out, name) if isinstance(out, Hits) else out[name]
        array = _arrays.out(given, name, (count, *shape), dtypes)
        data, strides, kind = _arrays.pointer(array), array.strides, TYPES[array.dtype]
        if name == "uv":
            lib.py_output(call, at, data, strides[0], kind)
            lib.py_output(call, V_AT, data + strides[1], strides[0], kind)
        elif shape:
            lib.py_output3(call, at, data, strides[0], strides[1], kind)
        else:
            lib.py_output(call, at, data, strides[0], kind)
        setattr(hits, name, array)
    return hits
