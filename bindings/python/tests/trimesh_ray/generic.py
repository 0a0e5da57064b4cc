# SPDX-License-Identifier: MIT
"""Stands in for the module that trimesh's own tests take their meshes and data from.

That module and its model files are in trimesh's repository, not in its source distribution. What the ray tests use of
it is here, with meshes of the same kind made by trimesh itself, and read from STL files as the originals are.
"""

from __future__ import annotations

import functools
import pathlib
import tempfile
import time
from typing import Any

import numpy as np
import trimesh
from trimesh.constants import log

__all__ = ["data", "get_mesh", "log", "np", "random", "time", "trimesh"]

generator = np.random.default_rng(0)
random = generator.random


def seven_eighths() -> trimesh.Trimesh:
    """A cube without the eighth where all coordinates are positive."""
    whole = trimesh.creation.box(extents=[20, 20, 20])
    eighth = trimesh.creation.box(bounds=[[0, 0, 0], [10, 10, 10]])
    return trimesh.boolean.difference([whole, eighth])


def torn() -> trimesh.Trimesh:
    """A surface with holes, as the teapot is."""
    ball = trimesh.creation.icosphere(subdivisions=3, radius=10)
    ball.update_faces(np.arange(len(ball.faces)) % 7 != 0)
    return ball


def machined() -> trimesh.Trimesh:
    """A block with bores through it: long thin triangles, and edges of all angles."""
    bores = [
        trimesh.creation.cylinder(radius=0.3, height=4, transform=trimesh.transformations.translation_matrix(at))
        for at in ([-1, 0, 0], [0.2, 0.1, 0], [1.2, -0.3, 0])
    ]
    return trimesh.boolean.difference([trimesh.creation.box(extents=[5, 2, 1]), *bores])


MAKERS = {
    "unit_sphere.STL": lambda: trimesh.creation.icosphere(subdivisions=3, radius=0.5),
    "unit_cube.STL": trimesh.creation.box,
    "7_8ths_cube.stl": seven_eighths,
    "teapot.stl": torn,
    "featuretype.STL": machined,
}


@functools.cache
def folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory()


def get_mesh(file_name: str, **kwargs: Any) -> trimesh.Trimesh:
    path = pathlib.Path(folder().name, file_name)
    if not path.exists():
        MAKERS[file_name]().export(path)
    mesh = trimesh.load_mesh(path, **kwargs)
    mesh.source.file_path = str(path)
    return mesh


def rays_at(file_name: str) -> dict[str, np.ndarray]:
    mesh = get_mesh(file_name)
    middle, size = mesh.bounds.mean(axis=0), mesh.scale
    origins = middle + size * (random((500, 3)) - 0.5) * 4
    targets = middle + size * (random((500, 3)) - 0.5)
    return {"ray_origins": origins, "ray_directions": trimesh.unitize(targets - origins)}


data = {
    "ray_data": {
        "load_kwargs": [
            {"file_name": name, "use_embree": use}
            for name in ("unit_sphere.STL", "featuretype.STL")
            for use in (0, 1)
        ],
        "rays": {name: rays_at(name) for name in ("unit_sphere.STL", "featuretype.STL")},
    }
}
