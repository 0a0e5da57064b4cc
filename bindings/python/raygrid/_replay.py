# SPDX-License-Identifier: MIT
"""Recordings, played."""

from __future__ import annotations

import enum
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from . import _bytes
from ._errors import check
from ._grids import Grid
from ._raygrid import ffi, lib
from ._scene import Scene


class Call(enum.IntEnum):
    """The calls of the library that change a scene."""

    NONE = lib.RG_CALL_NONE
    INSERT = lib.RG_CALL_INSERT
    INSERT_MANY = lib.RG_CALL_INSERT_MANY
    MOVE = lib.RG_CALL_MOVE
    MOVE_TO = lib.RG_CALL_MOVE_TO
    MOVE_MANY = lib.RG_CALL_MOVE_MANY
    SET_MASK = lib.RG_CALL_SET_MASK
    REMOVE = lib.RG_CALL_REMOVE
    REMOVE_MANY = lib.RG_CALL_REMOVE_MANY
    GRID_CREATE = lib.RG_CALL_GRID_CREATE
    GRID_DESTROY = lib.RG_CALL_GRID_DESTROY
    GRID_CONFIGURE = lib.RG_CALL_GRID_CONFIGURE
    GRID_REBUILD = lib.RG_CALL_GRID_REBUILD
    REPLACE_SHAPE = lib.RG_CALL_REPLACE_SHAPE


@dataclass(frozen=True)
class Step:
    """A call that was played.

    call: which. calls: those played so far, this one among them. offset: bytes of the recording up to here.
    objects: how many it was about. object: the first of them, or NO_OBJECT.
    grid: that it was about, or the scene's own.
    """

    call: Call
    calls: int
    offset: int
    objects: int
    object: int
    grid: Grid


class Replay:
    """A recording that is played, call by call, on a scene of its own: an iterator of Steps.

    data: what Scene.record wrote, or a part of it; a snapshot is a recording of no calls.
    workers, log: as for Scene.

    >>> from raygrid import Replay, Scene, Sphere
    >>> written = []
    >>> with Scene() as scene:
    ...     scene.record(written.append)
    ...     ball = scene.insert(Sphere(), (0, 0, 5))
    ...     scene.move(ball, (0, 0, 9))
    ...     scene.record(None)
    >>> replay = Replay(b"".join(written))
    >>> for step in replay:
    ...     print(step.call.name, replay.scene.trace((0, 0, 0), (0, 0, 1)).t)
    INSERT_MANY [4.]
    MOVE_MANY [8.]
    """

    __slots__ = ("_data", "_pointer", "scene")

    scene: Scene

    def __init__(self, data: _bytes.Bytes, *, workers: int = 0, log: Callable[[str], object] | None = None) -> None:
        source, self._data = _bytes.source(data)
        replay, scene = ffi.new("rg_replay **"), ffi.new("rg_scene **")
        self.scene = Scene._make(
            lambda config, _: lib.rg_replay_create(config, source, replay, scene), scene, workers=workers, log=log
        )
        self._pointer = ffi.gc(replay[0], lib.py_replay_end)

    def __iter__(self) -> Iterator[Step]:
        return self

    def __next__(self) -> Step:
        """Plays the next call. InvalidData: it is damaged or cut off; the scene is as after the last call."""
        self.scene._open()
        report = ffi.new("rg_replay_report *", {"size": ffi.sizeof("rg_replay_report")})
        check(lib.rg_replay_step(self._pointer, report))
        if report.call == lib.RG_CALL_NONE:
            raise StopIteration
        counts = {name: getattr(report, name) for name in ("calls", "offset", "objects", "object")}
        return Step(**counts, call=Call(report.call), grid=Grid(self.scene, report.grid))
