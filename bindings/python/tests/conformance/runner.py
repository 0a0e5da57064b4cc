# SPDX-License-Identifier: MIT
"""Plays a case: on each set-up of the scene's grid that it names, with one worker and with two."""

from __future__ import annotations

from typing import Any

import raygrid

from .calls import call
from .expect import EXPECTATIONS
from .script import SETUPS, Malformed, Play, known, scene_grid
from .trace import play_trace


def play_step(play: Play, step: dict[str, Any]) -> None:
    if step.get("do") == "trace":
        play_trace(play, step)
    elif step.get("do") in EXPECTATIONS:
        EXPECTATIONS[step["do"]](play, step)
    else:
        call(play, step)


def play_on(case: dict[str, Any], setup_name: str, workers: int) -> None:
    if setup_name not in SETUPS:
        raise Malformed(f"unknown set-up {setup_name!r}")
    setup = SETUPS[setup_name]
    with raygrid.Scene(workers=workers, grid=scene_grid(setup, case.get("grid"))) as scene:
        play = Play(setup, setup_name, scene, workers, costly="costly" in case["flags"])
        for number, step in enumerate(case["steps"]):
            try:
                play_step(play, step)
            except (AssertionError, raygrid.Error) as wrong:
                where = f"grid {setup_name}, {workers} workers, step {number}, {step.get('do')}"
                raise AssertionError(f"{where}: {type(wrong).__name__}: {wrong}") from wrong


def play_case(case: dict[str, Any]) -> None:
    known(case, "name note numerics flags grids grid steps")
    if unknown := set(case["flags"]) - {"costly"}:
        raise Malformed(f"unknown flags {sorted(unknown)}")
    if not case["steps"] or not case["grids"]:
        raise Malformed("no steps or no grids")
    for setup_name in case["grids"]:
        for workers in (1, 2):
            play_on(case, setup_name, workers)
