# SPDX-License-Identifier: MIT
"""What holds for every hit, and what the script expects of each."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import raygrid

from .script import Malformed, Play, known, number, numbers, object_id, object_name, whole

if TYPE_CHECKING:
    from .trace import Batch

# Units in the last place of t that every hit is allowed, and what float normals and barycentrics are off at most.
T_ULPS = 4
NORMAL_WITHIN = WEIGHT_WITHIN = 2.0**-20


def ulp(x: Any) -> Any:
    """The distance from |x| to the next larger double; inf at the end of the range."""
    with np.errstate(over="ignore"):
        return np.where(np.isinf(x), np.inf, np.nextafter(np.abs(x), np.inf) - np.abs(x))


def near(what: str, got: float, wanted: float, within: float) -> None:
    if got != wanted and not abs(got - wanted) <= within:
        off = abs(got - wanted)
        raise AssertionError(f"{what} is {got!r}, expected {wanted!r} within {within:.3g}, off by {off:.3g}")


def check_misses(hits: raygrid.Hits, misses: np.ndarray, invalid: np.ndarray) -> None:
    t = hits.t[misses]
    assert np.array_equal(np.isnan(t), invalid[misses]), "t of misses and of invalid rays"
    assert (np.isnan(t) | (t == np.inf)).all(), "t of misses"
    assert (hits.primitive[misses] == raygrid.NO_PRIMITIVE).all(), "primitive of misses"
    assert (hits.object[misses] == raygrid.NO_OBJECT).all(), "object of misses"
    for field in ("normal", "uv", "position", "offset"):
        assert not getattr(hits, field)[misses].any(), f"{field} of misses"


def check_positions(rays: dict[str, np.ndarray], hits: raygrid.Hits, hit: np.ndarray) -> None:
    """position is origin + t * direction, rounded once: half an ulp, and what the long doubles here round."""
    wide = np.longdouble
    origin = rays["origins"][hit].astype(wide)
    way = hits.t[hit].astype(wide)[:, None] * rays["directions"][hit].astype(wide)
    right = origin + way
    own = 2 * np.finfo(wide).eps * (np.abs(origin) + np.abs(way))
    off = np.abs(hits.position[hit].astype(wide) - right)
    assert (off <= 0.5 * ulp(right.astype(np.float64)) + own).all(), "position is not origin + t * direction"


def check_hits(play: Play, batch: Batch, hit: np.ndarray) -> None:
    """What holds for every hit."""
    hits, rays = batch.first, batch.rays
    t, normal, uv = hits.t[hit], hits.normal[hit].astype(np.float64), hits.uv[hit].astype(np.float64)
    assert (np.abs((normal**2).sum(axis=1) - 1) <= 2.0**-20).all(), "length of a normal"
    assert ((t >= rays["t_min"][hit]) & (t <= rays["t_max"][hit])).all(), "t out of the ray's range"
    farthest = np.abs(hits.position[hit]).max(axis=1, initial=0)
    large = farthest > np.finfo(np.float32).max
    assert ((hits.offset[hit] >= 0) & ((hits.offset[hit] < np.inf) | large)).all(), "offset"
    assert ((uv >= 0).all(axis=1) & (uv.sum(axis=1) <= 1 + 2.0**-22)).all(), "barycentric weights"
    masks = {one: play.scene.lookup(one).mask for one in np.unique(hits.object[hit])}
    for one, mask in zip(hits.object[hit], rays["mask"][hit], strict=True):
        assert masks[one] & int(mask), f"hit of {object_name(play, one)}, which the ray doesn't see"
    check_positions(rays, hits, hit)


def check_vectors(batch: Batch, i: int, expected: dict[str, Any], t_within: float) -> None:
    hits, ray = batch.first, batch.records[i]
    if "normal" in expected:
        within = number(expected.get("normal_within", NORMAL_WITHIN))
        for got, wanted in zip(hits.normal[i], numbers(expected["normal"], 3), strict=True):
            near("normal", float(got), wanted, within)
    if "position" in expected:
        for a, wanted in enumerate(numbers(expected["position"], 3)):
            largest = max(abs(wanted), abs(float(ray["origin"][a])))
            within = t_within * abs(float(ray["direction"][a])) + 2 * float(ulp(largest))
            near("position", float(hits.position[i, a]), wanted, within)


def check_expected(play: Play, batch: Batch, i: int, expected: dict[str, Any]) -> None:
    known(expected, "object t within primitive normal normal_within u v position cells_max tests")
    if "object" not in expected:
        raise Malformed("no object is expected, not even null")
    hits = batch.first
    wanted = expected["object"] if isinstance(expected["object"], list) else [expected["object"]]
    ids = [raygrid.NO_OBJECT if one is None else object_id(play, one) for one in wanted]
    got = hits.object[i]
    if got not in ids:
        raise AssertionError(f"hit {object_name(play, got)} at {hits.t[i]!r}, expected {wanted}")
    if "cells_max" in expected:
        assert hits.cells[i] <= whole(expected["cells_max"], 2**32 - 1), f"looked into {hits.cells[i]} cells"
    if "tests" in expected:
        assert hits.tests[i] == whole(expected["tests"], 2**32 - 1), f"tested {hits.tests[i]} objects"
    if got == raygrid.NO_OBJECT:
        return
    if "primitive" in expected:
        any_of = expected["primitive"] if isinstance(expected["primitive"], list) else [expected["primitive"]]
        assert hits.primitive[i] in any_of, f"primitive is {hits.primitive[i]}, expected {any_of}"
    t = float(hits.t[i])
    wanted_t = number(expected.get("t", t))
    within = T_ULPS * float(ulp(wanted_t)) + number(expected.get("within", 0))
    near("t", t, wanted_t, within)
    for name, value in (("u", hits.uv[i, 0]), ("v", hits.uv[i, 1])):
        near(name, float(value), number(expected.get(name, float(value))), WEIGHT_WITHIN)
    check_vectors(batch, i, expected, within)


def with_script(play: Play, batch: Batch) -> None:
    hits = batch.first
    invalid = np.zeros(len(batch), bool)
    for i, line in enumerate(batch.lines):
        expected = line.get("hit", "missing")
        if expected == "invalid":
            invalid[i] = True
            assert not hits.cells[i] and not hits.tests[i], f"ray {i}: an invalid ray looked into cells"
        elif expected is None:
            assert hits.object[i] == raygrid.NO_OBJECT, f"ray {i}: hit {object_name(play, hits.object[i])}"
        elif isinstance(expected, dict):
            try:
                check_expected(play, batch, i, expected)
            except AssertionError as wrong:
                raise AssertionError(f"ray {i}: {wrong}") from None
        else:
            raise Malformed(f"ray {i} has no hit")
    hit = hits.object != raygrid.NO_OBJECT
    check_misses(hits, ~hit, invalid)
    check_hits(play, batch, hit)
