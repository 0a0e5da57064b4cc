# SPDX-License-Identifier: MIT
"""The steps of a script that are calls."""

from __future__ import annotations

from typing import Any

import numpy as np

import raygrid

from . import trace
from .script import (
    Malformed,
    Play,
    grid_config,
    grid_of,
    known,
    matrix,
    number,
    numbers,
    object_id,
    shape_of,
    vectors,
    whole,
)

Step = dict[str, Any]


def sphere(play: Play, step: Step) -> None:
    play.shapes[step["shape"]] = raygrid.Sphere(number(step["radius"]))


def box(play: Play, step: Step) -> None:
    play.shapes[step["shape"]] = raygrid.Box(numbers(step["lo"], 3), numbers(step["hi"], 3))


def capsule(play: Play, step: Step) -> None:
    ends = numbers(step["a"], 3), numbers(step["b"], 3)
    play.shapes[step["shape"]] = raygrid.Capsule(*ends, number(step["radius"]))


def laid_out(step: Step, records: np.ndarray) -> np.ndarray:
    """Where they lie in memory: one after another, or each component in an array of its own."""
    return np.asfortranarray(records) if step.get("apart") else records


def mesh_vertices(step: Step) -> np.ndarray:
    return laid_out(step, vectors(step["vertices"], np.float32 if step.get("vertex_type") == "f32" else np.float64))


def quality(step: Step) -> Any:
    given = step.get("quality", "best")
    return raygrid.MeshQuality[given.upper()] if isinstance(given, str) else given


def mesh(play: Play, step: Step) -> None:
    indices = None
    if "indices" in step:
        dtype = {"u16": np.uint16, "u32": np.uint32, "u64": np.uint64}[step.get("index_type", "u32")]
        indices = laid_out(step, np.array(step["indices"], dtype).reshape(-1, 3))
    play.shapes[step["shape"]] = raygrid.Mesh(mesh_vertices(step), indices, quality=quality(step))


def deform(play: Play, step: Step) -> None:
    # By the class: other shapes have no such method, and the library's refusal is what is asked for.
    old: Any = shape_of(play, step["from"])
    play.shapes[step["shape"]] = raygrid.Mesh.deformed(old, mesh_vertices(step), quality=quality(step))


def replace_shape(play: Play, step: Step) -> None:
    play.scene.replace_shape(shape_of(play, step["from"]), shape_of(play, step["to"]))


def release(play: Play, step: Step) -> None:
    shape_of(play, step["shape"])
    del play.shapes[step["shape"]]


def placed(play: Play, step: Step) -> dict[str, Any]:
    """The arguments of insert that steps with one and with many objects have in common."""
    return {"grid": grid_of(play, step["grid"])} if "grid" in step else {}


def insert(play: Play, step: Step) -> None:
    linear = matrix(step["linear"]) if "linear" in step else None
    mask = whole(step["mask"], 2**32 - 1) if "mask" in step else None
    shape, position = shape_of(play, step["shape"]), numbers(step["position"], 3)
    ids = play.scene.insert(shape, position, linear=linear, mask=mask, **placed(play, step))
    play.objects[step["object"]] = ids[0]


def poses(step: Step) -> dict[str, Any]:
    positions = vectors(step["positions"])
    if "linears" not in step:
        return {"positions": positions}
    linear = np.array([matrix(one) for one in step["linears"]], np.float32).reshape(-1, 3, 3)
    if len(linear) != len(positions):
        raise Malformed("linears are not one for each object")
    return {"positions": positions, "linear": linear}


def insert_many(play: Play, step: Step) -> None:
    shapes: Any
    if "shapes" in step:
        shapes = [shape_of(play, name) for name in step["shapes"]]
    else:
        shapes = shape_of(play, step["shape"])
    masks = np.array(step["masks"], np.uint32) if "masks" in step else None
    ids = play.scene.insert(shapes, mask=masks, **poses(step), **placed(play, step))
    play.objects[step["objects"]] = ids


def insert_line(play: Play, step: Step) -> None:
    start, each = np.array(numbers(step["start"], 3)), np.array(numbers(step["step"], 3))
    positions = start + np.arange(whole(step["count"], 2**30), dtype=np.float64)[:, None] * each
    ids = play.scene.insert(shape_of(play, step["shape"]), positions, **placed(play, step))
    play.objects[step["objects"]] = ids


def move(play: Play, step: Step) -> None:
    linear = matrix(step["linear"]) if "linear" in step else np.eye(3)
    one = object_id(play, step["object"])
    play.scene.move(one, numbers(step["position"], 3), linear=linear, scale=1)


def move_to(play: Play, step: Step) -> None:
    play.scene.move(object_id(play, step["object"]), numbers(step["position"], 3))


def many(play: Play, step: Step) -> np.ndarray:
    return np.array([object_id(play, one) for one in step["objects"]], np.uint64)


def move_many(play: Play, step: Step) -> None:
    play.scene.move(many(play, step), **poses(step))


def set_mask(play: Play, step: Step) -> None:
    play.scene.set_mask(object_id(play, step["object"]), whole(step["mask"], 2**32 - 1))


def remove(play: Play, step: Step) -> None:
    play.scene.remove(object_id(play, step["object"]))


def remove_many(play: Play, step: Step) -> None:
    play.scene.remove(many(play, step))


def lookup(play: Play, step: Step) -> None:
    play.scene.lookup(object_id(play, step["object"]))


def create_grid(play: Play, step: Step) -> None:
    play.grids[step["grid"]] = play.scene.create_grid(grid_config(play.setup, step["config"]))


def configure_grid(play: Play, step: Step) -> None:
    grid_of(play, step["grid"]).configure(grid_config(play.setup, step["config"]))


def rebuild_grid(play: Play, step: Step) -> None:
    grid_of(play, step["grid"]).rebuild()


def destroy_grid(play: Play, step: Step) -> None:
    grid_of(play, step["grid"]).destroy()


def grid_stats(play: Play, step: Step) -> None:
    grid_of(play, step["grid"]).stats()


def trace_once(play: Play, step: Step) -> None:
    batch = trace.Batch(step)
    play.scene.trace(**batch.rays, cull=batch.cull, fields=trace.ALL)


# Each step's call, and the fields that it may have.
CALLS = {
    "sphere": (sphere, "shape radius"),
    "box": (box, "shape lo hi"),
    "capsule": (capsule, "shape a b radius"),
    "mesh": (mesh, "shape vertices vertex_type indices index_type apart quality"),
    "deform": (deform, "shape from vertices vertex_type apart quality"),
    "replace_shape": (replace_shape, "from to"),
    "release": (release, "shape"),
    "insert": (insert, "object shape position linear mask grid"),
    "insert_many": (insert_many, "objects shape shapes positions linears masks grid"),
    "insert_line": (insert_line, "objects shape start step count grid"),
    "move": (move, "object position linear"),
    "move_to": (move_to, "object position"),
    "move_many": (move_many, "objects positions linears"),
    "set_mask": (set_mask, "object mask"),
    "remove": (remove, "object"),
    "remove_many": (remove_many, "objects"),
    "lookup": (lookup, "object"),
    "create_grid": (create_grid, "grid config"),
    "configure_grid": (configure_grid, "grid config"),
    "rebuild_grid": (rebuild_grid, "grid"),
    "destroy_grid": (destroy_grid, "grid"),
    "grid_stats": (grid_stats, "grid"),
    "trace": (trace_once, "rays cull respawn"),
}


def call(play: Play, step: Step) -> None:
    if step.get("do") not in CALLS:
        raise Malformed(f"unknown step {step.get('do')!r}")
    function, fields = CALLS[step["do"]]
    known(step, "do " + fields)
    function(play, step)
