# SPDX-License-Identifier: MIT
"""The examples and the benchmark run; one process and several see the same traffic."""

from __future__ import annotations

import json
import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

EXAMPLES = pathlib.Path(__file__).parents[3] / "examples" / "python"
SMALL = ["--frames", "2", "--cars", "500", "--rays", "12800"]


def run(name: str, *options: str, cwd: pathlib.Path) -> str:
    command = [sys.executable, "-W", "error::RuntimeWarning", str(EXAMPLES / name), *options]
    environment = os.environ | {"TMPDIR": str(cwd)}
    done = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def points() -> int:
    """How many points the small turns see."""
    sys.path.insert(0, str(EXAMPLES))
    try:
        import traffic
    finally:
        sys.path.remove(str(EXAMPLES))
    world = traffic.Traffic(500)
    lidar = traffic.Lidar(world, 12800)
    seen = 0
    for frame in range(2):
        for sector in range(traffic.SECTORS):
            now = traffic.sector_time(frame, sector)
            world.move(now)
            hits = world.scene.trace(lidar.origin(now), lidar.directions(sector), t_max=traffic.RANGE)
            seen += int(np.isfinite(hits.t).sum())
    return seen


def test_lidar(points: int, tmp_path: pathlib.Path) -> None:
    output = run("lidar.py", *SMALL, cwd=tmp_path)
    rates = re.search(r"([\d.]+) million moves a second, ([\d.]+) million rays a second, (\d+)% of them hit", output)
    assert rates and float(rates[1]) > 0 and float(rates[2]) > 0
    assert abs(int(rates[3]) - 100 * points / 25600) <= 1
    assert (tmp_path / "out/python/lidar.gif").read_bytes()[:6] in (b"GIF87a", b"GIF89a")


def test_lidar_over_processes(points: int, tmp_path: pathlib.Path) -> None:
    output = run("lidar_dask.py", *SMALL, cwd=tmp_path)
    assert re.search(rf"^25600 rays in .* {points} points$", output, re.MULTILINE), output


def test_walkthrough(tmp_path: pathlib.Path) -> None:
    output = run("walkthrough.py", "--width", "80", cwd=tmp_path)
    assert "refused: " in output and "seen from [" in output
    pictures = sorted((tmp_path / "out/python").glob("walkthrough-*.png"))
    assert len(pictures) == 4 and len({picture.read_bytes() for picture in pictures}) == 4


def test_benchmark(tmp_path: pathlib.Path) -> None:
    bench = pathlib.Path(__file__).parents[1] / "bench" / "bench.py"
    run(str(bench), "--quick", "--json", "figures.json", cwd=tmp_path)
    figures = json.loads((tmp_path / "figures.json").read_text())
    assert all(row["error"] == 0 for row in figures["single"])
    assert figures["batches"] and figures["frames"][0]["engine"] == "raygrid"
    assert all(row["judged"] > 400 and not row["wrong"] for row in [*figures["batches"], figures["frames"][0]])
