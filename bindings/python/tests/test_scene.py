# SPDX-License-Identifier: MIT
"""What a scene does, and how it ends."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest

import raygrid
from raygrid import Box, Capsule, Cull, GridConfig, GridKind, Mesh, Scene, Sphere

TETRAHEDRON = (
    np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float64),
    np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
)


@pytest.mark.parametrize("linear_type", [np.float32, np.float64])
def test_poses(linear_type: Any) -> None:
    random = np.random.default_rng(8)
    positions, scale = random.normal(size=(20, 3)), random.uniform(0.5, 2, 20)
    linear = np.linalg.qr(random.normal(size=(20, 3, 3)))[0].astype(linear_type)
    with Scene() as scene:
        layouts = (linear, np.asfortranarray(linear), linear.swapaxes(1, 2).copy().swapaxes(1, 2))
        for layout in layouts:
            ids = scene.insert(Capsule((0, 0, 0), (0, 0, 1), 0.2), positions, linear=layout, scale=scale)
            for one, p, m, s in zip(ids, positions, linear, scale, strict=True):
                report = scene.lookup(one)
                assert (report.position == p).all() and report.scale == s
                assert (report.linear == m.astype(np.float32)).all()
                end = p + s * (m.astype(np.float32).astype(float) @ [0, 0, 1])
                assert ((report.lo < end) & (end < report.hi)).all()


def test_move_keeps_what_is_not_given() -> None:
    turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    with Scene() as scene:
        box = scene.insert(Box((-1, -2, -3), (1, 2, 3)), (0, 0, 0), linear=turn, scale=2)
        scene.move(box, (5, 0, 0))
        report = scene.lookup(box)
        assert (report.linear == turn).all() and report.scale == 2 and report.position.tolist() == [5, 0, 0]
        scene.move(box, (5, 0, 0), linear=np.eye(3))
        assert scene.lookup(box).scale == 2
        scene.move(box, (5, 0, 0), scale=1)
        assert (scene.lookup(box).linear == np.eye(3)).all() and scene.lookup(box).scale == 1


def test_each_its_own_shape_and_mask() -> None:
    shapes = [Sphere(1), Box((-1, -1, -1), (1, 1, 1)), Capsule((0, -1, 0), (0, 1, 0), 1), Mesh(*TETRAHEDRON)]
    with Scene() as scene:
        ids = scene.insert(shapes, [[4 * i, 0, 5] for i in range(4)], mask=[1, 2, 4, 8])
        assert [scene.lookup(one).shape for one in ids] == shapes
        assert [type(scene.lookup(one).shape) for one in ids] == [Sphere, Box, Capsule, Mesh]
        origins = [[4 * i + 0.1, 0.2, 0] for i in range(4)]
        hits = scene.trace(origins, (0, 0, 1), fields=("object", "primitive", "uv"))
        assert (hits.object == ids).all() and hits.primitive[1] == 4
        assert (scene.trace(origins, (0, 0, 1), mask=4).object == [0, 0, ids[2], 0]).all()
        scene.set_mask(ids[0], 4)
        assert (scene.trace(origins, (0, 0, 1), mask=4).object == [ids[0], 0, ids[2], 0]).all()


@pytest.mark.parametrize("quality", raygrid.MeshQuality)
def test_a_mesh_that_changes_its_form(quality: raygrid.MeshQuality) -> None:
    random = np.random.default_rng(5)
    corners, places = random.normal(size=(300, 3)), [[0, 0, 0], [9, 0, 0]]
    flat = corners.astype(np.float32)
    rays = random.normal(size=(2, 200, 3)) * 3
    with Scene() as scene, Scene() as other, scene.frame() as frame:
        mesh = Mesh(corners, quality=quality, workers=2)
        ids = scene.insert(mesh, places, mask=[1, 2])
        ball = scene.insert(Sphere(), (0, 9, 0))
        for step in range(3):
            new = flat if step == 1 else corners + 0.1 * random.normal(size=corners.shape)
            bent = mesh.deformed(new, quality=quality)
            scene.replace_shape(mesh, bent)
            assert [scene.lookup(one).shape for one in ids] == [bent, bent]
            assert [scene.lookup(one).mask for one in ids] == [1, 2]
            assert scene.lookup(ball).shape != bent
            frame.update()
            mesh = bent
            made = Mesh(new)
            assert (made.bounds == mesh.bounds).all() and made.triangle_count == mesh.triangle_count == 100
            fresh = other.insert(made, places)
            want, got = other.trace(*rays), scene.trace(*rays)
            assert (want.t == np.where(got.object == ball, want.t, got.t)).all() and np.isfinite(want.t).sum() > 20
            assert (frame.trace(*rays).t == got.t).all()
            other.remove(fresh)


def test_shapes_outlive_their_makers() -> None:
    with Scene() as scene:
        ball = scene.insert(Sphere(3))
        shape = scene.lookup(ball).shape
        scene.remove(ball)
    assert shape.bounds.tolist() == [[-3] * 3, [3] * 3]
    with Scene() as scene:
        scene.insert(shape, (0, 0, 5))
        assert scene.trace((0, 0, 0), (0, 0, 1)).t.tolist() == [2]


def test_cull() -> None:
    with Scene() as scene:
        scene.insert(Mesh(*TETRAHEDRON))
        ray = (0.2, 0.2, 5), (0, 0, -1)
        assert scene.trace(*ray).t < scene.trace(*ray, cull=Cull.FRONT).t
        assert scene.trace(*ray).t == scene.trace(*ray, cull=Cull.BACK).t
        assert scene.occluded((0.2, 0.2, 0.2), (0, 0, 1), cull=Cull.BACK).tolist() == [False]
        with pytest.raises(raygrid.InvalidArgument, match="cull is 7"):
            scene.trace(*ray, cull=7)


def test_filter() -> None:
    with Scene(workers=2) as scene:
        balls = scene.insert(Sphere(), [[0, 0, 5], [0, 0, 10], [0, 0, 15]])
        seen = []

        def only_last(index: int, hit: raygrid.Candidate) -> bool:
            seen.append(index)
            assert np.allclose(np.linalg.norm(hit.normal), 1) and hit.position[2] == hit.t
            return hit.object == balls[2]

        assert scene.trace((0, 0, 0), (0, 0, 1), filter=only_last).t.tolist() == [14]
        count = 5000
        many = scene.trace(np.zeros((count, 3)), (0, 0, 1), filter=only_last)
        assert (many.t == 14).all() and set(seen) == set(range(count))
        assert scene.occluded((0, 0, 0), (0, 0, 1), filter=lambda index, hit: False).tolist() == [False]


def test_what_a_filter_raises_is_the_cause() -> None:
    with Scene() as scene:
        scene.insert(Sphere(), (0, 0, 5))

        def broken(index: int, hit: raygrid.Candidate) -> bool:
            raise KeyError("mine")

        with pytest.raises(raygrid.CallbackFailed) as caught:
            scene.trace((0, 0, 0), (0, 0, 1), filter=broken)
        assert isinstance(caught.value.__cause__, KeyError)

        def interrupted(index: int, hit: raygrid.Candidate) -> bool:
            raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            scene.trace((0, 0, 0), (0, 0, 1), filter=interrupted)


def test_a_filter_may_trace_but_not_change() -> None:
    with Scene() as scene:
        ball = scene.insert(Sphere(), (0, 0, 5))

        def changes(index: int, hit: raygrid.Candidate) -> bool:
            assert scene.trace((0, 0, 0), (0, 0, 1)).t == 4
            with pytest.raises(raygrid.Busy):
                scene.move(ball, (0, 0, 9))
            return True

        assert scene.trace((0, 0, 0), (0, 0, 1), filter=changes).t.tolist() == [4]


def test_invalid_rays() -> None:
    with Scene() as scene:
        scene.insert(Sphere(), (0, 0, 5))
        hits = scene.trace((0, 0, 0), [[0, 0, 1], [0, 0, 0], [np.nan, 0, 1], [0, 1, 0]])
        assert hits.invalid == 2 and scene.stats().invalid_rays == 2
        assert np.array_equal(hits.t, [4, np.nan, np.nan, np.inf], equal_nan=True)


def test_grids() -> None:
    random = np.random.default_rng(9)
    with Scene(grid=GridConfig(GridKind.UNIFORM, resolution=8, lo=(-1, -1, -1), hi=(1, 1, 1))) as scene:
        report = scene.grid.stats()
        assert report.kind == GridKind.UNIFORM and report.resolution == (8, 8, 8)
        assert report.physical_lo.tolist() == [-1, -1, -1]
        still = scene.create_grid(GridConfig(GridKind.HIERARCHICAL))
        ids = scene.insert(Sphere(0.1), random.uniform(-1, 1, (100, 3)), grid=still)
        assert scene.lookup(ids[0]).grid == still != scene.grid
        assert still.stats().objects == 100 and scene.stats().grids == 2
        rays = random.uniform(-2, 2, (200, 3)), random.normal(size=(200, 3))
        before = scene.trace(*rays).t
        still.configure(GridConfig(GridKind.UNIFORM))
        still.rebuild()
        assert (scene.trace(*rays).t == before).all() and still.stats().kind == GridKind.UNIFORM
        with pytest.raises(raygrid.Busy):
            still.destroy()
        scene.remove(ids)
        still.destroy()
        with pytest.raises(raygrid.InvalidId):
            still.stats()


def test_log() -> None:
    lines: list[str] = []
    with Scene(log=lines.append, grid=GridConfig(GridKind.HIERARCHICAL)) as scene:
        scene.insert(Sphere(), np.random.default_rng(10).uniform(-50, 50, (1000, 3)))
        scene.grid.rebuild()
    assert lines and all("grid" in line for line in lines)


@pytest.mark.parametrize("config", [{"workers": 2000}, {"grid": GridConfig(resolution=2**30, kind=GridKind.UNIFORM)}])
def test_scenes_that_are_refused(config: Any) -> None:
    with pytest.raises(raygrid.Error):
        Scene(**config)


def test_frames() -> None:
    with Scene(workers=1) as scene:
        ball = scene.insert(Sphere(), (5, 0, 0))
        frame = scene.frame(workers=1)
        scene.move(ball, (9, 0, 0))
        assert frame.trace((0, 0, 0), (1, 0, 0)).t == 4
        assert scene.trace((0, 0, 0), (1, 0, 0)).t == 8
        with pytest.raises(raygrid.Busy):
            frame.move(ball, (1, 2, 3))
        frame.update()
        hits = frame.trace((0, 0, 0), (1, 0, 0))
        assert hits.t == 8 and hits.object == ball
        with pytest.raises(raygrid.InvalidArgument):
            raygrid.Frame.update(scene)  # type: ignore[arg-type]
        with pytest.raises(TypeError, match="Scene.frame"):
            raygrid.Frame()
    # The scene was closed first: it goes when its frame does.
    assert frame.trace((0, 0, 0), (1, 0, 0)).t == 8
    frame.update()
    frame.close()
    with pytest.raises(ValueError, match="closed"):
        frame.update()


def test_memory_limit() -> None:
    with Scene(workers=1, memory_limit=1 << 20) as scene:
        scene.insert(Sphere(), np.zeros((100, 3)))
        with pytest.raises(raygrid.OutOfMemory, match="limit of 1048576"):
            scene.insert(Sphere(), np.zeros((100000, 3)))
        assert scene.stats().objects == 100 and scene.stats().bytes <= 1 << 20


def test_closed() -> None:
    scene = Scene()
    grid = scene.grid
    ball = scene.insert(Sphere())
    with scene as entered:
        assert entered is scene
    scene.close()
    calls = (
        lambda: scene.trace((0, 0, 0), (0, 0, 1)),
        lambda: scene.insert(Sphere()),
        lambda: scene.move(ball, (0, 0, 0)),
        lambda: scene.remove(ball),
        lambda: scene.stats(),
        lambda: scene.__enter__(),
        lambda: grid.stats(),
    )
    for call in calls:
        with pytest.raises(ValueError, match="the scene is closed"):
            call()
    assert repr(scene) == "<raygrid.Scene: the scene is closed>"


def test_reprs() -> None:
    with Scene(workers=2) as scene:
        scene.insert(Sphere(), np.zeros((3, 3)))
        scene.create_grid(GridConfig(GridKind.UNIFORM, resolution=4, lo=(0, 0, 0), hi=(1, 1, 1)))
        assert repr(scene).startswith("<raygrid.Scene: 3 objects in 2 grids, 2 workers, ")
        assert repr(scene.grid).startswith("<raygrid.Grid 0: ") and repr(scene.grid).endswith(" 3 objects>")
        assert repr(scene.trace((0, 0, 5), [[0, 0, 1], [0, 0, -1], [0, 0, 0]])) == (
            "<raygrid.Hits: 3 rays, 1 hits, 1 invalid; t, object>"
        )
    assert repr(Sphere(2)).startswith("<raygrid.Sphere: from (-2.0, -2.0, -2.0) to (2.0, 2.0, 2.0), ")
    assert repr(Mesh(*TETRAHEDRON)).startswith(
        "<raygrid.Mesh: 4 triangles, from (0.0, 0.0, 0.0) to (1.0, 1.0, 1.0), "
    )


@pytest.mark.parametrize("act", [pickle.dumps, copy.copy, copy.deepcopy])
def test_what_belongs_to_the_library_is_not_pickled(act: Any) -> None:
    with Scene() as scene:
        for thing in (scene.grid, Sphere()):
            with pytest.raises(TypeError, match=rf"a raygrid.{type(thing).__name__} can't be pickled or copied"):
                act(thing)


def test_hits_and_configs_are_pickled() -> None:
    with Scene() as scene:
        scene.insert(Sphere(), (0, 0, 5))
        hits = scene.trace((0, 0, 0), (0, 0, 1), fields=("t", "normal"))
    other = pickle.loads(pickle.dumps(hits))
    assert other.t == hits.t and (other.normal == hits.normal).all() and other.fields == ("t", "normal")
    assert pickle.loads(pickle.dumps(GridConfig(GridKind.UNIFORM))) == GridConfig(GridKind.UNIFORM)
