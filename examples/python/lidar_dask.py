# SPDX-License-Identifier: MIT
"""The lidar of lidar.py, its sectors spread over processes by Dask; with --scheduler ADDRESS over machines.

A scene belongs to its process. So each worker makes its own copy when it gets its first sector, and before each
sector moves the cars to where they are at that moment; nothing but the number of the sector and the points travel.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
from distributed import Client, LocalCluster, get_worker

from traffic import RANGE, SECTORS, Floats, Lidar, Traffic, sector_time


def own_copy(cars: int, rays: int) -> tuple[Traffic, Lidar]:
    """This worker's scene, made the first time."""
    worker = get_worker()
    if getattr(worker, "traffic_of", None) != (cars, rays):
        traffic = Traffic(cars)
        worker.traffic, worker.traffic_of = (traffic, Lidar(traffic, rays)), (cars, rays)
    return worker.traffic


def look(frame: int, sector: int, cars: int, rays: int) -> Floats:
    """The points that a sector of a turn sees, (H, 3). Runs in a worker."""
    traffic, lidar = own_copy(cars, rays)
    now = sector_time(frame, sector)
    traffic.move(now)
    hits = traffic.scene.trace(lidar.origin(now), lidar.directions(sector), t_max=RANGE, fields=("t", "position"))
    return hits.position[np.isfinite(hits.t)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=20, help="turns of the lidar")
    parser.add_argument("--cars", type=int, default=10_000)
    parser.add_argument("--rays", type=int, default=1_000_000, help="rays of a turn")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--scheduler", help="address of a Dask scheduler, in place of processes of this machine")
    options = parser.parse_args()
    # One thread a worker: a worker has one scene, which shows one moment at a time.
    cluster = options.scheduler or LocalCluster(
        n_workers=options.processes, threads_per_worker=1, dashboard_address=None
    )
    with Client(cluster) as client:
        client.upload_file(__file__.replace("lidar_dask.py", "traffic.py"))
        sectors = [(frame, sector) for frame in range(options.frames) for sector in range(SECTORS)]
        start = time.perf_counter()
        futures = client.map(lambda one: look(*one, options.cars, options.rays), sectors)
        points = client.gather(futures)
        seconds = time.perf_counter() - start
        rays = len(sectors) * Lidar(Traffic(2), options.rays).rays
        seen = sum(map(len, points))
        print(f"{rays} rays in {seconds:.2f} s, {rays / seconds / 1e6:.2f} million rays a second; {seen} points")
    if not options.scheduler:
        cluster.close()


if __name__ == "__main__":
    main()
