# SPDX-License-Identifier: MIT
"""A pytest plugin: trimesh's tests find raygrid where they look for trimesh's engine for Embree.

The engine in pure Python stays for tests that compare the two; in all others it is replaced as well.
"""

from __future__ import annotations

import sys
import types

import pytest
import trimesh.base

import raygrid.interop.trimesh as interop

NAME = "trimesh.ray.ray_pyembree"

engine = types.ModuleType(NAME)
engine.RayMeshIntersector = interop.RayMeshIntersector  # type: ignore[attr-defined]
sys.modules[NAME] = engine
trimesh.ray.ray_pyembree = engine
trimesh.ray.has_embree = True

# One test runs only for that version of the bindings to Embree.
embreex = types.ModuleType("embreex")
embreex.__version__ = "4.4.0"  # type: ignore[attr-defined]
sys.modules["embreex"] = embreex


@pytest.fixture(autouse=True)
def no_other_engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if "engines_agree" not in request.node.name:
        monkeypatch.setattr(trimesh.ray.ray_triangle, "RayMeshIntersector", interop.RayMeshIntersector)
