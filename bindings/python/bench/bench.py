# SPDX-License-Identifier: MIT
"""What calls from Python cost, with the error beside it; see README.md. All times are medians of several rounds."""

from __future__ import annotations

import argparse
import json
import pathlib
import time
import timeit
from collections.abc import Callable
from typing import Any

import numpy as np

import raygrid
from raygrid._raygrid import ffi, lib

from engines import installed
from scenes import Cubes

SAMPLE = 500  # rays of which errors are known


def seconds(call: Callable[[], object]) -> float:
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


def medians(rounds: int, *calls: Callable[[], object]) -> list[float]:
    """The median seconds of each call, their rounds interleaved, so that a busy machine is busy for all."""
    for call in calls:
        call()
    return np.median([[seconds(call) for call in calls] for _ in range(rounds)], axis=0).tolist()


def single_rays(options: argparse.Namespace) -> list[dict[str, Any]]:
    """A call with one ray: nanoseconds from Python, and of the same trace from C."""
    rows = []
    with raygrid.Scene(workers=1) as scene:
        scene.insert(raygrid.Sphere(), (0, 0, 5))
        origin, direction = np.zeros(3), np.array([0.0, 0, 1])
        ray, hit = ffi.new("rg_ray *"), ffi.new("rg_hit *")
        ray[0] = lib.rg_ray_from([0, 0, 0], [0, 0, 1])
        calls = {
            "trace, t and object": lambda: scene.trace(origin, direction),
            "trace, t": lambda: scene.trace(origin, direction, fields=("t",)),
            "trace of lists": lambda: scene.trace([0, 0, 0], [0, 0, 1]),
            "occluded": lambda: scene.occluded(origin, direction),
        }
        number = 2000 if options.quick else 20000
        bare = (
            min(timeit.repeat(lambda: lib.rg_scene_trace(scene._handle, ray, hit, 1), number=number, repeat=7))
            / number
        )
        for name, call in calls.items():
            took = min(timeit.repeat(call, number=number, repeat=7)) / number
            error = abs(float(scene.trace(origin, direction).t[0]) - 4)
            rows.append({"call": name, "python_ns": took * 1e9, "c_ns": bare * 1e9, "error": error})
    for row in rows:
        print(
            f"{row['call']:<24}{row['python_ns']:8.0f} ns, from C {row['c_ns']:5.0f} ns: "
            f"{row['python_ns'] - row['c_ns']:6.0f} ns more; error of t {row['error']:.1g}"
        )
    return rows


def from_c(scene: raygrid.Scene, cubes: Cubes) -> Callable[[], object]:
    """The same trace as Python's, with all arrays and views ready."""
    call = ffi.new("py_trace *")
    out = np.empty(len(cubes.origins)), np.empty(len(cubes.origins), np.uint64)
    call.t, call.object = (ffi.from_buffer(array) for array in out)
    views = []
    for array in (cubes.origins, cubes.directions):
        views += [ffi.from_buffer(array), 24, 8, lib.RG_F64]
    return lambda: (out, lib.py_scene_trace(scene._handle, call, 0, len(cubes.origins), *views))


def batches(options: argparse.Namespace) -> list[dict[str, Any]]:
    """Rays a second from NumPy arrays, beside the same from C."""
    rows = []
    cubes = Cubes(10_000 if options.quick else 100_000, 100_000 if options.quick else 1_000_000)
    every = cubes.origins, cubes.directions
    with raygrid.Scene(workers=options.workers) as scene:
        half = np.full(3, cubes.side / 2)
        ids = scene.insert(raygrid.Box(-half, half), cubes.centers)
        for count in (1_000, 10_000, 100_000, 1_000_000):
            if count > len(every[0]):
                continue
            cubes.origins, cubes.directions = every[0][:count], every[1][:count]
            rounds = max(5, min(301, 2_000_000 // count))
            python, c = medians(rounds, lambda: scene.trace(cubes.origins, cubes.directions), from_c(scene, cubes))
            hits = scene.trace(cubes.origins, cubes.directions)
            hit = np.where(hits.object, (hits.object - ids[0]).astype(np.int64), -1)  # ids of new scenes are in a row
            judged, wrong, worst = cubes.judge(hits.t, hit, SAMPLE)
            rows.append(
                {
                    "rays": count,
                    "python": count / python,
                    "c": count / c,
                    "share": c / python,
                    "judged": judged,
                    "wrong": wrong,
                    "t_error": worst,
                }
            )
            print(
                f"{count:>9} rays: {count / python / 1e6:6.2f} Mrays/s from NumPy, {count / c / 1e6:6.2f} from C: "
                f"{c / python:6.1%}; {wrong} of {judged} wrong, t off by at most {worst:.1g} of a side"
            )
    return rows


def frames(options: argparse.Namespace) -> list[dict[str, Any]]:
    """1 % of the cubes move, then all rays are traced: milliseconds, for each engine that is installed."""
    rows = []
    count, rays = (2_000, 5_000) if options.quick else (options.objects, 100_000)
    for engine in installed():
        cubes = Cubes(count, rays)
        holder: list[Any] = []
        made = seconds(lambda: holder.append(engine(cubes, options.workers)))
        (one,) = holder
        updates, traces = [], []
        for _ in range(3 if options.quick else 5):
            moved = cubes.move()
            updates.append(seconds(lambda: one.update(cubes, moved)))
            traces.append(seconds(lambda: holder.append(one.trace(cubes))))
        judged, wrong, worst = cubes.judge(*one.answer(cubes, holder[-1]), SAMPLE)
        update, trace = float(np.median(updates)), float(np.median(traces))
        rows.append(
            {
                "engine": engine.name,
                "objects": count,
                "rays": rays,
                "make": made,
                "update": update,
                "trace": trace,
                "judged": judged,
                "wrong": wrong,
                "t_error": worst,
            }
        )
        times = (update + trace) / (rows[0]["update"] + rows[0]["trace"])
        print(
            f"{engine.name:<12} {count} objects made in {made * 1e3:9.1f} ms; 1 % moved {update * 1e3:9.2f} ms, "
            f"{rays} rays {trace * 1e3:8.2f} ms: {times:6.1f} times raygrid; "
            f"{wrong} of {judged} wrong, t off by at most {worst:.1g} of a side"
        )
    return rows


PARTS = {"single": single_rays, "batches": batches, "frames": frames}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="small scenes, few rounds")
    parser.add_argument("--only", choices=PARTS, help="this part alone")
    parser.add_argument("--workers", type=int, default=1, help="threads of raygrid and pybullet; 0: one a processor")
    parser.add_argument("--objects", type=int, default=100_000, help="of the frames")
    parser.add_argument("--json", type=pathlib.Path, help="file for all figures")
    options = parser.parse_args()
    print(f"raygrid {raygrid.__version__}, NumPy {np.__version__}, workers: {options.workers or 'one a processor'}")
    found = {name: part(options) for name, part in PARTS.items() if options.only in (None, name)}
    if options.json:
        options.json.write_text(json.dumps(found, indent=1))
    if any(row.get("wrong", 0) for row in found.get("batches", []) + found.get("frames", [])[:1]):
        raise SystemExit("raygrid hit wrongly")


if __name__ == "__main__":
    main()
