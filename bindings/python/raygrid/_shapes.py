# SPDX-License-Identifier: MIT
"""Shapes: geometry that objects share."""

from __future__ import annotations

import contextlib
import enum
import itertools
from collections.abc import Callable, Iterator
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays
from ._errors import check
from ._raygrid import ffi, lib

Triple = tuple[float, float, float]


def triple(value: ArrayLike, name: str) -> list[float]:
    array = _arrays.floats(value, name)
    if array.shape != (3,):
        raise ValueError(f"{name} must have the shape (3,), not {_arrays.seen(array)}")
    return [float(number) for number in array]


class Shape:
    """Geometry in its own frame, which any number of objects in any number of scenes share.

    Made by Sphere, Box, Capsule or Mesh, and never changed. An object holds on to its shape: one that was inserted
    need not be kept.
    """

    __slots__ = ("_address", "_pointer")

    _pointer: Any
    _address: int

    def __init__(self) -> None:
        raise TypeError("shapes are made by Sphere, Box, Capsule or Mesh")

    def _create(self, create: Callable[..., int], *arguments: Any, config: Any = ffi.NULL) -> None:
        made = ffi.new("rg_shape **")
        check(create(config, *arguments, made))
        self._own(made[0])

    def _own(self, pointer: Any) -> None:
        """Takes over one reference."""
        self._pointer = ffi.gc(pointer, lib.py_shape_end)
        self._address = int(ffi.cast("uintptr_t", pointer))

    def _report(self) -> Any:
        report = ffi.new("rg_shape_report *", {"size": ffi.sizeof("rg_shape_report")})
        check(lib.rg_shape_stats(self._pointer, report))
        return report

    @property
    def bounds(self) -> NDArray[np.float64]:
        """The lowest and the highest corner of the box that holds the shape, in its own frame; (2, 3) float64."""
        report = self._report()
        return np.array([list(report.lo), list(report.hi)])

    @property
    def triangle_count(self) -> int:
        """The number of triangles of a mesh; 0 for all other shapes."""
        return int(self._report().triangle_count)

    @property
    def nbytes(self) -> int:
        """Bytes of memory that the shape holds."""
        return int(self._report().bytes)

    def __eq__(self, other: object) -> bool:
        return self._address == other._address if isinstance(other, Shape) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._address)

    def __reduce__(self) -> NoReturn:
        raise TypeError(f"a raygrid.{type(self).__name__} can't be pickled or copied: make it anew from its numbers")

    def __repr__(self) -> str:
        (lo, hi), triangles = self.bounds.tolist(), self.triangle_count
        size = f"{triangles} triangles, " if triangles else ""
        return f"<raygrid.{type(self).__name__}: {size}from {tuple(lo)} to {tuple(hi)}, {self.nbytes} bytes>"


class Sphere(Shape):
    """A sphere around the origin of its frame.

    Spheres of many radii are one Sphere(1), inserted with a scale each.

    >>> Sphere(2).bounds.tolist()
    [[-2.0, -2.0, -2.0], [2.0, 2.0, 2.0]]
    """

    __slots__ = ()

    def __init__(self, radius: float = 1.0) -> None:
        self._create(lib.rg_shape_create_sphere, float(radius))


class Box(Shape):
    """A box with its faces in the axes' planes, from the corner `lo` to the corner `hi`, both (3,).

    It may be flat, and endless on any axis (lo -inf, hi inf). Faces are primitives 0 to 5: -x, +x, -y, +y, -z, +z.

    >>> Box((0, 0, 0), (1, 2, 3)).bounds.tolist()
    [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]]
    """

    __slots__ = ()

    def __init__(self, lo: ArrayLike, hi: ArrayLike) -> None:
        self._create(lib.rg_shape_create_box, triple(lo, "lo"), triple(hi, "hi"))


class Capsule(Shape):
    """All points within `radius` of the segment from `a` to `b`, both (3,).

    >>> Capsule((0, 0, 0), (0, 0, 4), 1).bounds.tolist()
    [[-1.0, -1.0, -1.0], [1.0, 1.0, 5.0]]
    """

    __slots__ = ()

    def __init__(self, a: ArrayLike, b: ArrayLike, radius: float) -> None:
        self._create(lib.rg_shape_create_capsule, triple(a, "a"), triple(b, "b"), float(radius))


class MeshQuality(enum.IntEnum):
    """How much is done for rays when a mesh is made."""

    BEST = lib.RG_MESH_BEST
    FAST = lib.RG_MESH_FAST


class Mesh(Shape):
    """Triangles.

    vertices: (V, 3) float32 or float64.
    indices: three vertices of each triangle, (T, 3) or (3 * T,) of any integer dtype; without them, triangle i has
    the vertices 3 * i, 3 * i + 1 and 3 * i + 2.
    quality: BEST is what rays go through fastest; FAST is made fastest, for a mesh of which few rays are asked before
    it changes. No answer depends on it.
    workers: threads that make it, the calling one among them. They end before the call does.
    borrow: what the mesh needs of the arrays later it reads where it lies; else that is copied. It needs vertices
    that are not all float32, in whichever type, and the indices of triangles that hardly share vertices. The mesh
    holds on to such arrays, until no object and no one else has it any more: they must not be changed meanwhile, or
    hits of it may be wrong.

    >>> Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).triangle_count
    1
    """

    __slots__ = ()

    def __init__(
        self,
        vertices: ArrayLike,
        indices: ArrayLike | None = None,
        *,
        quality: MeshQuality = MeshQuality.BEST,
        workers: int = 1,
        borrow: bool = False,
    ) -> None:
        views, arrays = _views(vertices)
        if indices is not None:
            triangles = _arrays.unsigned(indices, "indices", INDEX_TYPES)
            if triangles.ndim == 1 and triangles.size % 3 == 0:
                triangles = triangles.reshape(-1, 3)
            if triangles.ndim != 2 or triangles.shape[1] != 3:
                raise ValueError(f"indices must have the shape (T, 3) or (3 * T,), not {_arrays.seen(triangles)}")
            lib.py_input3(views, ffi.offsetof("rg_mesh_views", "indices"), *three(triangles))
            views.triangle_count = len(triangles)
            arrays.append(triangles)
        with _lending(views, arrays, borrow):
            self._create(lib.rg_shape_create_mesh, views, config=_config(quality, workers))

    def deformed(
        self,
        vertices: ArrayLike,
        *,
        quality: MeshQuality = MeshQuality.BEST,
        workers: int = 1,
        borrow: bool = False,
    ) -> Mesh:
        """A mesh of these triangles with new vertices, made much faster than a new one: (V, 3), V as before.

        This one stays as it is: Scene.replace_shape puts the new one in its place. quality, workers: as for Mesh, for
        the case that the vertices have moved so much against each other that it is made anew. borrow: as for Mesh.

        >>> import numpy as np
        >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
        >>> Mesh(corners, [[0, 1, 2]]).deformed(2 * corners).bounds[1].tolist()
        [2.0, 2.0, 0.0]
        """
        views, arrays = _views(vertices)
        mesh = Mesh.__new__(Mesh)
        with _lending(views, arrays, borrow):
            mesh._create(lib.rg_shape_create_deformed, self._pointer, views, config=_config(quality, workers))
        return mesh


# Arrays that meshes read, by the number under which the library gives them back.
_lent: dict[int, list[NDArray[Any]]] = {}
_numbers = itertools.count(1)


@ffi.def_extern()  # type: ignore[untyped-decorator]
def py_released(user: Any) -> None:
    del _lent[int(ffi.cast("uintptr_t", user))]


@contextlib.contextmanager
def _lending(views: Any, arrays: list[NDArray[Any]], borrow: bool) -> Iterator[None]:
    """Lends the arrays to the mesh that is made of the views meanwhile, if it may borrow them."""
    if not borrow:
        yield
        return
    number = next(_numbers)
    _lent[number] = arrays
    views.released, views.user = lib.py_released, ffi.cast("void *", number)
    try:
        yield
    except BaseException:
        del _lent[number]  # nothing reads them, and nothing will tell so
        raise


def _views(vertices: ArrayLike) -> tuple[Any, list[NDArray[Any]]]:
    """Views of the vertices, to which triangles may be added; and what they lead to, to be kept as long."""
    corners = _arrays.floats(vertices, "vertices")
    if corners.ndim != 2 or corners.shape[1] != 3:
        raise ValueError(f"vertices must have the shape (V, 3), not {_arrays.seen(corners)}")
    views = ffi.new("rg_mesh_views *", {"size": ffi.sizeof("rg_mesh_views")})
    lib.py_input3(views, ffi.offsetof("rg_mesh_views", "vertices"), *three(corners))
    views.vertex_count = len(corners)
    views.triangle_count = len(corners) // 3
    return views, [corners]


def _config(quality: MeshQuality, workers: int) -> Any:
    size = ffi.sizeof("rg_shape_config")
    return ffi.new("rg_shape_config *", {"size": size, "quality": int(quality), "workers": workers})


INDEX_TYPES = (np.dtype(np.uint16), _arrays.U32, _arrays.U64)


def three(array: NDArray[Any]) -> tuple[Any, int, int, int]:
    return _arrays.pointer(array), array.strides[0], array.strides[1], _arrays.TYPES[array.dtype]


CLASSES: dict[int, type[Shape]] = {
    lib.RG_SHAPE_SPHERE: Sphere,
    lib.RG_SHAPE_BOX: Box,
    lib.RG_SHAPE_CAPSULE: Capsule,
    lib.RG_SHAPE_MESH: Mesh,
}


def taking_over(pointer: Any) -> Shape:
    """The shape that a pointer is to, with the reference that it stands for."""
    report = ffi.new("rg_shape_report *", {"size": ffi.sizeof("rg_shape_report")})
    check(lib.rg_shape_stats(pointer, report))
    kind = CLASSES.get(report.kind, Shape)
    shape = kind.__new__(kind)
    shape._own(pointer)
    return shape
