# SPDX-License-Identifier: MIT
"""Trace steps: their rays, all the ways to trace them from Python, and that these give the same bits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import raygrid

from . import compare
from .script import Play, known, number, numbers, whole

ALL = ("t", "object", "primitive", "normal", "uv", "position", "offset", "cells", "tests")
# What does not depend on how rays are grouped.
SAME = ALL[:-2]
# A batch of so many rays is large enough to be spread over workers.
MANY_RAYS = 4096

RAY = np.dtype(
    [("origin", "f8", 3), ("direction", "f8", 3), ("t_min", "f8"), ("t_max", "f8"), ("mask", "u4"), ("", "u4")]
)
HIT = np.dtype(
    [
        ("t", "f8"),
        ("object", "u8"),
        ("position", "f8", 3),
        ("normal", "f4", 3),
        ("offset", "f4"),
        ("uv", "f4", 2),
        ("primitive", "u4"),
        ("", "u4"),
    ]
)


def arguments(records: np.ndarray) -> dict[str, np.ndarray]:
    """The arguments of trace, as views of the fields of records."""
    names = {"origin": "origins", "direction": "directions", "t_min": "t_min", "t_max": "t_max", "mask": "mask"}
    return {argument: records[field] for field, argument in names.items()}


class Batch:
    """The rays of a trace step."""

    def __init__(self, step: dict[str, Any]) -> None:
        self.lines = step["rays"]
        self.respawn = step.get("respawn", [])
        self.cull = raygrid.Cull.NONE
        if "cull" in step:
            cull = step["cull"]
            self.cull = raygrid.Cull[cull.upper()] if isinstance(cull, str) else cull
        self.records = np.zeros(len(self.lines), RAY)
        for line, record in zip(self.lines, self.records, strict=True):
            known(line, "origin direction t_min t_max mask hit")
            record["origin"], record["direction"] = numbers(line["origin"], 3), numbers(line["direction"], 3)
            record["t_min"], record["t_max"] = number(line.get("t_min", 0)), number(line.get("t_max", "inf"))
            record["mask"] = whole(line.get("mask", 2**32 - 1), 2**32 - 1)
        self.invalid = sum(line.get("hit") == "invalid" for line in self.lines)
        self.rays = {name: np.ascontiguousarray(array) for name, array in arguments(self.records).items()}
        self.first: raygrid.Hits

    def __len__(self) -> int:
        return len(self.lines)


def same(wanted: raygrid.Hits, got: Any, name: str, fields: tuple[str, ...] = SAME) -> None:
    for field in fields:
        a = np.asarray(getattr(wanted, field))
        b = np.asarray(getattr(got, field) if isinstance(got, raygrid.Hits) else got[field])
        if not np.array_equal(a, b, equal_nan=a.dtype.kind == "f"):
            ray = np.flatnonzero(((a != b) & ((a == a) | (b == b))).reshape(len(a), -1).any(axis=1))[0]
            raise AssertionError(f"{name}: ray {ray}: {field} is {b[ray]!r}, by the first way {a[ray]!r}")


def garbage(count: int) -> np.ndarray:
    """Room for hits in which what is not written does not look like a hit."""
    return np.frombuffer(b"\xa5" * (HIT.itemsize * max(count, 1)), HIT).copy()[:count]


def fields_of(hits: np.ndarray) -> dict[str, np.ndarray]:
    return {field: hits[field] for field in SAME}


# ------------------------------------------------------------------------------------------ ways to trace


def one_by_one(play: Play, batch: Batch) -> np.ndarray:
    out = garbage(len(batch))
    for i in range(len(batch)):
        rays = {name: array[i] for name, array in batch.rays.items()}
        play.scene.trace(**rays, cull=batch.cull, out=fields_of(out[i : i + 1]))
    return out


def records(play: Play, batch: Batch) -> np.ndarray:
    out = garbage(len(batch))
    play.scene.trace(**arguments(batch.records), cull=batch.cull, out=fields_of(out))
    return out


def backward(play: Play, batch: Batch) -> np.ndarray:
    out = garbage(len(batch))
    play.scene.trace(**arguments(batch.records[::-1]), cull=batch.cull, out=fields_of(out[::-1]))
    return out


def columns(play: Play, batch: Batch) -> raygrid.Hits:
    """Each component in an array of its own."""
    rays = {name: np.asfortranarray(array) for name, array in batch.rays.items()}
    return play.scene.trace(**rays, cull=batch.cull, fields=SAME)


def filtered(play: Play, batch: Batch) -> raygrid.Hits:
    return play.scene.trace(**batch.rays, cull=batch.cull, filter=accept_all(batch), fields=SAME)


def accept_all(batch: Batch) -> Callable[[int, raygrid.Candidate], bool]:
    def accept(index: int, hit: raygrid.Candidate) -> bool:
        ray = batch.records[index]
        assert ray["t_min"] <= hit.t <= ray["t_max"]
        assert hit.object != raygrid.NO_OBJECT and hit.primitive != raygrid.NO_PRIMITIVE
        return True

    return accept


def floats(play: Play, batch: Batch) -> None:
    """Floats in and out, if all numbers of the rays are floats."""
    with np.errstate(over="ignore"):
        rays = {name: a.astype(np.float32) if a.dtype.kind == "f" else a for name, a in batch.rays.items()}
        if not all(np.array_equal(rays[name], a, equal_nan=a.dtype.kind == "f") for name, a in batch.rays.items()):
            return
        wanted = {name: getattr(batch.first, name) for name in SAME}
        wanted |= {name: wanted[name].astype(np.float32) for name in ("t", "position")}
    got = play.scene.trace(**rays, cull=batch.cull, out={name: np.empty_like(a) for name, a in wanted.items()})
    for name, array in wanted.items():
        assert np.array_equal(array, getattr(got, name), equal_nan=array.dtype.kind == "f"), f"floats: {name}"


def shared(play: Play, batch: Batch) -> None:
    """One ray's values for all records, where they are all the same."""
    rays = dict(batch.rays)
    for name, array in batch.rays.items():
        if len(array) and (array == array[0]).all():
            rays[name] = array[0]
    if any(array.shape[:1] == (len(batch),) and array is batch.rays[name] for name, array in rays.items()):
        same(batch.first, play.scene.trace(**rays, cull=batch.cull, fields=SAME), "shared")


def occluded(play: Play, batch: Batch) -> None:
    wanted = batch.first.object != raygrid.NO_OBJECT
    out = np.full(3 * len(batch), 0x5A, np.uint8)[::-3]
    ways = {
        "new": play.scene.occluded(**batch.rays, cull=batch.cull),
        "backward": play.scene.occluded(**arguments(batch.records[::-1]), cull=batch.cull, out=out)[::-1],
    }
    if not play.costly:
        ways["filtered"] = play.scene.occluded(**batch.rays, cull=batch.cull, filter=accept_all(batch))
    for name, got in ways.items():
        assert np.array_equal(got, wanted), f"occluded, {name}: {np.flatnonzero(got != wanted)}"


def many(play: Play, batch: Batch) -> None:
    """The batch again and again in one call: copies far apart are traced by different workers."""
    copies = MANY_RAYS // len(batch) + 1
    rays = {name: np.concatenate([array] * copies) for name, array in batch.rays.items()}
    hits = play.scene.trace(**rays, cull=batch.cull, fields=SAME)
    assert hits.invalid == batch.invalid * copies
    for field in SAME:
        wanted, got = getattr(batch.first, field), getattr(hits, field)
        got = got.reshape(copies, *wanted.shape)
        assert np.array_equal(np.broadcast_to(wanted, got.shape), got, equal_nan=got.dtype.kind == "f"), (
            f"many: {field}"
        )


def respawn(play: Play, batch: Batch) -> None:
    """From each hit a ray in each direction of "respawn", moved by the offset, must not hit the same object."""
    first = batch.first
    hit = first.object != raygrid.NO_OBJECT
    normals, positions = first.normal[hit].astype(np.float64), first.position[hit]
    for value in batch.respawn:
        directions = np.broadcast_to(np.array(numbers(value, 3)), normals.shape).copy()
        rays = np.einsum("ij,ij->i", batch.rays["directions"][hit], normals)
        directions[rays * np.einsum("ij,ij->i", directions, normals) > 0] *= -1
        along = np.einsum("ij,ij->i", directions, normals)
        origins = positions + np.copysign(first.offset[hit].astype(np.float64), along)[:, None] * normals
        again = play.scene.trace(origins, directions)
        assert not (again.object == first.object[hit]).any(), f"respawn {value}: hits the same object again"


def play_trace(play: Play, step: dict[str, Any]) -> None:
    known(step, "do rays cull respawn")
    batch = Batch(step)
    if play.setup.rebuilt:
        play.scene.grid.rebuild()
    batch.first = play.scene.trace(**batch.rays, cull=batch.cull, fields=ALL)
    assert batch.first.invalid == batch.invalid
    compare.with_script(play, batch)
    ways = (one_by_one, records, backward, columns)
    for way in ways if play.costly else (*ways, filtered):  # a million candidates take Python seconds
        before = play.scene.stats().invalid_rays
        same(batch.first, way(play, batch), way.__name__)
        assert play.scene.stats().invalid_rays - before == batch.invalid, f"{way.__name__}: invalid rays"
    floats(play, batch)
    if len(batch):
        shared(play, batch)
        occluded(play, batch)
    if len(batch) and play.workers > 1 and not play.costly:
        many(play, batch)
    respawn(play, batch)
    play.last = batch


def trace_again(play: Play) -> None:
    """Traces the last step's rays again: everything must be as it was."""
    if play.last is not None:
        batch = play.last
        same(batch.first, play.scene.trace(**batch.rays, cull=batch.cull, fields=ALL), "again after the error", ALL)
