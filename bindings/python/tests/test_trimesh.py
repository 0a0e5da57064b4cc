# SPDX-License-Identifier: MIT
"""raygrid.interop.trimesh: trimesh's own ray tests, and raygrid's against trimesh's engine in Python."""

from __future__ import annotations

import copy
import os
import pathlib
import pickle
import re
import subprocess
import sys

import numpy as np
import pytest
import trimesh

import raygrid
from raygrid.interop.trimesh import RayMeshIntersector, insert

HERE = pathlib.Path(__file__).parent
UPSTREAM = "RAYGRID_TRIMESH_TESTS"


@pytest.mark.skipif(UPSTREAM not in os.environ, reason=f"{UPSTREAM} does not name the tests of trimesh's sources")
@pytest.mark.parametrize(("file", "count"), [("test_ray.py", 11), ("test_ray_upstream.py", 19)])
def test_their_ray_tests(file: str, count: int) -> None:
    """The tests come from trimesh's source distribution; test.sh fetches it."""
    path = pathlib.Path(os.environ[UPSTREAM], file)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "raygrid_as_engine", "-p", "no:cacheprovider", str(path)]
    environment = os.environ | {"PYTHONPATH": str(HERE / "trimesh_ray")}
    done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, cwd=path.parent, check=False)
    assert done.returncode == 0, done.stdout
    passed = re.search(r"^(\d+) passed in|^(\d+) passed, \d+ warnings? in", done.stdout, re.MULTILINE)
    assert passed, f"not all of them ran: {done.stdout}"
    assert int(passed[1] or passed[2]) == count, done.stdout


def rays(mesh: trimesh.Trimesh, count: int = 500) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(3)
    return random.normal(size=(count, 3)) * mesh.scale, random.normal(size=(count, 3))


MESHES = {
    "ball": trimesh.creation.icosphere(subdivisions=2),
    "torus": trimesh.creation.torus(2, 0.7),
    "far": trimesh.creation.icosphere(subdivisions=2).apply_translation([1e3, 2e3, -1e3]),
}


@pytest.mark.parametrize("name", MESHES)
def test_same_as_their_engine(name: str) -> None:
    mesh = MESHES[name]
    origins, directions = rays(mesh)
    directions = mesh.bounds.mean(axis=0) + directions - origins
    theirs, ours = trimesh.ray.ray_triangle.RayMeshIntersector(mesh), RayMeshIntersector(mesh)
    assert (theirs.intersects_any(origins, directions) == ours.intersects_any(origins, directions)).all()
    assert ours.intersects_any(origins, directions).any()
    their_tri, their_ray, _ = theirs.intersects_id(origins, directions, return_locations=True)
    our_tri, our_ray, where = ours.intersects_id(origins, directions, return_locations=True)
    assert sorted(zip(their_ray, their_tri, strict=True)) == sorted(zip(our_ray, our_tri, strict=True))
    t = np.einsum("ij,ij->i", where - origins[our_ray], directions[our_ray])
    assert (np.diff(t)[np.diff(our_ray) == 0] > 0).all(), "hits are not in the order along the rays"
    first = ours.intersects_first(origins, directions)
    index_tri, index_ray = ours.intersects_id(origins, directions, multiple_hits=False)
    assert (first[index_ray] == index_tri).all() and (np.delete(first, index_ray) == -1).all()


def test_edges_and_vertices_count_once() -> None:
    """Triangles that share a vertex are met there at the same t but for the last bits."""
    box = trimesh.creation.box().subdivide().subdivide()
    turned = trimesh.creation.icosphere(subdivisions=3, radius=0.37)
    turned.apply_transform(trimesh.transformations.rotation_matrix(0.7, [1, 2, 3]))
    for mesh in (box, turned):
        for origin in ([0.0, 0, 0], [0.01, 0.02, 0.03]):
            targets = np.concatenate([mesh.vertices, mesh.vertices[mesh.edges_unique].mean(axis=1)])
            origins = np.tile(origin, (len(targets), 1))
            _, index_ray = RayMeshIntersector(mesh).intersects_id(origins, targets - origins)
            assert (np.bincount(index_ray, minlength=len(targets)) == 1).all()


def test_at_most_so_many_hits() -> None:
    balls = trimesh.util.concatenate(
        [trimesh.creation.icosphere().apply_translation([0, 0, 4 * i]) for i in range(5)]
    )
    ours = RayMeshIntersector(balls)
    one = [[0.1, 0.2, -9]], [[0, 0, 1]]
    assert [len(ours.intersects_id(*one, max_hits=most)[0]) for most in (None, 3, 1)] == [10, 3, 1]


def test_contains_points() -> None:
    torus = MESHES["torus"]
    points = np.random.default_rng(4).uniform(-3, 3, (1000, 3))
    torus = trimesh.Trimesh(torus.vertices, torus.faces)
    theirs = trimesh.ray.ray_triangle.RayMeshIntersector(torus).contains_points(points)
    assert theirs.any() and (RayMeshIntersector(torus).contains_points(points) == theirs).all()


def test_follows_the_mesh() -> None:
    box = trimesh.creation.box()
    box.ray = RayMeshIntersector(box)
    ray = [[0, 0, -5]], [[0, 0, 1]]
    assert box.ray.intersects_any(*ray).tolist() == [True]
    box.apply_translation([3, 0, 0])
    assert box.ray.intersects_any(*ray).tolist() == [False]


def test_no_triangles() -> None:
    nothing = RayMeshIntersector(trimesh.Trimesh())
    assert nothing.intersects_first([[0, 0, 0]], [[0, 0, 1]]).tolist() == [-1]
    assert nothing.intersects_location([[0, 0, 0]], [[0, 0, 1]])[0].shape == (0, 3)


def test_copies_and_pickles() -> None:
    box = trimesh.creation.box()
    ours = RayMeshIntersector(box)
    ray = [[0.1, 0.2, -5]], [[0, 0, 1]]
    wanted = ours.intersects_first(*ray)
    for other in (copy.copy(ours), copy.deepcopy(ours), pickle.loads(pickle.dumps(ours))):
        assert (other.intersects_first(*ray) == wanted).all()


def test_shapes_must_agree() -> None:
    with pytest.raises(ValueError, match=r"\(2, 3\), ray_directions \(1, 3\)"):
        RayMeshIntersector(MESHES["ball"]).intersects_id(np.zeros((2, 3)), np.ones((1, 3)))


def test_a_scene_of_theirs() -> None:
    world = trimesh.Scene()
    ball = trimesh.creation.icosphere()
    for i in range(3):
        matrix = trimesh.transformations.rotation_matrix(0.3 * i, [0, 1, 0], [0, 0, 0])
        matrix[:3, 3] = [5 * i, 0, 10]
        world.add_geometry(ball, node_name=f"ball {i}", geom_name="ball", transform=matrix)
    world.add_geometry(trimesh.PointCloud([[0, 0, 1]]), node_name="points")
    with raygrid.Scene() as scene:
        ids = insert(scene, world)
        assert set(ids) == {"ball 0", "ball 1", "ball 2"}
        assert len({scene.lookup(one).shape for one in ids.values()}) == 1
        hits = scene.trace([[0, 0, 0], [5, 0, 0], [10, 0, 0]], (0.01, 0.02, 1))
        assert hits.object.tolist() == [ids["ball 0"], ids["ball 1"], ids["ball 2"]]
        assert set(insert(scene, ball)) and scene.stats().objects == 4
