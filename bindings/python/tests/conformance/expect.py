# SPDX-License-Identifier: MIT
"""The steps of a script that are expectations of reports and of errors."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

import raygrid

from .calls import call
from .script import Malformed, Play, grid_of, known, numbers, object_id, whole
from .trace import trace_again

Step = dict[str, Any]

GRID_COUNTS = ("levels", "levels_used", "objects", "entries", "unbounded", "tiles", "rebuilds")
ERRORS = {
    "RG_INVALID_ARGUMENT": raygrid.InvalidArgument,
    "RG_INVALID_VALUE": raygrid.InvalidValue,
    "RG_INVALID_ID": raygrid.InvalidId,
    "RG_LIMIT_EXCEEDED": raygrid.LimitExceeded,
    "RG_BUSY": raygrid.Busy,
}


def count(step: Step, key: str, got: int) -> None:
    if key not in step:
        return
    wanted = step[key]
    if isinstance(wanted, dict):
        known(wanted, "min max")
        least, most = wanted.get("min", 0), wanted.get("max", 2**64 - 1)
    else:
        least = most = whole(wanted, 2**63 - 1)
    assert least <= got <= most, f"{key} is {got}, expected {least} to {most}"


def doubles(step: Step, key: str, got: np.ndarray) -> None:
    if key in step:
        wanted = numbers(step[key], got.size)
        assert got.ravel().tolist() == wanted, f"{key} is {got.tolist()}, expected {wanted}"


def contains(step: Step, key: str, lo: np.ndarray, hi: np.ndarray) -> None:
    for point in step.get(key, []):
        p = np.array(numbers(point, 3))
        assert ((lo <= p) & (p <= hi)).all(), f"{key}: {p} is not from {lo} to {hi}"


def expect_grid(play: Play, step: Step) -> None:
    boxes = "physical_lo physical_hi physical_contains logical_contains"
    known(step, f"do grid on kind resolution {boxes} {' '.join(GRID_COUNTS)}")
    if play.setup_name not in step.get("on", [play.setup_name]):
        return
    report = grid_of(play, step["grid"]).stats()
    if "kind" in step:
        assert report.kind == raygrid.GridKind[step["kind"].upper()], f"kind is {report.kind!r}"
    if "resolution" in step:
        assert list(report.resolution) == step["resolution"], f"resolution is {report.resolution}"
    for name in GRID_COUNTS:
        count(step, name, getattr(report, name))
    doubles(step, "physical_lo", report.physical_lo)
    doubles(step, "physical_hi", report.physical_hi)
    contains(step, "physical_contains", report.physical_lo, report.physical_hi)
    contains(step, "logical_contains", report.logical_lo, report.logical_hi)


def expect_object(play: Play, step: Step) -> None:
    known(step, "do object position linear mask grid contains slot generation")
    one = object_id(play, step["object"])
    report = play.scene.lookup(one)
    doubles(step, "position", report.position)
    doubles(step, "linear", report.linear)
    contains(step, "contains", report.lo, report.hi)
    count(step, "mask", report.mask)
    count(step, "slot", int(one) & 0xFFFFFFFF)
    count(step, "generation", int(one) >> 32)
    if "grid" in step:
        assert report.grid == grid_of(play, step["grid"]), "it is in another grid"


def expect_scene(play: Play, step: Step) -> None:
    known(step, "do objects slots grids")
    report = play.scene.stats()
    for name in ("objects", "slots", "grids"):
        count(step, name, getattr(report, name))


def state(play: Play) -> list[Any]:
    """What must not change when a call fails."""
    grid = dataclasses.astuple(play.scene.grid.stats())
    return [play.scene.stats(), *(item.tolist() if isinstance(item, np.ndarray) else item for item in grid)]


def expect_error(play: Play, step: Step) -> None:
    known(step, "do result message call")
    if step["result"] not in ERRORS:
        raise Malformed(f"{step['result']!r} is no error")
    before = state(play)
    try:
        call(play, step["call"])
    except raygrid.Error as error:
        assert type(error) is ERRORS[step["result"]], f"{type(error).__name__}: {error}, expected {step['result']}"
        assert step["message"] in str(error), f"the message {str(error)!r} has no {step['message']!r}"
    else:
        raise AssertionError(f"{step['call']} succeeded")
    assert state(play) == before, "the failed call changed something"
    trace_again(play)


EXPECTATIONS = {
    "expect_error": expect_error,
    "expect_grid": expect_grid,
    "expect_object": expect_object,
    "expect_scene": expect_scene,
}
