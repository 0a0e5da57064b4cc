# SPDX-License-Identifier: MIT
"""Meshes that read the caller's arrays: the same answers, and the arrays live as long as they are read, no longer."""

from __future__ import annotations

import gc
import threading
import weakref

import numpy as np
import pytest
from numpy.typing import NDArray

import raygrid
from raygrid import Mesh, Scene, Sphere, _shapes

COUNT = 200
random = np.random.default_rng(11)
RAYS = random.normal(size=(500, 3)), random.normal(size=(500, 3))


def soup(dtype: str = "f8") -> tuple[NDArray[np.floating], NDArray[np.uint32]]:
    """Triangles that share nothing, by indices."""
    indices = random.permutation(3 * COUNT).reshape(-1, 3).astype(np.uint32)
    return random.normal(size=(3 * COUNT, 3)).astype(dtype), indices


def hits(mesh: Mesh) -> NDArray[np.float64]:
    with Scene(workers=1) as scene:
        scene.insert(mesh)
        return scene.trace(*RAYS).t


@pytest.mark.parametrize("layout", [lambda a: a, np.asfortranarray, lambda a: a[::-1], lambda a: a.astype(">f8")])
def test_the_same_answers_in_less_memory(layout) -> None:
    vertices, indices = soup()
    vertices = layout(vertices)
    copied, lent = Mesh(vertices, indices), Mesh(vertices, indices, borrow=True)
    assert copied.nbytes - lent.nbytes == 24 * len(vertices) + 12 * COUNT
    assert np.array_equal(hits(copied), hits(lent)) and np.isfinite(hits(lent)).any()
    bent = 1.01 * vertices
    copied, lent = copied.deformed(bent), lent.deformed(bent, borrow=True)
    assert copied.nbytes - lent.nbytes == 24 * len(vertices)
    assert np.array_equal(hits(copied), hits(lent))


def test_objects_hold_the_arrays() -> None:
    vertices, indices = soup()
    held = weakref.ref(vertices), weakref.ref(indices)
    with Scene(workers=1) as scene:
        mesh = Mesh(vertices, indices, borrow=True)
        ids = scene.insert(mesh, [(0, 0, 0), (9, 0, 0)])
        before = scene.trace(*RAYS).t
        del mesh, vertices, indices
        gc.collect()
        assert np.array_equal(scene.trace(*RAYS).t, before)
        scene.remove(ids[0])
        assert all(one() is not None for one in held)
        scene.remove(ids[1])
        assert not any(one() is not None for one in held)


def test_an_end_in_another_thread_and_of_the_scene() -> None:
    vertices, _ = soup()
    held = weakref.ref(vertices)
    scenes = [Scene(workers=1) for _ in range(2)]
    for scene in scenes:
        scene.insert(Mesh(vertices, borrow=True))
    del vertices, scene
    thread = threading.Thread(target=scenes[0].close)
    thread.start()
    thread.join()
    assert held() is not None
    scenes.pop().close()
    assert held() is None


def test_what_is_not_needed_is_not_held() -> None:
    vertices, _ = soup("f4")
    held = weakref.ref(vertices)
    mesh = Mesh(vertices, borrow=True)
    del vertices
    assert held() is None and not _shapes._lent
    assert np.isfinite(hits(mesh)).any()


def test_what_is_refused_is_not_held() -> None:
    vertices, indices = soup()
    with pytest.raises(raygrid.InvalidValue):
        Mesh(vertices, indices + 1, borrow=True)
    with pytest.raises(raygrid.InvalidArgument):
        Mesh.deformed(Sphere(), vertices, borrow=True)  # type: ignore[arg-type]
    assert not _shapes._lent


def test_arrays_that_change_all_the_same() -> None:
    vertices, indices = soup()
    mesh = Mesh(vertices, indices, borrow=True)
    vertices[:], indices[:] = np.nan, 2**32 - 1
    hits(mesh)
    hits(mesh.deformed(soup()[0]))
