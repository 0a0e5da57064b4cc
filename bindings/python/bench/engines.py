# SPDX-License-Identifier: MIT
"""One frame, some cubes moved and all rays traced, by raygrid and by what Python users have else."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

from scenes import SIZE, Cubes, Floats

Answer = tuple[Floats, Any]  # t, inf for none, and the number of the cube, -1 for none


class Raygrid:
    name, needs = "raygrid", "raygrid"

    def __init__(self, cubes: Cubes, workers: int) -> None:
        import raygrid

        self.scene = raygrid.Scene(workers=workers)
        half = (cubes.side / 2,) * 3
        self.ids = self.scene.insert(raygrid.Box([-h for h in half], half), cubes.centers)

    def update(self, cubes: Cubes, moved: Any) -> None:
        self.scene.move(self.ids[moved], cubes.centers[moved])

    def trace(self, cubes: Cubes) -> Any:
        return self.scene.trace(cubes.origins, cubes.directions)

    def answer(self, cubes: Cubes, hits: Any) -> Answer:
        order = np.argsort(self.ids)
        place = np.searchsorted(self.ids[order], hits.object)
        return hits.t, np.where(hits.object, order[np.minimum(place, len(order) - 1)], -1)


class Embreex:
    """Triangles in float. Its calls can't change a scene: it is made anew."""

    name, needs = "embreex 4.4", "embreex"

    def __init__(self, cubes: Cubes, workers: int) -> None:
        self.update(cubes, None)

    def update(self, cubes: Cubes, moved: Any) -> None:
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        vertices, indices = cubes.triangles()
        self.scene = EmbreeScene()
        self.mesh = TriangleMesh(self.scene, vertices, indices.astype(np.int32))
        # The tree is built by the first query.
        self.scene.run(np.zeros((1, 3), np.float32), np.ones((1, 3), np.float32))

    def trace(self, cubes: Cubes) -> Any:
        return self.scene.run(cubes.origins.astype(np.float32), cubes.directions.astype(np.float32), output=1)

    def answer(self, cubes: Cubes, hits: Any) -> Answer:
        triangle = hits["primID"].astype(np.int64)
        return np.where(triangle < 0, np.inf, hits["tfar"]), np.where(triangle < 0, -1, triangle // 12)


class Open3D:
    """Triangles in float. Its scene can't change: it is made anew."""

    name, needs = "Open3D", "open3d"

    def __init__(self, cubes: Cubes, workers: int) -> None:
        self.update(cubes, None)

    def update(self, cubes: Cubes, moved: Any) -> None:
        import open3d

        self.tensor = open3d.core.Tensor
        vertices, indices = cubes.triangles()
        self.scene = open3d.t.geometry.RaycastingScene()
        self.scene.add_triangles(self.tensor(vertices), self.tensor(indices))
        self.scene.cast_rays(self.tensor(np.ones((1, 6), np.float32)))  # builds the tree

    def trace(self, cubes: Cubes) -> Any:
        rays = np.concatenate([cubes.origins, cubes.directions], axis=1).astype(np.float32)
        return self.scene.cast_rays(self.tensor(rays))

    def answer(self, cubes: Cubes, hits: Any) -> Answer:
        t = hits["t_hit"].numpy().astype(np.float64)
        return t, np.where(np.isinf(t), -1, hits["primitive_ids"].numpy().astype(np.int64) // 12)


class Pybullet:
    """Bodies with box shapes, moved one by one. A ray has an end: here twice the world's size away."""

    name, needs = "pybullet", "pybullet"
    length = 2 * SIZE

    def __init__(self, cubes: Cubes, workers: int) -> None:
        import pybullet

        self.bullet, self.threads = pybullet, workers
        self.world = pybullet.connect(pybullet.DIRECT)
        shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[cubes.side / 2] * 3)
        self.bodies = [pybullet.createMultiBody(0, shape, basePosition=center) for center in cubes.centers.tolist()]

    def update(self, cubes: Cubes, moved: Any) -> None:
        for body in moved.tolist():
            self.bullet.resetBasePositionAndOrientation(self.bodies[body], cubes.centers[body].tolist(), (0, 0, 0, 1))

    def trace(self, cubes: Cubes) -> Any:
        ends = cubes.origins + self.length * cubes.directions
        most = self.bullet.MAX_RAY_INTERSECTION_BATCH_SIZE - 1  # a batch of the full size lacks its last answer
        found = []
        for first in range(0, len(ends), most):
            part = slice(first, first + most)
            found += self.bullet.rayTestBatch(
                cubes.origins[part].tolist(), ends[part].tolist(), numThreads=self.threads
            )
        return found

    def answer(self, cubes: Cubes, hits: Any) -> Answer:
        number = {body: i for i, body in enumerate(self.bodies)} | {-1: -1}
        cube = np.array([number[hit[0]] for hit in hits])
        t = np.array([hit[2] * self.length for hit in hits])
        return np.where(cube < 0, np.inf, t), cube


ENGINES = (Raygrid, Embreex, Open3D, Pybullet)


def installed() -> list[Any]:
    """The engines that are there; says which are not."""
    there = []
    for engine in ENGINES:
        try:
            importlib.import_module(engine.needs)
        except ImportError as error:
            print(f"{engine.name} is left out: {error}")
        else:
            there.append(engine)
    return there
