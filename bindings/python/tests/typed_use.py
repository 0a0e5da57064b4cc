# SPDX-License-Identifier: MIT
"""Never run: what a user writes, for mypy --strict, with the types that they get."""

from __future__ import annotations

from typing import assert_type

import numpy as np
from numpy.typing import NDArray

import raygrid


def swarm(count: int) -> NDArray[np.uint64]:
    random = np.random.default_rng(1)
    with raygrid.Scene(workers=2, grid=raygrid.GridConfig(raygrid.GridKind.UNIFORM, resolution=16)) as scene:
        assert_type(scene, raygrid.Scene)
        positions = random.normal(size=(count, 3)).astype(np.float32)
        ids = scene.insert(raygrid.Sphere(1), positions, scale=[1.0] * count, mask=1)
        assert_type(ids, NDArray[np.uint64])
        scene.insert([raygrid.Box((0, 0, 0), np.ones(3)), raygrid.Capsule([0, 0, 0], [1, 0, 0], 2)])
        scene.move(ids[: count // 2], (0, 0, 0), linear=np.eye(3))
        hits = scene.trace((0, 0, 0), positions, fields=["t", "object"], filter=lambda ray, hit: hit.t > ray)
        assert_type(hits.object, NDArray[np.uint64])
        assert_type(hits.invalid, int)
        mesh = raygrid.Mesh(positions, np.arange(3), quality=raygrid.MeshQuality.FAST, workers=2)
        assert_type(mesh.deformed(positions, borrow=True), raygrid.Mesh)
        scene.replace_shape(mesh, mesh.deformed(positions, quality=raygrid.MeshQuality.FAST))
        again = scene.trace((0, 0, 0), positions, out=hits, cull=raygrid.Cull.BACK)
        scene.occluded(positions, (0, 0, 1), out=np.empty(count, np.bool_))
        assert_type(scene.lookup(ids[0]).position, NDArray[np.float64])
        assert_type(scene.grid.stats().objects, int)
        scene.remove(again.object)
        try:
            scene.remove(ids)
        except raygrid.InvalidId as error:
            print(str(error))
    return ids
