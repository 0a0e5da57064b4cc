# SPDX-License-Identifier: MIT
"""trimesh: its meshes and scenes as raygrid's, and raygrid as the engine of `Trimesh.ray`."""

from __future__ import annotations

from typing import Any

import numpy as np
import trimesh
from numpy.typing import ArrayLike, NDArray
from trimesh.caching import Cache, cache_decorator
from trimesh.ray.ray_util import contains_points

from .. import Grid, Hits, Mesh, Scene

Indices = NDArray[np.int64]

# A ray along a surface would be sent on by any distance: at less than this cosine to the normal it counts as this.
LEAST_COS = 1e-6


def shape(mesh: trimesh.Trimesh) -> Mesh:
    """A trimesh.Trimesh as a shape; triangle numbers stay. It must have triangles."""
    return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces))


def insert(
    scene: Scene,
    geometry: trimesh.Scene | trimesh.Trimesh,
    *,
    mask: ArrayLike | None = None,
    grid: Grid | None = None,
) -> dict[str, np.uint64]:
    """Inserts all meshes of a trimesh.Scene, each geometry as one shape. Returns ids by the names of the nodes.

    Nodes of anything else, such as point clouds, are left out. The linear part of a transform becomes float32.

    >>> import raygrid
    >>> world = trimesh.Scene()
    >>> node = world.add_geometry(trimesh.creation.box(), node_name="crate",
    ...                           transform=trimesh.transformations.translation_matrix((0, 0, 5)))
    >>> with raygrid.Scene() as scene:
    ...     ids = insert(scene, world)
    ...     scene.trace((0.1, 0.2, 0), (0, 0, 1)).object == ids["crate"]
    array([ True])
    """
    graph = geometry.graph if isinstance(geometry, trimesh.Scene) else trimesh.Scene(geometry).graph
    meshes = (
        geometry.geometry if isinstance(geometry, trimesh.Scene) else dict.fromkeys(graph.geometry_nodes, geometry)
    )
    names, shapes, transforms = [], [], []
    shared: dict[int, Mesh] = {}  # by the identity of the mesh: its name may differ from node to node
    for node in graph.nodes_geometry:
        transform, name = graph[node]
        mesh = meshes[name]
        if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces):
            if id(mesh) not in shared:
                shared[id(mesh)] = shape(mesh)
            names.append(node)
            shapes.append(shared[id(mesh)])
            transforms.append(transform)
    matrices = np.array(transforms, np.float64).reshape(-1, 4, 4)
    ids = scene.insert(shapes, matrices[:, :3, 3], linear=matrices[:, :3, :3], mask=mask, grid=grid)
    return dict(zip(names, ids, strict=True))


class RayMeshIntersector:
    """A drop-in for trimesh.ray: assign it to `mesh.ray`. It follows changes of the mesh.

    `scale_to_box` is what trimesh's engine for Embree takes, and has no effect: all is computed in double, where
    distance from the origin and size don't matter.
    """

    def __init__(self, geometry: trimesh.Trimesh, scale_to_box: bool = True) -> None:
        self.mesh = geometry
        self._cache: Any = Cache(id_function=geometry.__hash__)  # type: ignore[no-untyped-call]

    @cache_decorator  # type: ignore[untyped-decorator, unused-ignore]
    def _scene(self) -> Scene:
        scene = Scene()
        if len(self.mesh.faces):
            scene.insert(shape(self.mesh))
        return scene

    def _trace(self, origins: ArrayLike, directions: ArrayLike, fields: tuple[str, ...], **options: Any) -> Hits:
        scene: Scene = self._scene
        return scene.trace(origins, directions, fields=fields, **options)

    def _all(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        multiple_hits: bool = True,
        max_hits: int | None = None,
    ) -> tuple[Indices, Indices, NDArray[np.float64]]:
        """Triangles, rays and places of all hits, in the order of the rays, and along each."""
        origins, directions = np.atleast_2d(ray_origins), np.atleast_2d(ray_directions)
        if origins.shape != directions.shape:
            raise ValueError(f"ray_origins has the shape {origins.shape}, ray_directions {directions.shape}")
        fields = ("t", "primitive", "position", "normal", "offset")
        live = np.arange(len(origins))
        t_min = np.zeros(len(origins))
        rays, triangles, places = [live[:0]], [live[:0]], [np.empty((0, 3))]
        while len(live):
            hits = self._trace(origins[live], directions[live], fields, t_min=t_min)
            hit = np.isfinite(hits.t)
            live = live[hit]
            rays.append(live)
            triangles.append(hits.primitive[hit].astype(np.int64))
            places.append(hits.position[hit])
            if not multiple_hits or len(rays) - 1 == max_hits:
                break
            t_min = beyond(directions[live], hits.t[hit], hits.normal[hit], hits.offset[hit])
        index_ray = np.concatenate(rays)
        order = np.argsort(index_ray, kind="stable")
        return np.concatenate(triangles)[order], index_ray[order], np.concatenate(places)[order]

    def intersects_id(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike, return_locations: bool = False, **kwargs: Any
    ) -> tuple[Indices, Indices] | tuple[Indices, Indices, NDArray[np.float64]]:
        """Triangles that rays hit: (index_tri, index_ray), and with `return_locations` where, (H, 3).

        In the order of the rays, and along each. Where a ray crosses an edge or a vertex, one triangle counts.

        ray_origins, ray_directions: (N, 3).
        multiple_hits: all hits along each ray, which is the default, at most `max_hits`; or the first alone.
        """
        found = self._all(ray_origins, ray_directions, **kwargs)
        return found if return_locations else found[:2]

    def intersects_location(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike, **kwargs: Any
    ) -> tuple[NDArray[np.float64], Indices, Indices]:
        """Where rays hit: (locations, index_ray, index_tri). Arguments as intersects_id."""
        index_tri, index_ray, locations = self._all(ray_origins, ray_directions, **kwargs)
        return locations, index_ray, index_tri

    def intersects_first(self, ray_origins: ArrayLike, ray_directions: ArrayLike, **kwargs: Any) -> Indices:
        """The first triangle that each ray hits, (N,); -1: none."""
        hits = self._trace(ray_origins, ray_directions, ("t", "primitive"))
        return np.where(np.isfinite(hits.t), hits.primitive.astype(np.int64), -1)

    def intersects_any(self, ray_origins: ArrayLike, ray_directions: ArrayLike, **kwargs: Any) -> NDArray[np.bool_]:
        """Whether each ray hits anything, (N,)."""
        scene: Scene = self._scene
        return scene.occluded(ray_origins, ray_directions).view(np.bool_)

    def contains_points(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Whether the mesh, which should be closed, contains each of the points (N, 3)."""
        inside: NDArray[np.bool_] = contains_points(self, points)
        return inside

    def __getstate__(self) -> dict[str, Any]:
        return {"mesh": self.mesh}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(state["mesh"])  # type: ignore[misc]

    def __copy__(self) -> RayMeshIntersector:
        return RayMeshIntersector(self.mesh)

    def __deepcopy__(self, memo: dict[int, Any]) -> RayMeshIntersector:
        return RayMeshIntersector(self.mesh)


def beyond(
    directions: NDArray[Any], t: NDArray[Any], normals: NDArray[Any], offsets: NDArray[Any]
) -> NDArray[np.float64]:
    """The least t from which a ray does not meet again the spot of the surface that it hit at `t`."""
    along = np.abs(np.einsum("ij,ij->i", directions, normals))
    least = LEAST_COS * np.linalg.norm(directions, axis=1)
    further: NDArray[np.float64] = np.maximum(np.nextafter(t, np.inf), t + offsets / np.maximum(along, least))
    return further
