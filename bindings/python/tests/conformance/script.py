# SPDX-License-Identifier: MIT
"""What a case's script says: numbers, names, poses, grids. All that the schema does not know raises Malformed."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import Any

import numpy as np

import raygrid


class Malformed(Exception):
    """The script is not what the schema says."""


@dataclass(frozen=True)
class Setup:
    """One way to set up the scene's own grid; see tests/conformance/README.md."""

    kind: raygrid.GridKind
    tiled: bool = False
    rebuilt: bool = False


SETUPS = {
    f"{kind.name.lower()}{end}": Setup(kind, **how)
    for kind in (raygrid.GridKind.UNIFORM, raygrid.GridKind.HIERARCHICAL, raygrid.GridKind.LOOSE)
    for end, how in (("", {}), ("-tiled", {"tiled": True}), ("-rebuilt", {"rebuilt": True}))
}
del SETUPS["loose-tiled"]  # it has no box that could be repeated


@dataclass
class Play:
    """A case while it is played."""

    setup: Setup
    setup_name: str
    scene: raygrid.Scene
    workers: int
    costly: bool
    shapes: dict[str, raygrid.Shape] = field(default_factory=dict)
    objects: dict[str, Any] = field(default_factory=dict)  # a NumPy integer, or an array of them
    grids: dict[str, raygrid.Grid] = field(default_factory=dict)
    last: Any = None  # the batch of the last trace step


def known(record: Any, words: str) -> None:
    if not isinstance(record, dict):
        raise Malformed(f"expected an object with {words}, not {record!r}")
    if unknown := set(record) - set(words.split()):
        raise Malformed(f"unknown fields {sorted(unknown)}; known are {words}")


def number(value: Any) -> float:
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    if value in ("inf", "-inf", "nan"):
        return float(value)
    if isinstance(value, str) and value[:1] == "x" and len(value) in (9, 17):
        return float(struct.unpack(">d" if len(value) == 17 else ">f", bytes.fromhex(value[1:]))[0])
    raise Malformed(f"{value!r} is no number")


def numbers(values: Any, count: int) -> list[float]:
    if not isinstance(values, list) or len(values) != count:
        raise Malformed(f"{values!r} is no array of {count} numbers")
    return [number(value) for value in values]


def vectors(values: list[Any], dtype: Any = np.float64) -> np.ndarray:
    return np.array([numbers(value, 3) for value in values], dtype).reshape(-1, 3)


def whole(value: Any, most: int) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= most:
        raise Malformed(f"{value!r} is no whole number up to {most}")
    return value


def matrix(values: Any) -> np.ndarray:
    with np.errstate(over="ignore"):
        return np.array(numbers(values, 9), np.float64).astype(np.float32).reshape(3, 3)


def object_id(play: Play, value: Any) -> np.uint64:
    if isinstance(value, dict):
        known(value, "id")
        return np.uint64(0 if value["id"] == "none" else int(value["id"][1:], 16))
    name, bracket, index = value.partition("[")
    if name not in play.objects:
        raise Malformed(f"no object is named {value!r}")
    found = play.objects[name]
    if bool(bracket) != (np.ndim(found) == 1):
        raise Malformed(f"{value!r} is one object of many, or the other way round")
    return found[int(index[:-1])] if bracket else found


def object_name(play: Play, wanted: int) -> str:
    if wanted == raygrid.NO_OBJECT:
        return "nothing"
    for name, ids in play.objects.items():
        for i, one in enumerate(np.atleast_1d(ids)):
            if one == wanted:
                return f"{name}[{i}]" if np.ndim(ids) else name
    return f"an unknown id {int(wanted):016x}"


def shape_of(play: Play, name: Any) -> raygrid.Shape:
    if name not in play.shapes:
        raise Malformed(f"no shape is named {name!r}")
    return play.shapes[name]


def grid_of(play: Play, name: Any) -> raygrid.Grid:
    if name == "scene":
        return play.scene.grid
    if name not in play.grids:
        raise Malformed(f"no grid is named {name!r}")
    return play.grids[name]


def grid_config(setup: Setup, record: dict[str, Any]) -> raygrid.GridConfig:
    known(record, "kind resolution lo hi rebuild_factor")
    kind = record.get("kind", setup.kind)
    if isinstance(kind, str):
        kind = raygrid.GridKind[kind.upper()]
    given: dict[str, Any] = {"kind": kind}
    if "resolution" in record:
        given["resolution"] = whole(record["resolution"], 2**32 - 1)
    for corner in ("lo", "hi"):
        if corner in record:
            given[corner] = numbers(record[corner], 3)
    if "rebuild_factor" in record:
        factor = record["rebuild_factor"]
        given["rebuild_factor"] = raygrid.REBUILD_NEVER if factor == "never" else number(factor)
    return raygrid.GridConfig(**given)


def scene_grid(setup: Setup, record: dict[str, Any] | None) -> raygrid.GridConfig:
    """How the scene's own grid is made in a set-up."""
    if record is not None and (setup.tiled or setup.rebuilt):
        raise Malformed("this set-up takes no grid")
    if setup.tiled:
        return raygrid.GridConfig(
            setup.kind, resolution=4, lo=[-1] * 3, hi=[1] * 3, rebuild_factor=raygrid.REBUILD_NEVER
        )
    return grid_config(setup, record or {})
