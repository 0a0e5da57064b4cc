# SPDX-License-Identifier: MIT
"""Grids: where a scene keeps its objects. A scene has one from the start, and nobody needs to know of it."""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import check
from ._raygrid import ffi, lib
from ._shapes import triple

if TYPE_CHECKING:
    from ._scene import Scene

REBUILD_NEVER: float = lib.RG_REBUILD_NEVER


class GridKind(enum.IntEnum):
    """How a grid stores its objects; see raygrid/grid.h."""

    DEFAULT = lib.RG_GRID_DEFAULT
    UNIFORM = lib.RG_GRID_UNIFORM
    HIERARCHICAL = lib.RG_GRID_HIERARCHICAL
    LOOSE = lib.RG_GRID_LOOSE


@dataclass(frozen=True)
class GridConfig:
    """How a grid is made.

    kind: how it stores its objects.
    resolution: cells along the longest side of its box at the finest level; 0: from the number of objects.
    lo, hi: corners of the first physical box, (3,); not given: from the objects.
    rebuild_factor: rebuild when the logical diagonal exceeds the physical one by this; 0: 2; REBUILD_NEVER.
    """

    kind: GridKind | int = GridKind.DEFAULT
    resolution: int = 0
    lo: ArrayLike = (0.0, 0.0, 0.0)
    hi: ArrayLike = (0.0, 0.0, 0.0)
    rebuild_factor: float = 0.0

    def _struct(self) -> Any:
        return ffi.new(
            "rg_grid_config *",
            {
                "size": ffi.sizeof("rg_grid_config"),
                "kind": int(self.kind),
                "resolution": self.resolution,
                "lo": triple(self.lo, "lo"),
                "hi": triple(self.hi, "hi"),
                "rebuild_factor": float(self.rebuild_factor),
            },
        )


@dataclass(frozen=True, eq=False)
class GridReport:
    """What is known of a grid; see raygrid/grid.h."""

    kind: GridKind
    levels: int
    levels_used: int
    resolution: tuple[int, int, int]
    physical_lo: NDArray[np.float64]
    physical_hi: NDArray[np.float64]
    logical_lo: NDArray[np.float64]
    logical_hi: NDArray[np.float64]
    objects: int
    entries: int
    unbounded: int
    tiles: int
    rebuilds: int
    rebuilding: bool


class Grid:
    """A grid of a scene: Scene.grid, or what Scene.create_grid made."""

    __slots__ = ("_id", "_scene")

    def __init__(self, scene: Scene, id: int) -> None:
        self._scene = scene
        self._id = id

    @property
    def scene(self) -> Scene:
        """The scene that it belongs to."""
        return self._scene

    def stats(self) -> GridReport:
        """What is known of the grid.

        >>> from raygrid import Scene, Sphere
        >>> with Scene() as scene:
        ...     ids = scene.insert(Sphere(), [[0, 0, 0], [5, 0, 0]])
        ...     scene.grid.stats().objects
        2
        """
        report = ffi.new("rg_grid_report *", {"size": ffi.sizeof("rg_grid_report")})
        check(lib.rg_grid_stats(self._scene._open(), self._id, report))
        boxes = ("physical_lo", "physical_hi", "logical_lo", "logical_hi")
        counts = ("levels", "levels_used", "objects", "entries", "unbounded", "tiles", "rebuilds")
        same: dict[str, Any] = {name: np.array(list(getattr(report, name))) for name in boxes}
        same.update((name, getattr(report, name)) for name in counts)
        x, y, z = report.resolution
        return GridReport(
            kind=GridKind(report.kind), resolution=(x, y, z), rebuilding=bool(report.rebuilding), **same
        )

    def rebuild(self) -> None:
        """Rebuilds the grid now, with a box and a resolution that fit its objects."""
        check(lib.rg_grid_rebuild(self._scene._open(), self._id))

    def configure(self, config: GridConfig) -> None:
        """Changes kind, resolution, box or factor, and rebuilds the grid."""
        check(lib.rg_grid_configure(self._scene._open(), self._id, config._struct()))

    def destroy(self) -> None:
        """Destroys the grid, which must be empty and not the scene's own."""
        check(lib.rg_grid_destroy(self._scene._open(), self._id))

    def __eq__(self, other: object) -> bool:
        return (self._scene, self._id) == (other._scene, other._id) if isinstance(other, Grid) else NotImplemented

    def __hash__(self) -> int:
        return hash((self._scene, self._id))

    def __reduce__(self) -> NoReturn:
        raise TypeError("a raygrid.Grid can't be pickled or copied: it is a part of its scene")

    def __repr__(self) -> str:
        report = self.stats()
        x, y, z = report.resolution
        cells = f"{x} x {y} x {z} cells" if report.levels else "no cells yet"
        return f"<raygrid.Grid {self._id}: {report.kind.name.lower()}, {cells}, {report.objects} objects>"
