# SPDX-License-Identifier: MIT
"""Which arrays are taken, that they are used where they lie, and what is said of those that do not fit."""

from __future__ import annotations

import tracemalloc
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import raygrid
from raygrid import Mesh, Scene, Sphere

N = 1000


@pytest.fixture(scope="module")
def scene() -> Iterator[Scene]:
    random = np.random.default_rng(5)
    with Scene(workers=2) as scene:
        scene.insert(Sphere(), random.uniform(-20, 20, (500, 3)), scale=random.uniform(0.2, 2, 500))
        yield scene


def rays(dtype: Any) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(6)
    return random.uniform(-30, 30, (N, 3)).astype(dtype), random.normal(size=(N, 3)).astype(dtype)


LAYOUTS = {
    "columns": np.asfortranarray,
    "every second": lambda a: np.repeat(a, 2, axis=0)[::2],
    "backward": lambda a: a[::-1].copy()[::-1],
    "components backward": lambda a: a[:, ::-1].copy()[:, ::-1],
    "of records": lambda a: np.array([(1, row) for row in a], [("x", a.dtype), ("a", a.dtype, 3)])["a"],
    "unaligned": lambda a: np.array([(1, tuple(row)) for row in a], [("x", "u1"), ("a", a.dtype, 3)])["a"],
    "the other byte order": lambda a: a.astype(a.dtype.newbyteorder()),
    "read-only": lambda a: np.frombuffer(a.tobytes(), a.dtype).reshape(-1, 3),
    "a subclass": lambda a: a.view(np.recarray),
}


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_layouts_of_rays(scene: Scene, layout: str, dtype: Any) -> None:
    origins, directions = rays(dtype)
    wanted = scene.trace(origins, directions)
    assert 0 < np.isfinite(wanted.t).sum() < N
    got = scene.trace(LAYOUTS[layout](origins), LAYOUTS[layout](directions))
    assert (got.t == wanted.t).all() and (got.object == wanted.object).all()


@pytest.mark.parametrize(
    "convert", [np.ndarray.tolist, lambda a: a.astype(np.longdouble), lambda a: list(map(tuple, a))]
)
def test_what_is_converted(scene: Scene, convert: Any) -> None:
    origins, directions = rays(np.float64)
    assert (scene.trace(convert(origins), convert(directions)).t == scene.trace(origins, directions).t).all()


@pytest.mark.parametrize("dtype", [np.int8, np.int64, np.uint16, np.float16, bool])
def test_other_numbers_are_converted(scene: Scene, dtype: Any) -> None:
    directions = np.array([[0, 0, 1], [0, 1, 1], [1, 0, 0]])
    wanted = scene.trace((0, 0, 0), directions.astype(float))
    assert (scene.trace((0, 0, 0), directions.astype(dtype)).t == wanted.t).all()


def test_one_for_all(scene: Scene) -> None:
    _, directions = rays(np.float64)
    origin = np.array([1.0, 2, 3])
    wanted = scene.trace(np.tile(origin, (N, 1)), directions).t
    for one in (origin, origin[None], origin.tolist(), np.broadcast_to(origin, (N, 3))):
        assert (scene.trace(one, directions).t == wanted).all()
    from_many = scene.trace(directions, origin, t_min=0.5, t_max=np.full(N, 7, np.float32), mask=1)
    assert from_many.t.shape == (N,)
    assert np.isinf(from_many.t[(from_many.t < 0.5) | (from_many.t > 7)]).all()


def test_limits_and_masks_for_each_ray(scene: Scene) -> None:
    origins, directions = rays(np.float64)
    full = scene.trace(origins, directions)
    hit = np.isfinite(full.t)
    masks = np.where(np.arange(N) % 2, 1, 0).astype(np.int64)
    masked = scene.trace(origins, directions, mask=masks)
    assert (np.isfinite(masked.t) == (hit & (masks == 1))).all()
    short = scene.trace(origins, directions, t_max=np.where(hit, full.t * 0.99, 1e9))
    assert not (short.object[hit] == full.object[hit]).any()


def test_nothing_is_copied(scene: Scene) -> None:
    """What a call allocates is its answers."""
    count = 200_000
    records = np.zeros(count, [("a", "f4", 3), ("b", "f4", 3), ("far", "f4")])
    records["b"] = np.random.default_rng(7).normal(size=(count, 3))
    records["far"] = 1e9
    out = {"t": np.zeros((count, 3))[:, 1], "object": np.zeros(count, np.uint64)}
    tracemalloc.start()
    try:
        scene.trace(records["a"], records["b"][::-1], t_max=records["far"], out=out)
        scene.occluded((0, 0, 0), np.broadcast_to(np.array([0.0, 0, 1]), (count, 3)), out=np.zeros(count, bool))
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert most < count + 50_000, f"{most} bytes for {count} rays"


def test_answers_in_arrays_of_the_caller(scene: Scene) -> None:
    origins, directions = rays(np.float64)
    every = tuple(field for field in raygrid.Hits.__slots__ if field != "invalid")
    wanted = scene.trace(origins, directions, fields=every)
    assert wanted.fields == every
    narrow = {name: getattr(wanted, name) for name in every}
    out = {}
    for name, array in narrow.items():
        dtype = np.float32 if array.dtype.kind == "f" else array.dtype
        out[name] = np.full((*array.shape[1:], 2 * N), 7, dtype).T[::2][::-1]
    got = scene.trace(origins, directions, out=out)
    for name, array in narrow.items():
        assert getattr(got, name) is out[name]
        assert np.array_equal(array.astype(out[name].dtype), out[name]), name
    again = scene.trace(origins, directions, out=wanted)
    assert all(getattr(again, name) is getattr(wanted, name) for name in every)


@pytest.mark.parametrize("dtype", [np.uint8, np.int8, np.uint16, np.int16, np.uint32, np.int32, np.uint64, np.int64])
@pytest.mark.parametrize("flat", [False, True])
def test_indices_of_any_integer_dtype(dtype: Any, flat: bool) -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
    indices = np.array([[0, 1, 2], [0, 1, 3]], dtype)
    mesh = Mesh(vertices, indices.ravel() if flat else indices)
    assert mesh.triangle_count == 2
    with Scene() as scene:
        scene.insert(mesh)
        hits = scene.trace([[0.2, 0.2, 5], [0.2, 5, 0.2]], [[0, 0, -1], [0, -1, 0]], fields=("primitive",))
        assert hits.primitive.tolist() == [0, 1]


def test_a_mesh_of_interleaved_buffers() -> None:
    """As glTF has them: vertices and normals in turn, indices in a row."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
    data = np.concatenate([vertices, np.full((4, 3), 7, np.float32)], axis=1).tobytes()
    positions = np.ndarray((4, 3), np.float32, data, strides=(24, 4))
    mesh = Mesh(positions, np.frombuffer(np.array([0, 2, 1, 0, 1, 3], np.uint16).tobytes(), np.uint16))
    assert mesh.bounds.tolist() == [[0, 0, 0], [1, 1, 1]] and mesh.triangle_count == 2


@pytest.mark.parametrize("dtype", [np.uint16, np.uint32, np.uint64, np.int32])
def test_integers_of_the_other_byte_order(dtype: Any) -> None:
    swapped = np.dtype(dtype).newbyteorder()
    mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.array([[0, 2, 1]], swapped))
    with Scene() as scene:
        ids = scene.insert(mesh, mask=np.array([258], swapped))
        assert scene.lookup(ids[0]).mask == 258
        scene.remove(ids.astype(ids.dtype.newbyteorder()))


@pytest.mark.parametrize("dtype", [np.uint64, np.int64, np.uint32, object])
def test_ids_of_any_integer_dtype(dtype: Any) -> None:
    with Scene() as scene:
        ids = scene.insert(Sphere(), np.arange(6).reshape(2, 3))
        if dtype is np.uint32:
            with pytest.raises(raygrid.InvalidId):
                scene.remove(ids.astype(dtype))
        elif dtype is object:
            scene.remove([int(one) for one in ids])
        else:
            scene.remove(ids.astype(dtype)[::-1])
            assert scene.stats().objects == 0


P = np.zeros((5, 3))

WRONG = [
    (lambda s: s.trace(np.zeros((5, 2)), (0, 0, 1)), ValueError, r"origins must have .*shape \(5, 2\) of float64"),
    (lambda s: s.trace(P[None], (0, 0, 1)), ValueError, r"\(1, 5, 3\)"),
    (lambda s: s.trace(P, P[:4]), ValueError, "directions has 4 records, origins has 5"),
    (lambda s: s.trace(P, (0, 0, 1), t_max=P), ValueError, r"t_max must be a number .*\(5, 3\)"),
    (lambda s: s.trace(P, (0, 0, 1j)), TypeError, "directions must be numbers, not .*complex128"),
    (lambda s: s.trace(P, "abc"), TypeError, "directions must be numbers"),
    (lambda s: s.trace(P, (0, 0, 1), mask=-1), ValueError, "negative numbers, the least -1"),
    (lambda s: s.trace(P, (0, 0, 1), mask=2**32), OverflowError, "uint32 can't hold, the largest 4294967296"),
    (lambda s: s.trace(P, (0, 0, 1), mask=1.5), TypeError, "mask must be whole numbers, not .*float64"),
    (lambda s: s.trace(P, (0, 0, 1), fields=("t", "colour")), ValueError, "'colour' is no field of a hit"),
    (lambda s: s.trace(P, (0, 0, 1), out={"colour": P}), ValueError, "'colour' is no field of a hit"),
    (lambda s: s.trace(P, (0, 0, 1), out={"t": P}), ValueError, r"out t must have the shape \(5,\) .*\(5, 3\)"),
    (lambda s: s.trace(P, (0, 0, 1), out={"object": P[:, 0]}), ValueError, "of uint64, not shape .* of float64"),
    (lambda s: s.trace(P, (0, 0, 1), out={"t": [0.0] * 5}), TypeError, "must be a NumPy array, not list"),
    (lambda s: s.trace(P, (0, 0, 1), out={"t": np.broadcast_to(1.0, 5)}), ValueError, "must be writable"),
    (lambda s: s.occluded(P, (0, 0, 1), out=np.zeros(5)), ValueError, "of bool or uint8, not shape .* of float64"),
    (lambda s: s.trace(P, (0, 0, 1)).normal, AttributeError, "normal was not asked for"),
    (lambda s: s.trace(P, (0, 0, 1)).colour, AttributeError, "Hits has no 'colour'"),
    (lambda s: s.insert("ball"), TypeError, "shapes must be a Shape or Shapes, not str"),
    (lambda s: s.insert([Sphere()] * 2, P), ValueError, "shapes has 2 records, positions has 5"),
    (lambda s: s.insert(Sphere(), P, linear=np.eye(4)), ValueError, r"linear must have .*\(4, 4\)"),
    (lambda s: s.insert(Sphere(), P, linear=np.ones((2, 3, 3))), ValueError, "linear has 2 records"),
    (lambda s: s.insert(Sphere(), P, scale=[1, 2]), ValueError, "scale has 2 records"),
    (lambda s: s.insert(Sphere(), P, mask=[1, 2]), ValueError, "mask has 2 records"),
    (lambda s: s.insert(Sphere(), P, grid=Scene().grid), ValueError, "grid belongs to another scene"),
    (lambda s: s.insert(Sphere(), [[0, 0, np.nan]]), raygrid.InvalidValue, "position.z is nan"),
    (lambda s: s.move([1, 2], P), ValueError, "positions has 5 records, objects has 2"),
    (lambda s: s.move(99, P[0]), raygrid.InvalidId, "0x63"),
    (lambda s: s.remove(P), TypeError, "objects must be whole numbers"),
    (lambda s: s.remove([[1]]), ValueError, r"objects must be an id .*\(1, 1\)"),
    (lambda s: s.remove(2**70), OverflowError, "uint64 can't hold"),
    (lambda s: s.lookup([1, 2]), ValueError, "object must be one id"),
    (lambda s: Mesh(P[:3], [0, 1]), ValueError, r"indices must have .*\(2,\)"),
    (lambda s: Mesh(P[:3], [[0, 1, -1]]), ValueError, "indices has negative numbers"),
    (lambda s: Mesh(P[:3], [[0.5, 1, 2]]), TypeError, "indices must be whole numbers"),
    (lambda s: Mesh(P[:3], [[0, 1, 3]]), raygrid.InvalidValue, "index 3"),
    (lambda s: Mesh(P[0]), ValueError, r"vertices must have .*\(3,\)"),
    (lambda s: Mesh(P[:3], quality=7), raygrid.InvalidArgument, "quality is 7"),
    (lambda s: Mesh(P[:3], workers=-1), OverflowError, "negative|unsigned"),
    (lambda s: Mesh(P[:3], workers=2000), raygrid.InvalidValue, "workers is 2000"),
    (lambda s: Mesh(P[:3]).deformed(P[:2]), raygrid.InvalidValue, "2 vertices can't take the place of 3"),
    (lambda s: Mesh(P[:3]).deformed(P[0]), ValueError, r"vertices must have .*\(3,\)"),
    (lambda s: s.replace_shape(Sphere(), None), AttributeError, "_pointer"),
    (lambda s: raygrid.Box(1, 2), ValueError, r"lo must have the shape \(3,\), not shape \(\)"),
    (lambda s: raygrid.Shape(), TypeError, "made by Sphere, Box, Capsule or Mesh"),
]


@pytest.mark.parametrize("number", range(len(WRONG)))
def test_what_is_refused_is_named_and_changes_nothing(number: int) -> None:
    call, kind, message = WRONG[number]
    with Scene() as scene:
        scene.insert(Sphere(), P)
        before = scene.stats()
        with pytest.raises(kind, match=message):
            call(scene)
        assert scene.stats() == before


def test_no_records(scene: Scene) -> None:
    none = np.zeros((0, 3))
    assert scene.trace(none, none).t.shape == scene.occluded(none, (0, 0, 1)).shape == (0,)
    assert scene.trace(none, none, fields=("uv",)).uv.shape == (0, 2)
    with Scene() as empty:
        assert empty.insert(Sphere(), none).shape == empty.insert([], none).shape == (0,)
        empty.move([], none)
        empty.remove([])
        assert empty.trace((0, 0, 0), (0, 0, 1)).t.tolist() == [np.inf]
