# SPDX-License-Identifier: MIT
"""That this package has all that the public headers have: a field or a constant added there must come here too."""

from __future__ import annotations

import dataclasses
import inspect

import raygrid
from raygrid import _errors, _hits, _shapes
from raygrid._raygrid import ffi, lib


def fields(struct: str, *without: str) -> set[str]:
    return {name for name, _ in ffi.typeof(struct).fields} - {"size", "reserved", *without}


def constants(prefix: str) -> dict[str, int]:
    return {name[len(prefix) :]: getattr(lib, name) for name in dir(lib) if name.startswith(prefix)}


def names(dataclass: type) -> set[str]:
    return {field.name for field in dataclasses.fields(dataclass)}


def test_results() -> None:
    results = {result for result in range(1, 100) if ffi.string(lib.rg_result_name(result)) != b"unknown"}
    assert set(_errors.ERRORS) == results


def test_kinds() -> None:
    grids = {name: value for name, value in constants("RG_GRID_").items() if name != "OF_SCENE"}
    assert {kind.name: kind.value for kind in raygrid.GridKind} == grids
    assert {cull.name: cull.value for cull in raygrid.Cull} == constants("RG_CULL_")
    assert {call.name: call.value for call in raygrid.Call} == constants("RG_CALL_")
    assert {isa.name: isa.value for isa in raygrid.Isa} == constants("RG_ISA_")
    assert {bit.name: bit.value for bit in raygrid.Without} == constants("RG_WITHOUT_")
    assert set(_shapes.CLASSES) | {lib.RG_SHAPE_USER} == set(constants("RG_SHAPE_").values())


def test_reports() -> None:
    assert names(raygrid.GridConfig) == fields("rg_grid_config")
    assert names(raygrid.GridReport) == fields("rg_grid_report")
    assert names(raygrid.Step) == fields("rg_replay_report")
    assert names(raygrid.SceneReport) == fields("rg_scene_report")
    assert names(raygrid.ObjectReport) == fields("rg_object_report", "pose") | fields("rg_pose")


def test_fields_of_hits() -> None:
    assert set(_hits.FIELDS) == fields("rg_hit_views", "u", "v") | {"uv"}
    assert {*_hits.FIELDS, "invalid"} == set(raygrid.Hits.__slots__)
    assert set(raygrid.Candidate._fields) == fields("rg_hit", "offset")


def test_arguments_of_calls() -> None:
    trace = set(inspect.signature(raygrid.Scene.trace).parameters)
    assert trace - {"self", "fields", "out", "cull", "filter", "origins", "directions"} | {
        "origin",
        "direction",
    } == fields("rg_ray_views")
    insert = set(inspect.signature(raygrid.Scene.insert).parameters)
    assert insert - {"self", "positions", "linear", "scale"} == fields("rg_insert_views", "shapes_stride", "poses")
    move = set(inspect.signature(raygrid.Scene.move).parameters)
    assert move - {"self", "objects"} == {"positions", "linear", "scale"}
    assert fields("rg_pose_views") == {"position", "column", "scale"}
    # User-defined shapes are not to be had from Python, so nobody numbers them and nobody finds them.
    assert fields("rg_sink") == {"user", "write", "number_shape"}
    assert fields("rg_source") == {"bytes", "byte_count", "user", "find_shape", "shapes"}
    making = fields("rg_shape_config", "allocator", "parallel_for", "parallel_for_user")
    mesh = set(inspect.signature(raygrid.Mesh).parameters)
    # What has been lent is dropped when it is given back.
    views = fields("rg_mesh_views", "vertex_count", "triangle_count", "released", "user")
    assert mesh == views | making | {"borrow"}
    assert set(inspect.signature(raygrid.Mesh.deformed).parameters) == {"self", "vertices", "borrow"} | making
    assert {one.name: one.value for one in raygrid.MeshQuality} == constants("RG_MESH_")


def test_version() -> None:
    numbers = (lib.RG_VERSION_MAJOR, lib.RG_VERSION_MINOR, lib.RG_VERSION_PATCH)
    assert raygrid.__version__ == "{}.{}.{}".format(*numbers)


def test_constants() -> None:
    assert raygrid.NO_OBJECT == lib.RG_NO_OBJECT == 0
    assert raygrid.NO_PRIMITIVE == lib.RG_NO_PRIMITIVE == 2**32 - 1
    assert (raygrid.COORDINATE_MAX, raygrid.RADIUS_MIN, raygrid.REBUILD_NEVER) == (1e100, 1e-100, -1.0)
