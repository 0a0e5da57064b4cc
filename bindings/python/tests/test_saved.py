# SPDX-License-Identifier: MIT
"""Scenes as bytes: saved, loaded, pickled, recorded, played."""

from __future__ import annotations

import copy
import gc
import io
import pickle
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import raygrid
from raygrid import Box, Call, Capsule, GridConfig, GridKind, Mesh, Replay, Scene, Sphere
from test_process import run

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
SOLID = Mesh(CORNERS, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
SHAPES = [
    Sphere(0.5),
    Box((-1, -0.5, 0), (1, 0.5, 0.25)),
    Capsule((0, 0, 0), (0, 0.3, 1), 0.2),
    SOLID,
]
RAYS = np.random.default_rng(3).normal(size=(2, 500, 3)) * 4


def crowd(scene: Scene) -> np.ndarray:
    random = np.random.default_rng(4)
    grid = scene.create_grid(GridConfig(GridKind.HIERARCHICAL))
    positions, scale = random.normal(size=(80, 3)) * 3, random.uniform(0.5, 2, 80)
    ids = scene.insert(SHAPES * 20, positions, scale=scale, mask=np.arange(1, 81, dtype=np.uint32))
    scene.insert(SHAPES[0], positions[:10], grid=grid)
    scene.remove(ids[::7])
    return np.delete(ids, np.s_[::7])


def answers(scene: Scene) -> list[bytes]:
    hits = scene.trace(RAYS[0], RAYS[1], fields=("t", "object", "normal", "position", "uv", "primitive", "offset"))
    return [getattr(hits, name).tobytes() for name in hits.fields]


@pytest.mark.parametrize(
    "remake",
    [
        lambda scene: Scene.load(scene.save()),
        lambda scene: Scene.load(memoryview(bytearray(scene.save())), workers=2),
        lambda scene: pickle.loads(pickle.dumps(scene)),
        copy.copy,
        copy.deepcopy,
    ],
)
def test_same_ids_and_same_bits(remake: Callable[[Scene], Scene]) -> None:
    with Scene() as scene:
        ids = crowd(scene)
        with remake(scene) as other:
            assert other.save() == scene.save()
            assert answers(other) == answers(scene)
            for each in (scene, other):
                each.move(ids[:3], (1, 2, 3))
                each.remove(ids[3])
            assert (other.insert(SHAPES[0], RAYS[0][:9]) == scene.insert(SHAPES[0], RAYS[0][:9])).all()
            assert answers(other) == answers(scene)
            other.move(ids[0], (50, 0, 0))
            assert scene.lookup(ids[0]).position.tolist() == [1, 2, 3]


def test_workers_are_pickled() -> None:
    with Scene(workers=3) as scene, pickle.loads(pickle.dumps(scene)) as other:
        assert other.stats().workers == 3


def test_damage() -> None:
    with Scene() as scene:
        crowd(scene)
        data = scene.save()
    with pytest.raises(raygrid.InvalidData, match=r"^byte \d+: the bytes end here"):
        Scene.load(data[:-48])
    with pytest.raises(raygrid.InvalidData, match="the bytes end within a record"):
        Scene.load(data[:-1])
    with pytest.raises(raygrid.InvalidData, match="checksum"):
        Scene.load(data[:500] + bytes([data[500] ^ 1]) + data[501:])
    with pytest.raises(raygrid.InvalidData, match="no snapshot"):
        Replay(b"")
    with pytest.raises(TypeError):
        Scene.load("text")  # type: ignore[arg-type]


def test_recording() -> None:
    file = io.BytesIO()
    with Scene() as scene:
        ids = crowd(scene)
        scene.record(file.write)
        with pytest.raises(raygrid.Busy, match="already"):
            scene.record(file.write)
        scene.move(ids[:5], RAYS[0][:5])
        scene.set_mask(ids[9], 3)
        grid = scene.create_grid()
        grid.configure(GridConfig(GridKind.UNIFORM))
        grid.rebuild()
        new = scene.insert(SHAPES[1], grid=grid)
        scene.remove(new)
        scene.replace_shape(SOLID, SOLID.deformed(1.5 * CORNERS))
        scene.record(None)
        scene.record(None)
        want, saved = answers(scene), scene.save()
    replay = Replay(file.getvalue(), workers=2)
    steps = list(replay)
    assert [step.call for step in steps] == [
        Call.MOVE_MANY,
        Call.SET_MASK,
        Call.GRID_CREATE,
        Call.GRID_CONFIGURE,
        Call.GRID_REBUILD,
        Call.INSERT_MANY,
        Call.REMOVE_MANY,
        Call.REPLACE_SHAPE,
    ]
    assert [step.calls for step in steps] == list(range(1, 9))
    assert (steps[0].objects, steps[0].object, steps[5].object) == (5, ids[0], new[0])
    assert steps[5].grid.stats().objects == 0
    assert answers(replay.scene) == want and replay.scene.save() == saved
    assert list(replay) == []
    replay.scene.close()
    with pytest.raises(ValueError, match="closed"):
        next(replay)


def test_a_recording_that_is_cut_off() -> None:
    file = io.BytesIO()
    with Scene() as scene:
        ball = scene.insert(Sphere())
        scene.record(file.write)
        for i in range(10):
            scene.move(ball, (i, 0, 0))
    whole = file.getvalue()
    assert len(list(Replay(whole))) == 10  # the end of the scene has ended it
    replay = Replay(whole[:-24])  # without its end
    with pytest.raises(raygrid.InvalidData, match="byte"):
        list(replay)
    assert replay.scene.lookup(ball).position.tolist() == [9, 0, 0]


def test_a_writer_that_raises() -> None:
    def write(data: bytes) -> None:
        raise OSError("the disk is full")

    with Scene() as scene:
        crowd(scene)
        with pytest.raises(raygrid.CallbackFailed) as raised:
            scene.record(write)
        assert isinstance(raised.value.__cause__, OSError)
        left = [2]

        def write_twice(data: bytes) -> None:
            left[0] -= 1
            if left[0] < 0:
                raise OSError("the disk is full")

        ball = Sphere()
        empty = Scene()
        empty.record(write_twice)
        for _ in range(5):
            empty.insert(ball)  # none of them fails
        assert empty.stats().objects == 5
        with pytest.raises(raygrid.CallbackFailed, match="after 1 calls") as raised:
            empty.record(None)
        assert isinstance(raised.value.__cause__, OSError)
        empty.record(None)
        empty.close()


def test_threads() -> None:
    file = io.BytesIO()
    with Scene() as scene:
        scene.record(file.write)

        def work(number: int) -> None:
            random = np.random.default_rng(number)
            for _ in range(40):
                ids = scene.insert(SHAPES[number % 4], random.normal(size=(3, 3)))
                scene.move(ids, random.normal(size=(3, 3)))
                scene.trace(RAYS[0], RAYS[1])
                scene.remove(ids[:2])

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        scene.record(None)
        replay = Replay(file.getvalue())
        assert len(list(replay)) == 4 * 40 * 3
        assert replay.scene.save() == scene.save()


def test_scenes_that_are_dropped_while_they_are_recorded() -> None:
    written: list[bytes] = []
    scene: Any = Scene()
    scene.record(written.append)
    scene.insert(Sphere())
    del scene
    gc.collect()
    assert [step.call for step in Replay(b"".join(written))] == [Call.INSERT_MANY]


def test_exit_while_a_scene_is_recorded() -> None:
    output = run("""
        import sys, raygrid
        class Holder: pass
        holder = Holder()
        holder.self = holder
        holder.scene = raygrid.Scene()
        holder.scene.record(lambda data: print(len(data)))
        holder.scene.insert(raygrid.Sphere())
    """)
    assert output.split()[-1] == "24"  # a record of one word: the end
