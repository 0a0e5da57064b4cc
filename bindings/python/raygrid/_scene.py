# SPDX-License-Identifier: MIT
"""Scenes: their objects and their queries."""

from __future__ import annotations

import atexit
import enum
import functools
import os
import weakref
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import TracebackType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _bytes, _hits, _shapes
from ._errors import check, error
from ._grids import Grid, GridConfig
from ._hits import Hits
from ._raygrid import ffi, lib
from ._shapes import Shape


class Cull(enum.IntEnum):
    """Which sides of surfaces rays pass through."""

    NONE = lib.RG_CULL_NONE
    BACK = lib.RG_CULL_BACK
    FRONT = lib.RG_CULL_FRONT


class Isa(enum.IntEnum):
    """The instructions that the kernels of a scene use."""

    PORTABLE = lib.RG_ISA_PORTABLE
    SSE2 = lib.RG_ISA_SSE2
    AVX2 = lib.RG_ISA_AVX2
    AVX512 = lib.RG_ISA_AVX512
    NEON = lib.RG_ISA_NEON


class Without(enum.IntFlag):
    """What traces of a scene do without, because it holds nothing that needs it."""

    BOXES = lib.RG_WITHOUT_BOXES
    MASKS = lib.RG_WITHOUT_MASKS
    UNBOUNDED = lib.RG_WITHOUT_UNBOUNDED
    TILES = lib.RG_WITHOUT_TILES
    LEVELS = lib.RG_WITHOUT_LEVELS
    GRIDS = lib.RG_WITHOUT_GRIDS
    THREADS = lib.RG_WITHOUT_THREADS


@dataclass(frozen=True)
class SceneReport:
    """What is known of a scene: counts, bytes of memory (shapes not counted), threads that trace together, the
    instructions that its kernels use, and what its traces leave out."""

    objects: int
    slots: int
    bytes: int
    invalid_rays: int
    workers: int
    grids: int
    isa: Isa
    left_out: Without


@dataclass(frozen=True, eq=False)
class ObjectReport:
    """What is known of an object: world = position + scale * linear @ local, and the world box from lo to hi."""

    position: NDArray[np.float64]
    linear: NDArray[np.float32]
    scale: float
    shape: Shape
    mask: int
    grid: Grid
    lo: NDArray[np.float64]
    hi: NDArray[np.float64]


class Candidate(NamedTuple):
    """A possible hit, as a filter sees it."""

    t: float
    object: int
    primitive: int
    position: tuple[float, float, float]
    normal: tuple[float, float, float]
    u: float
    v: float


Filter = Callable[[int, Candidate], object]


class _Filtering:
    """A filter while a trace runs, and what it raised."""

    def __init__(self, function: Filter) -> None:
        self.function = function
        self.raised: BaseException | None = None


@ffi.def_extern(error=-1)  # type: ignore[untyped-decorator]
def py_filter(user: Any, index: int, hit: Any) -> int:
    filtering: _Filtering = ffi.from_handle(user)
    (x, y, z), (a, b, c) = hit.position, hit.normal
    candidate = Candidate(hit.t, hit.object, hit.primitive, (x, y, z), (a, b, c), hit.u, hit.v)
    try:
        return 1 if filtering.function(index, candidate) else 0
    except BaseException as raised:
        if filtering.raised is None:
            filtering.raised = raised
        return -1


@ffi.def_extern()  # type: ignore[untyped-decorator]
def py_log(user: Any, message: Any) -> None:
    ffi.from_handle(user)(ffi.string(message).decode(errors="replace"))


# Where views are in a py_trace.
RAYS_AT = {name: ffi.offsetof("py_trace", "rays", name) for name in ("t_min", "t_max", "mask")}
OCCLUDED_AT = ffi.offsetof("py_trace", "occluded")

py_scene_trace = lib.py_scene_trace  # looking it up in lib takes longer than in a module

# Scenes that a forked child must not touch: their workers and whoever held their locks are not there.
_alive: weakref.WeakSet[Scene] = weakref.WeakSet()


def _leave_to_parent() -> None:
    for scene in _alive:
        if scene._handle is not None:
            ffi.gc(scene._handle, None)
            scene._handle = None
            scene._closed = "the scene belongs to the parent process: make one in this process"


def _end_recordings() -> None:
    """While what they are written with is still there."""
    for scene in list(_alive):
        if scene._handle is not None:
            scene._end_recording(scene._handle)


def _load(data: bytes, workers: int) -> Scene:
    return Scene.load(data, workers=workers)


def _end_frame(leader: Any, pointer: Any) -> None:
    lib.py_scene_end(pointer)


os.register_at_fork(after_in_child=_leave_to_parent)
atexit.register(_end_recordings)


class Scene:
    """Objects that rays hit. All calls act at once: the next trace sees them.

    workers: threads that trace large calls together, the calling one among them; 0: one a processor.
    grid: how the scene's own grid is made.
    log: is called with a line of text when a grid is rebuilt; it must not use the scene.
    memory_limit: bytes that the scene may hold (SceneReport.bytes); what needs more raises OutOfMemory. 0: no limit.

    Any number of threads may use a scene at once; traces run side by side and release the interpreter. close(), or
    the end of a `with`, ends it as soon as no other thread is inside a call; after it, every call raises ValueError.

    >>> from raygrid import Scene, Sphere
    >>> with Scene() as scene:
    ...     ball = scene.insert(Sphere(1), (0, 0, 5))
    ...     scene.trace((0, 0, 0), (0, 0, 1)).t
    array([4.])
    """

    __slots__ = ("__weakref__", "_closed", "_handle", "_log", "_recording", "_workers")

    def __init__(
        self,
        *,
        workers: int = 0,
        grid: GridConfig | None = None,
        log: Callable[[str], object] | None = None,
        memory_limit: int = 0,
    ) -> None:
        self._handle: Any = None
        self._recording: Any = None
        self._closed = "the scene was not made"
        self._workers = workers
        own_grid = None if grid is None else grid._struct()
        self._create(lib.rg_scene_create, ffi.new("rg_scene **"), own_grid, log, memory_limit)

    @classmethod
    def _make(
        cls, create: Callable[..., int], made: Any, *, workers: int, log: Callable[[str], object] | None
    ) -> Scene:
        """A scene that another call of the library makes."""
        scene = cls.__new__(cls)
        scene._handle = scene._recording = None
        scene._closed = "the scene was not made"
        scene._workers = workers
        scene._create(create, made, None, log)
        return scene

    def _create(
        self,
        create: Callable[..., int],
        made: Any,
        grid: Any,
        log: Callable[[str], object] | None,
        memory_limit: int = 0,
        leader: Any = None,
    ) -> None:
        config = ffi.new("rg_scene_config *", {"size": ffi.sizeof("rg_scene_config"), "workers": self._workers})
        config.memory_limit = memory_limit
        if grid is not None:
            config.grid = grid
        self._log = None if log is None else (log, ffi.new_handle(log))
        if self._log is not None:
            config.log = lib.py_log
            config.log_user = self._log[1]
        check(create(config, made))
        # The pointer ends the scene when it is dropped by the last call that uses it; that of a frame's leader, which
        # it holds, afterwards.
        end = lib.py_scene_end if leader is None else functools.partial(_end_frame, leader)
        self._handle = ffi.gc(made[0], end)
        self._closed = "the scene is closed"
        _alive.add(self)

    def _open(self) -> Any:
        handle = self._handle
        if handle is None:
            raise ValueError(self._closed)
        return handle

    def close(self) -> None:
        """Ends the scene and all its objects. Does nothing the second time."""
        handle, self._handle = self._handle, None
        if handle is not None:
            self._end_recording(handle)

    def __del__(self) -> None:
        handle = getattr(self, "_handle", None)
        if handle is not None and self._recording is not None:
            self._end_recording(handle)

    def __enter__(self) -> Scene:
        self._open()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, raised: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    # ------------------------------------------------------------------------------------------- objects

    def insert(
        self,
        shapes: Shape | Iterable[Shape],
        positions: ArrayLike = (0.0, 0.0, 0.0),
        *,
        linear: ArrayLike | None = None,
        scale: ArrayLike | None = None,
        mask: ArrayLike | None = None,
        grid: Grid | None = None,
    ) -> NDArray[np.uint64]:
        """Inserts N objects: all, or on any error none. Returns their ids, (N,) uint64.

        A local point of an object is in the world at position + scale * linear @ point.

        shapes: one for all, or N.
        positions: (3,) or (N, 3) float64 or float32.
        linear: (3, 3) or (N, 3, 3), used as float32: rotation, mirror, shear; the identity if not given.
        scale: a number or (N,); 1 if not given.
        mask: a uint32 or (N,) of them; a ray sees the object if their masks share a bit. All bits if not given.
        grid: where the objects are kept; the scene's own grid if not given.

        >>> from raygrid import Scene, Sphere
        >>> with Scene() as scene:
        ...     ids = scene.insert(Sphere(), [[0, 0, 5], [9, 0, 5]], scale=[1, 2])
        ...     scene.trace([[0, 0, 0], [9, 0, 0]], (0, 0, 1)).t
        array([4., 3.])
        """
        handle = self._open()
        views = ffi.new("rg_insert_views *", {"size": ffi.sizeof("rg_insert_views")})
        poses, counts, kept = self._poses(positions, linear, scale)
        if isinstance(shapes, Shape):
            pointers = np.array([shapes._address], np.uintp)
        else:
            shapes = tuple(shapes)
            for shape in shapes:
                if not isinstance(shape, Shape):
                    raise TypeError(f"shapes must be a Shape or Shapes, not {type(shape).__name__}")
            pointers = np.fromiter((shape._address for shape in shapes), np.uintp, len(shapes))
            views.shapes_stride = pointers.itemsize
            counts["shapes"] = len(shapes)
        views.shapes = _arrays.pointer(pointers)
        views.poses = poses
        if mask is not None:
            masks, counts["mask"], *view = _arrays.unsigned_numbers(mask, "mask", _arrays.U32)
            lib.py_input(views, ffi.offsetof("rg_insert_views", "mask"), *view)
        if grid is not None:
            if grid.scene is not self:
                raise ValueError("grid belongs to another scene")
            views.grid = grid._id
        ids = np.empty(_arrays.count_of(**counts), np.uint64)
        output = ffi.new("rg_output *", (_arrays.pointer(ids), ids.itemsize, lib.RG_U64))
        check(lib.rg_scene_insert_many(handle, views, len(ids), output))
        return ids

    def move(
        self,
        objects: ArrayLike,
        positions: ArrayLike,
        *,
        linear: ArrayLike | None = None,
        scale: ArrayLike | None = None,
    ) -> None:
        """Moves N objects: all, or on any error none.

        objects: an id, or (N,) uint64.
        positions, linear, scale: as in insert; what is not given, each object keeps.

        >>> from raygrid import Scene, Sphere
        >>> with Scene() as scene:
        ...     ball = scene.insert(Sphere(), (0, 0, 5))
        ...     scene.move(ball, (0, 0, 9))
        ...     scene.trace((0, 0, 0), (0, 0, 1)).t
        array([8.])
        """
        handle = self._open()
        poses, counts, kept = self._poses(positions, linear, scale)
        ids = self._ids(objects)
        count = _arrays.count_of(objects=len(ids), **counts)
        check(lib.rg_scene_move_many(handle, self._input(ids), poses, count))

    def remove(self, objects: ArrayLike) -> None:
        """Removes N objects: all, or on any error none. `objects` is an id, or (N,) uint64.

        >>> from raygrid import Scene, Sphere
        >>> with Scene() as scene:
        ...     ball = scene.insert(Sphere(), (0, 0, 5))
        ...     scene.remove(ball)
        ...     scene.trace((0, 0, 0), (0, 0, 1)).t
        array([inf])
        """
        handle = self._open()
        ids = self._ids(objects)
        check(lib.rg_scene_remove_many(handle, self._input(ids), len(ids)))

    def replace_shape(self, old: Shape, new: Shape) -> None:
        """Gives every object of this scene that has the shape `old` the shape `new`: all, or on any error none.

        Ids, poses and masks stay. So a mesh changes its form:

        >>> import numpy as np
        >>> from raygrid import Mesh, Scene
        >>> corners = np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], np.float32)
        >>> flat = Mesh(corners, [[0, 1, 2]])
        >>> with Scene() as scene:
        ...     sails = scene.insert(flat, [[0, 0, 5], [4, 0, 5]])
        ...     scene.replace_shape(flat, flat.deformed(corners - (0, 0, 1)))
        ...     scene.trace([[0, 0, 0], [4, 0, 0]], (0, 0, 1)).t
        array([4., 4.])
        """
        check(lib.rg_scene_replace_shape(self._open(), old._pointer, new._pointer))

    def set_mask(self, object: ArrayLike, mask: int) -> None:
        """Changes which rays see an object: those whose mask shares a bit with this one."""
        check(lib.rg_scene_set_mask(self._open(), self._id(object), mask))

    def lookup(self, object: ArrayLike) -> ObjectReport:
        """What is known of an object.

        >>> from raygrid import Scene, Sphere
        >>> with Scene() as scene:
        ...     ball = scene.insert(Sphere(), (1, 2, 3), scale=4)
        ...     report = scene.lookup(ball)
        >>> report.position, report.scale
        (array([1., 2., 3.]), 4.0)
        """
        report = ffi.new("rg_object_report *", {"size": ffi.sizeof("rg_object_report")})
        shape = ffi.new("rg_shape **")
        check(lib.rg_scene_lookup(self._open(), self._id(object), report))
        check(lib.rg_scene_shape_of(self._open(), self._id(object), shape))
        return ObjectReport(
            position=np.array(list(report.pose.position)),
            linear=np.array(list(report.pose.linear), np.float32).reshape(3, 3),
            scale=report.pose.scale,
            shape=_shapes.taking_over(shape[0]),
            mask=report.mask,
            grid=Grid(self, report.grid),
            lo=np.array(list(report.lo)),
            hi=np.array(list(report.hi)),
        )

    @staticmethod
    def _ids(objects: ArrayLike) -> NDArray[np.uint64]:
        ids = _arrays.unsigned(objects, "objects", (_arrays.U64,))
        if ids.ndim > 1:
            raise ValueError(f"objects must be an id or have the shape (N,), not {_arrays.seen(ids)}")
        return np.atleast_1d(ids)

    def _id(self, object: ArrayLike) -> int:
        ids = self._ids(object)
        if len(ids) != 1:
            raise ValueError(f"object must be one id, not {_arrays.seen(ids)}")
        return int(ids[0])

    @staticmethod
    def _input(ids: NDArray[np.uint64]) -> Any:
        return ffi.new("rg_input *", (_arrays.pointer(ids), ids.strides[0], lib.RG_U64))

    @staticmethod
    def _poses(
        positions: ArrayLike, linear: ArrayLike | None, scale: ArrayLike | None
    ) -> tuple[Any, dict[str, int | None], list[object]]:
        """Views of poses, the counts of their arrays, and what must live as long as the views."""
        views = ffi.new("rg_pose_views *", {"size": ffi.sizeof("rg_pose_views")})
        counts: dict[str, int | None] = {}
        array, counts["positions"], *view = _arrays.vectors(positions, "positions")
        lib.py_input3(views, ffi.offsetof("rg_pose_views", "position"), *view)
        kept: list[object] = [array]
        if linear is not None:
            array, counts["linear"], columns = _arrays.matrices(linear, "linear")
            for j, column in enumerate(columns):
                lib.py_input3(views, ffi.offsetof("rg_pose_views", "column", j), *column)
            kept.append(array)
        if scale is not None:
            array, counts["scale"], *view = _arrays.numbers(scale, "scale")
            lib.py_input(views, ffi.offsetof("rg_pose_views", "scale"), *view)
            kept.append(array)
        return views, counts, kept

    # ------------------------------------------------------------------------------------------- queries

    def trace(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        *,
        t_min: ArrayLike | None = None,
        t_max: ArrayLike | None = None,
        mask: ArrayLike | None = None,
        cull: Cull | int = Cull.NONE,
        filter: Filter | None = None,
        fields: Iterable[str] = ("t", "object"),
        out: Hits | Mapping[str, NDArray[Any]] | None = None,
    ) -> Hits:
        """The closest hit of each of N rays.

        origins, directions: (3,), for all rays, or (N, 3); float64 or float32, of any strides, read where they lie.
        t_min, t_max: a number or (N,); the part of the ray that counts, in lengths of its direction. 0 and inf.
        mask: a uint32 or (N,) of them; a ray sees objects whose mask shares a bit with it. All bits if not given.
        cull: Cull.BACK lets rays through the backs of surfaces, Cull.FRONT through the fronts.
        filter: called with the number of the ray and a Candidate; a false answer lets the ray pass. Slow.
        fields: the arrays of Hits that are wanted; what is not asked for is not computed.
        out: arrays to write to, by name, or earlier Hits; they say which fields are wanted.

        >>> from raygrid import Scene, Box
        >>> with Scene() as scene:
        ...     box = scene.insert(Box((-1, -1, -1), (1, 1, 1)), (0, 0, 5))
        ...     hits = scene.trace((0, 0, 0), [[0, 0, 1], [0, 1, 0]], fields=("t", "normal"))
        >>> hits.t
        array([ 4., inf])
        >>> hits.normal[0].tolist()
        [0.0, 0.0, -1.0]
        """
        handle = self._open()
        call = ffi.new("py_trace *")
        rays, kept = self._rays(call, origins, directions, t_min, t_max, mask)
        hits = _hits.prepare(call, rays[0], fields) if out is None else _hits.prepare_out(call, rays[0], out)
        self._run(handle, call, cull, filter, rays)
        hits.invalid = call.invalid
        return hits

    def occluded(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        *,
        t_min: ArrayLike | None = None,
        t_max: ArrayLike | None = None,
        mask: ArrayLike | None = None,
        cull: Cull | int = Cull.NONE,
        filter: Filter | None = None,
        out: NDArray[np.bool_] | NDArray[np.uint8] | None = None,
    ) -> NDArray[np.bool_] | NDArray[np.uint8]:
        """Whether each of N rays hits anything: (N,) bool, or `out`, which may be uint8. Otherwise as trace.

        >>> from raygrid import Scene, Sphere
        >>> with Scene() as scene:
        ...     ball = scene.insert(Sphere(), (0, 0, 5))
        ...     scene.occluded((0, 0, 0), [[0, 0, 1], [0, 0, -1]])
        array([ True, False])
        """
        handle = self._open()
        call = ffi.new("py_trace *")
        rays, kept = self._rays(call, origins, directions, t_min, t_max, mask)
        if out is None:
            answers: NDArray[Any] = np.empty(rays[0], np.bool_)
            call.any = ffi.from_buffer(answers)
        else:
            answers = _arrays.out(out, "array", (rays[0],), (_arrays.BOOL, _arrays.U8))
            lib.py_output(call, OCCLUDED_AT, _arrays.pointer(answers), answers.strides[0], lib.RG_U8)
        self._run(handle, call, cull, filter, rays)
        return answers

    @staticmethod
    def _rays(
        call: Any,
        origins: ArrayLike,
        directions: ArrayLike,
        t_min: ArrayLike | None,
        t_max: ArrayLike | None,
        mask: ArrayLike | None,
    ) -> tuple[tuple[Any, ...], tuple[NDArray[Any], ...]]:
        """Views the rays. Returns number and views, as py_scene_trace takes them, and what must live meanwhile."""
        origin, count, at, step, component, kind = _arrays.vectors(origins, "origins")
        direction, others, d_at, d_step, d_component, d_kind = _arrays.vectors(directions, "directions")
        kept: tuple[NDArray[Any], ...] = (origin, direction)
        if count != others or t_min is not None or t_max is not None or mask is not None:
            counts = {"origins": count, "directions": others}
            for name, value in (("t_min", t_min), ("t_max", t_max)):
                if value is not None:
                    array, counts[name], *view = _arrays.numbers(value, name)
                    lib.py_input(call, RAYS_AT[name], *view)
                    kept += (array,)
            if mask is not None:
                array, counts["mask"], *view = _arrays.unsigned_numbers(mask, "mask", _arrays.U32)
                lib.py_input(call, RAYS_AT["mask"], *view)
                kept += (array,)
            count = _arrays.count_of(**counts)
        elif count is None:
            count = 1
        return (count, at, step, component, kind, d_at, d_step, d_component, d_kind), kept

    @staticmethod
    def _run(handle: Any, call: Any, cull: int, filter: Filter | None, rays: tuple[Any, ...]) -> None:
        if filter is None:
            result = py_scene_trace(handle, call, cull, *rays)
            if result:
                raise error(result)
            return
        filtering = _Filtering(filter)
        user = ffi.new_handle(filtering)
        call.config.filter = lib.py_filter
        call.config.filter_user = user
        result = py_scene_trace(handle, call, cull, *rays)
        if filtering.raised is not None and not isinstance(filtering.raised, Exception):
            raise filtering.raised
        if result:
            raise error(result) from filtering.raised

    # --------------------------------------------------------------------------------------------- grids

    @property
    def grid(self) -> Grid:
        """The grid that the scene has from the start."""
        return Grid(self, lib.RG_GRID_OF_SCENE)

    def create_grid(self, config: GridConfig | None = None) -> Grid:
        """Adds an empty grid, for instance one for what never moves. A trace goes through all."""
        made = ffi.new("rg_grid *")
        check(lib.rg_grid_create(self._open(), (config or GridConfig())._struct(), made))
        return Grid(self, made[0])

    def stats(self) -> SceneReport:
        """What is known of the scene.

        >>> from raygrid import Scene
        >>> with Scene(workers=2) as scene:
        ...     scene.stats().workers
        2
        """
        report = ffi.new("rg_scene_report *", {"size": ffi.sizeof("rg_scene_report")})
        check(lib.rg_scene_stats(self._open(), report))
        names = ("objects", "slots", "bytes", "invalid_rays", "workers", "grids")
        counts = {name: getattr(report, name) for name in names}
        return SceneReport(**counts, isa=Isa(report.isa), left_out=Without(report.left_out))

    def frame(self, *, workers: int = 0) -> Frame:
        """A frame of the scene: it shows what the scene holds now, under the same ids, until it is updated.

        >>> from raygrid import Scene, Sphere
        >>> with Scene() as scene, scene.frame() as frame:
        ...     ball = scene.insert(Sphere(), (0, 0, 5))
        ...     before = frame.trace((0, 0, 0), (0, 0, 1)).t
        ...     frame.update()
        ...     before, frame.trace((0, 0, 0), (0, 0, 1)).t
        (array([inf]), array([4.]))
        """
        frame = Frame.__new__(Frame)
        frame._handle = frame._recording = None
        frame._closed = "the frame was not made"
        frame._workers = workers
        leader = self._open()
        frame._create(
            lambda config, made: lib.rg_scene_create_frame(leader, config, made),
            ffi.new("rg_scene **"),
            None,
            None,
            leader=leader,
        )
        return frame

    # ------------------------------------------------------------------------------------------- as bytes

    def save(self) -> bytes:
        """A snapshot of the scene as it is: what Scene.load makes it of again, here or elsewhere.

        >>> from raygrid import Scene, Sphere
        >>> with Scene() as scene:
        ...     ball = scene.insert(Sphere(), (0, 0, 5))
        ...     data = scene.save()
        >>> with Scene.load(data) as scene:
        ...     scene.trace((0, 0, 0), (0, 0, 1)).object == ball
        array([ True])
        """
        parts: list[bytes] = []
        writing = _bytes.Writing(parts.append)
        user = ffi.new_handle(writing)
        writing.check(lib.rg_scene_save(self._open(), _bytes.sink(user)))
        return b"".join(parts)

    @classmethod
    def load(cls, data: _bytes.Bytes, *, workers: int = 0, log: Callable[[str], object] | None = None) -> Scene:
        """A scene from a snapshot: the same ids, the same answers to the last bit. Its grids come with it."""
        source, kept = _bytes.source(data)
        return cls._make(
            lambda config, made: lib.rg_scene_load(config, source, made),
            ffi.new("rg_scene **"),
            workers=workers,
            log=log,
        )

    def record(self, write: Callable[[bytes], object] | None) -> None:
        """Begins a recording: `write`, such as that of a binary file, gets a snapshot, then each change of the scene
        before the call that makes it returns. None ends the recording, and so does the end of the scene.

        If `write` raises, the recording ends, and not the call that was to be recorded: CallbackFailed, from what it
        raised, comes when the recording is ended. It must not use the scene. Replay plays what was written.
        """
        handle = self._open()
        if write is None:
            recording = self._end_recording(handle)
            if recording is not None:
                recording[0].check(recording[2])
            return
        writing = _bytes.Writing(write)
        user = ffi.new_handle(writing)
        writing.check(lib.rg_scene_record(handle, _bytes.sink(user)))
        self._recording = (writing, user)

    def _end_recording(self, handle: Any) -> tuple[_bytes.Writing, Any, int] | None:
        """What it was written with, and with what result it ended; None if there was none."""
        recording, self._recording = self._recording, None
        if recording is None:
            return None
        result = lib.rg_scene_record(handle, ffi.NULL)
        return (*recording, result)

    def __reduce__(self) -> tuple[Callable[..., Scene], tuple[bytes, int]]:
        return _load, (self.save(), self._workers)

    def __repr__(self) -> str:
        if self._handle is None:
            return f"<raygrid.Scene: {self._closed}>"
        report = self.stats()
        grids = f"{report.grids} grid" + "s" * (report.grids != 1)
        return f"<raygrid.Scene: {report.objects} objects in {grids}, {report.workers} workers, {report.bytes} bytes>"


class Frame(Scene):
    """A scene that shows another one as it was at its last update, all of one instant: for tracing while the other is
    changed. Scene.frame makes it. It is traced and read like any scene; changes of it raise Busy.
    """

    __slots__ = ()

    def __init__(self) -> None:
        raise TypeError("a raygrid.Frame is made by Scene.frame")

    def update(self) -> None:
        """Takes over what has changed in the scene since the last update, each object once."""
        check(lib.rg_scene_update_frame(self._open()))
