# SPDX-License-Identifier: MIT
"""Several grids in a scene, their configuration, and what is refused."""

from script import INF, NAN, Case, ray

DOWN = ((0, 0, -5), (0, 0, 1))


def several():
    case = Case("grids-several", "a query goes through all grids; the nearest of all wins")
    case.sphere("s", 1.0)
    case.box("b", (-1, -1, -1), (1, 1, 1))
    case.create_grid("u", kind="uniform", resolution=8, lo=(-8.0,) * 3, hi=(8.0,) * 3)
    case.create_grid("h", kind="hierarchical")
    case.create_grid("d", kind="default", resolution=4, lo=(0.0,) * 3, hi=(1.0, 2.0, 3.0), rebuild_factor="never")
    case.insert("scene", "s", (0, 0, 9))
    case.insert("u", "b", (0, 0, 6), grid="u")
    case.insert("h", "s", (0, 0, 3), grid="h")
    case.insert("d", "s", (0, 4, 3), grid="d")
    for name in ("u", "h", "d"):
        case.expect_object(name, grid=name)
    case.expect_object("scene", grid="scene")
    case.expect_scene(grids=4, objects=4)
    look = [ray(*DOWN), ray((0, 0, 20), (0, 0, -1)), ray((0, 4, -5), (0, 0, 1)), ray((0, 9, 6), (0, -1, 0))]
    case.trace(*look)
    case.move_to("scene", (0, 0, 1))
    case.trace(*look)
    case.move_to("scene", (0, 8, 6))
    case.trace(*look)
    case.remove("h")
    case.trace(*look)
    case.move_to("d", (0, 0, -2))
    case.trace(*look)
    case.expect_grid("u", kind="uniform", objects=1)
    case.expect_grid("h", kind="hierarchical", objects=0)
    case.expect_grid("d", kind="loose", objects=1, rebuilds=0)
    yield case

    case = Case("grids-ties", "the lowest id wins over all grids, not the first grid", numerics=[12])
    case.sphere("s", 1.0)
    case.create_grid("u", kind="uniform")
    case.create_grid("h", kind="hierarchical")
    case.insert("a", "s", (0, 0, 0), grid="h")
    case.insert("b", "s", (0, 0, 0), grid="u")
    case.insert("c", "s", (0, 0, 0))
    case.trace(ray(*DOWN, want=("a", 4.0)))
    case.remove("a")
    case.trace(ray(*DOWN, want=("b", 4.0)))
    case.insert("d", "s", (0, 0, 0))
    case.trace(ray(*DOWN, want=("b", 4.0)))
    case.remove("b")
    case.trace(ray(*DOWN, want=("c", 4.0)))
    yield case

    case = Case("grids-many-objects-each", "hundreds in each of three grids, moved between traces")
    case.sphere("s", 0.375)
    case.create_grid("u", kind="uniform", resolution=16)
    case.create_grid("h", kind="hierarchical", rebuild_factor="never")
    for number, grid in enumerate((None, "u", "h")):
        case.insert_many(f"g{number}", "s", [(i % 10 + 0.3 * number, i // 10, 1.5 * number) for i in range(80)],
                         grid=grid)
    rays = [ray((0.41 * i + 0.07, 0.53 * i + 0.02, -9), (0.013, 0.007, 1)) for i in range(18)]
    rays += [ray((-20, 0.45 * i + 0.01, 1.5 * (i % 3) + 0.11), (1, 0, 0.001)) for i in range(18)]
    case.trace(*rays)
    case.move_many([f"g{n}[{i}]" for n in range(3) for i in range(0, 80, 3)],
                   [(12 - i % 10, i // 10 + 0.5, 2.0 * n - 3) for n in range(3) for i in range(0, 80, 3)])
    case.trace(*rays)
    case.rebuild_grid("h")
    case.rebuild_grid("u")
    case.trace(*rays)
    case.expect_grid("h", objects=80)
    case.expect_grid("u", objects=80)
    yield case

    case = Case("grids-destroyed", "an empty grid can be destroyed, its id is stale then; one with objects can't")
    case.sphere("s", 1.0)
    case.insert("home", "s", (0, 0, 0))
    case.create_grid("g")
    case.insert("a", "s", (5, 0, 0), grid="g")
    case.trace(ray(*DOWN, want=("home", 4.0)), ray((5, 0, -5), (0, 0, 1), want=("a", 4.0)))
    case.expect_error("RG_BUSY", "", "destroy_grid", grid="g")
    case.expect_error("RG_BUSY", "", "destroy_grid", grid="scene")
    case.expect_scene(grids=2)
    case.remove("a")
    case.destroy_grid("g")
    case.expect_scene(grids=1, objects=1)
    case.trace(ray(*DOWN, want=("home", 4.0)), ray((5, 0, -5), (0, 0, 1), want="miss"))
    for do in ("destroy_grid", "rebuild_grid", "grid_stats"):
        case.expect_error("RG_INVALID_ID", "", do, grid="g")
    case.expect_error("RG_INVALID_ID", "", "configure_grid", grid="g", config={"kind": "uniform"})
    case.expect_error("RG_INVALID_ID", "", "insert", object="x", shape="s", position=[0, 0, 0], grid="g")
    case.create_grid("again")
    case.trace(ray(*DOWN, want=("home", 4.0)))
    case.expect_error("RG_INVALID_ID", "", "rebuild_grid", grid="g")
    case.insert("b", "s", (5, 0, 0), grid="again")
    case.trace(ray((5, 0, -5), (0, 0, 1), want=("b", 4.0)))
    case.expect_scene(grids=2, objects=2)
    yield case


def configured():
    def scene(case):
        case.sphere("s", 0.5)
        case.box("b", (-0.25, -2, -0.25), (0.25, 2, 0.25))
        case.insert_many("a", ["s", "b"] * 16, [(1.5 * (i % 6), 2.5 * (i // 6), 0.7 * (i % 5)) for i in range(32)])

    rays = [ray((0.43 * i - 0.2, 0.39 * i + 0.03, -7), (0.01, 0.02, 1)) for i in range(20)]
    rays += [ray((-9, 0.71 * i - 1.03, 0.33 * (i % 7) + 0.021), (1, 0.013, 0.003)) for i in range(20)]

    case = Case("grid-configured-anew", "another kind, resolution or box, with objects in it: the same answers")
    scene(case)
    case.insert("late", "b", (7.5, 12.5, 0.75))
    case.trace(*rays)
    for kind in ("uniform", "loose", "hierarchical"):
        for options in (dict(), dict(resolution=5), dict(resolution=64),
                        dict(resolution=4, lo=(-1.0, -1.0, -1.0), hi=(1.0, 2.0, 0.5), rebuild_factor="never"),
                        dict(resolution=16, lo=(100.0,) * 3, hi=(200.0,) * 3, rebuild_factor="never"),
                        dict(rebuild_factor=3)):
            case.configure_grid("scene", kind=kind, **options)
            case.expect_grid(kind=kind, objects=33)
            case.trace(*rays)
            case.move_to("a[7]", (1.5, 2.5, 1.25))
            case.remove("late")
            case.insert("late", "b", (1.5, 12.5, 0.75))
    yield case

    case = Case("grid-shape-of-cells", "cells are as cubic as fit: ceil on the other sides, powers of two for levels")
    for on, counts in (("uniform", [10, 5, 1]), ("hierarchical", [16, 8, 1])):
        case.expect_grid("scene", on=[on], levels=0)
        case.create_grid(on, kind=on, resolution=10, lo=(0.0, -5.0, 1.0), hi=(20.0, 4.9, 2.5))
        case.expect_grid(on, resolution=counts, physical_lo=[0.0, -5.0, 1.0], physical_hi=[20.0, 4.9, 2.5])
    case.trace(ray(*DOWN, want="miss"))
    yield case


def refused():
    bad = {
        "resolution": ("RG_INVALID_VALUE", "resolution", dict(resolution=2 ** 20 + 1)),
        "cells": ("RG_LIMIT_EXCEEDED", "cells", dict(resolution=1024, lo=[0.0] * 3, hi=[1.0] * 3)),
        "box-order": ("RG_INVALID_VALUE", "lo", dict(resolution=4, lo=[0.0, 2.0, 0.0], hi=[1.0, 1.0, 1.0])),
        "box-empty": ("RG_INVALID_VALUE", "lo", dict(resolution=4, lo=[0.0, 1.0, 0.0], hi=[1.0, 1.0, 1.0])),
        "box-nan": ("RG_INVALID_VALUE", "lo", dict(resolution=4, lo=[NAN, 0.0, 0.0], hi=[1.0, 1.0, 1.0])),
        "box-infinite": ("RG_INVALID_VALUE", "hi", dict(resolution=4, lo=[0.0, 0.0, 0.0], hi=[1.0, 1.0, INF])),
        "factor-below-1": ("RG_INVALID_VALUE", "rebuild_factor", dict(rebuild_factor=0.5)),
        "factor-negative": ("RG_INVALID_VALUE", "rebuild_factor", dict(rebuild_factor=-2.0)),
        "factor-nan": ("RG_INVALID_VALUE", "rebuild_factor", dict(rebuild_factor=NAN)),
        "factor-infinite": ("RG_INVALID_VALUE", "rebuild_factor", dict(rebuild_factor=INF)),
        "kind": ("RG_INVALID_ARGUMENT", "kind", dict(kind=4)),
        "kind-negative": ("RG_INVALID_ARGUMENT", "kind", dict(kind=-1)),
    }
    case = Case("grid-config-refused", "a bad configuration is refused by name; the grids stay as they were",
                grid=dict(resolution=8, lo=(0.0,) * 3, hi=(8.0,) * 3))
    case.sphere("s", 0.5)
    case.insert("a", "s", (1, 1, 1))
    case.trace(ray((1, 1, -3), (0, 0, 1), want=("a", 3.5)), ray((3, 1, -3), (0, 0, 1), want="miss"))
    for result, message, config in bad.values():
        case.expect_error(result, message, "create_grid", grid="bad", config=config)
        case.expect_error(result, message, "configure_grid", grid="scene", config=config)
    case.expect_scene(grids=1, objects=1)
    case.expect_grid(resolution=[8, 8, 8], physical_hi=[8.0, 8.0, 8.0], rebuilds=0)
    yield case


def all_cases():
    for group in (several, configured, refused):
        yield from group()
