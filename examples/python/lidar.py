# SPDX-License-Identifier: MIT
"""A lidar drives through moving traffic: 10^4 cars, 10^6 rays a turn. Writes an animation, prints the rates.

A turn takes a tenth of a second, in which cars drive on by a metre or two. So they move ten times a turn, between its
sectors, as a real lidar sees it: the scene is changed as a whole, and the very next ray sees it.
"""

from __future__ import annotations

import argparse
import pathlib
import time
from dataclasses import dataclass

import matplotlib

matplotlib.use("Agg")
import matplotlib.animation
import matplotlib.pyplot as plt
import numpy as np
from tqdm import tqdm

from traffic import RANGE, SECTORS, Floats, Lidar, Traffic, sector_time

SHOWN = 20_000  # points of a turn that are drawn


@dataclass
class Rates:
    """Seconds spent, and on how much."""

    moving: float = 0
    tracing: float = 0
    moves: int = 0
    rays: int = 0
    hits: int = 0

    def __str__(self) -> str:
        return (
            f"{self.moves / self.moving / 1e6:.2f} million moves a second, "
            f"{self.rays / self.tracing / 1e6:.2f} million rays a second, {self.hits / self.rays:.0%} of them hit"
        )


def turn(traffic: Traffic, lidar: Lidar, frame: int, rates: Rates) -> Floats:
    """All points that one turn of the lidar sees, (H, 3)."""
    points = []
    for sector in range(SECTORS):
        now = sector_time(frame, sector)
        directions = lidar.directions(sector)
        start = time.perf_counter()
        traffic.move(now)
        middle = time.perf_counter()
        hits = traffic.scene.trace(lidar.origin(now), directions, t_max=RANGE, fields=("t", "position"))
        end = time.perf_counter()
        points.append(hits.position[np.isfinite(hits.t)])
        rates.moving += middle - start
        rates.tracing += end - middle
        rates.moves += len(traffic.cars)
        rates.rays += len(directions)
        rates.hits += len(points[-1])
    return np.concatenate(points)


def draw(turns: list[Floats], centers: list[Floats], path: pathlib.Path) -> None:
    figure, axes = plt.subplots(figsize=(6, 6), facecolor="black")
    axes.set_facecolor("black")
    axes.set(xlim=(-RANGE / 2, RANGE / 2), ylim=(-RANGE / 2, RANGE / 2), aspect="equal")
    axes.set_axis_off()
    dots = axes.scatter([], [], s=0.3, c=[], cmap="viridis", vmin=-2, vmax=3)

    def show(frame: int) -> tuple[object, ...]:
        points = turns[frame] - centers[frame] * [1, 1, 0]
        points = points[:: max(1, len(points) // SHOWN)]
        dots.set_offsets(points[:, :2])
        dots.set_array(points[:, 2])
        return (dots,)

    animation = matplotlib.animation.FuncAnimation(figure, show, frames=len(turns), blit=True)
    animation.save(path, writer=matplotlib.animation.PillowWriter(fps=10))
    plt.close(figure)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=20, help="turns of the lidar")
    parser.add_argument("--cars", type=int, default=10_000)
    parser.add_argument("--rays", type=int, default=1_000_000, help="rays of a turn")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/python/lidar.gif"))
    options = parser.parse_args()
    options.out.parent.mkdir(parents=True, exist_ok=True)
    traffic = Traffic(options.cars)
    lidar = Lidar(traffic, options.rays)
    rates = Rates()
    turns, centers = [], []
    for frame in tqdm(range(options.frames), unit="turn"):
        turns.append(turn(traffic, lidar, frame, rates))
        centers.append(lidar.origin(sector_time(frame, 0)))
    print(traffic.scene)
    print(rates)
    draw(turns, centers, options.out)
    print(f"wrote {options.out}")


if __name__ == "__main__":
    main()
