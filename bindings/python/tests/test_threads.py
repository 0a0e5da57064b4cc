# SPDX-License-Identifier: MIT
"""Threads: they trace while others change the scene, and the interpreter is free meanwhile."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from raygrid import Scene, Sphere

BALLS, INSTANT = 96, 16  # so many rays of a trace, from its first on, see one instant


def test_traces_see_whole_changes() -> None:
    """Balls only move all together: no 16 rays of a trace may see some of them moved and others not."""
    with Scene(workers=2) as scene:
        places = np.zeros((BALLS, 3))
        places[:, 0] = 3 * np.arange(BALLS)
        balls = scene.insert(Sphere(), places)
        origins = places - [0, 0, 1000]
        done = threading.Event()

        def tracer() -> int:
            rounds = 0
            while not done.is_set() or rounds < 20:
                t = scene.trace(origins, (0, 0, 1)).t.reshape(-1, INSTANT)
                assert np.isfinite(t).all()
                assert (t == t[:, :1]).all()
                rounds += 1
            return rounds

        with ThreadPoolExecutor(3) as pool:
            tracers = [pool.submit(tracer) for _ in range(3)]
            try:
                for step in range(1, 1000):
                    scene.move(balls, places + [0, 0, step % 17])
            finally:
                done.set()
            assert all(one.result() >= 20 for one in tracers)


def test_all_threads_change_a_scene() -> None:
    with Scene(workers=1) as scene:

        def guest(number: int) -> None:
            random = np.random.default_rng(number)
            for _ in range(30):
                ids = scene.insert(Sphere(), random.normal(size=(20, 3)) * 5)
                scene.move(ids, random.normal(size=(20, 3)) * 5)
                assert np.isfinite(scene.trace(scene.lookup(ids[0]).position, (0, 0, 1)).t).all()
                scene.remove(ids)

        with ThreadPoolExecutor(4) as pool:
            for one in [pool.submit(guest, number) for number in range(4)]:
                one.result()
        assert scene.stats().objects == 0


def longest_pause(call: Callable[[], object]) -> tuple[float, float]:
    """How long a call in another thread took, and for how long at most this thread could not run meanwhile."""
    thread = threading.Thread(target=call)
    start = last = time.perf_counter()
    pause = 0.0
    thread.start()
    while thread.is_alive():
        now = time.perf_counter()
        pause, last = max(pause, now - last), now
    return time.perf_counter() - start, pause


def test_a_trace_lets_other_threads_run() -> None:
    random = np.random.default_rng(11)
    with Scene(workers=1) as scene:
        scene.insert(Sphere(), random.normal(size=(20000, 3)) * 30)
        count = 100_000
        while True:
            rays = random.normal(size=(count, 3)), random.normal(size=(count, 3))
            took, pause = longest_pause(lambda: scene.trace(*rays))
            if took > 0.3:
                break
            count *= 2
        assert pause < took / 2, f"nothing else ran for {pause:.3f} s of {took:.3f} s"


def test_close_waits_for_calls_of_other_threads() -> None:
    scene = Scene(workers=2)
    scene.insert(Sphere(), (0, 0, 5))
    inside, closed = threading.Event(), threading.Event()

    def wait(index: int, hit: object) -> bool:
        inside.set()
        return closed.wait(10)

    with ThreadPoolExecutor(1) as pool:
        running = pool.submit(lambda: scene.trace((0, 0, 0), (0, 0, 1), filter=wait))
        assert inside.wait(10)
        scene.close()
        with pytest.raises(ValueError, match="the scene is closed"):
            scene.trace((0, 0, 0), (0, 0, 1))
        closed.set()
        assert running.result().t.tolist() == [4]
