# SPDX-License-Identifier: MIT
"""Boxes: NUMERICS 13 to 20. Boxes are surfaces: from inside a ray hits the face that it leaves by."""

from itertools import product

from script import INF, NAN, Case, ray

UNIT = ((-1, -1, -1), (1, 1, 1))


def straight():
    case = Case("box-axis-rays", "0 * inf in the slab test: zero components inside the slabs are hits", numerics=[13])
    case.box("b", *UNIT)
    case.insert("a", "b", (2, 3, 4))
    rays = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            for zero in (0.0, -0.0):
                direction = [zero] * 3
                direction[axis] = sign
                origin = [2.25, 3.5, 3.75]
                origin[axis] -= 6 * sign
                rays.append(ray(origin, direction))
    case.trace(*rays, ray((0.5, 3, -9), (0, 0, 1), want="miss"), ray((2, 5, -9), (-0.0, -0.0, 1), want="miss"))
    yield case

    case = Case("box-plane-rays", "one zero component, the others not", numerics=[13])
    case.box("b", (-2, -1, -0.5), (2, 1, 0.5))
    case.insert("a", "b", (0, 0, 0))
    case.trace(ray((-8, -4, 0.25), (2, 1, 0)), ray((-8, -4, 0.25), (2, 1, -0.0)), ray((0.5, -4, -2), (0, 2, 1)),
               ray((0.5, -4, 2), (0, 2, -1)), ray((-6, 0.75, 3), (2, 0, -1)), ray((-8, -4, 0.625), (2, 1, 0)),
               ray((2.5, -4, -2), (0, 2, 1), want="miss"), ray((-8, 0, 0.25), (-2, 1, 0), want="miss"))
    yield case

    case = Case("box-direction-1e-40", "a tiny component overflows 1/d or makes 0 * inf", numerics=[20])
    case.box("b", *UNIT)
    case.insert("a", "b", (0, 0, 0))
    tiny = [1e-40, -1e-40, 1e-300, -1e-300, 5e-324]
    case.trace(*(ray((0.5, 0.25, -4), (e, 0, 1), want=("a", 3.0)) for e in tiny),
               *(ray((0.5, 0.25, -4), (e, -e, 1), want=("a", 3.0)) for e in tiny),
               *(ray((1.5, 0.25, -4), (e, 0, 1), want="miss") for e in tiny),
               *(ray((5, 0.25, 0.5), (-1, e, e), want=("a", 4.0)) for e in tiny))
    yield case


def rims():
    case = Case("box-ray-on-face", "an axis ray within a face's plane hits, from either end and on each face",
                numerics=[14])
    case.box("b", *UNIT)
    case.insert("a", "b", (0, 0, 0))
    rays = []
    for axis in range(3):
        for side in (1.0, -1.0):
            for sign in (1.0, -1.0):
                direction, origin = [0.0] * 3, [0.25] * 3
                direction[axis], origin[axis], origin[(axis + 1) % 3] = sign, -4 * sign, side
                # It meets the face that it enters by and the one that it runs on at one place.
                rays.append(ray(origin, direction, edge=True, want=("a", 3.0)))
    case.trace(*rays)
    yield case

    case = Case("box-edges-and-corners", "edges and corners belong to the box; +0 and -0 give the same answer",
                numerics=[15])
    case.box("b", *UNIT)
    case.insert("a", "b", (0, 0, 0))
    rays = []
    for y, z in product((1.0, -1.0), repeat=2):
        for zero in (0.0, -0.0):
            rays.append(ray((-3, y, z), (1, zero, -zero), edge=True, want=("a", 2.0)))
    for corner in product((1.0, -1.0), repeat=3):
        rays.append(ray([3 * x for x in corner], [-x for x in corner], edge=True, want=("a", 2.0)))
    case.trace(*rays)
    yield case

    case = Case("box-corner-grazed", "a ray that touches one edge or corner from outside hits the face it enters by",
                numerics=[15])
    case.box("b", *UNIT)
    case.insert("a", "b", (0, 0, 0))
    signs = list(product((1.0, -1.0), (1.0, -1.0), (0.5, -0.5, 0.0)))
    case.trace(*(ray((2 * x, 0, z), (-x, y, 0), edge=True, want=("a", 1.0)) for x, y, z in signs),
               *(ray((0, 2 * y, z), (x, -y, 0), edge=True, want=("a", 1.0)) for x, y, z in signs),
               *(ray((2 * x, y, 0), (-x, 0, 1), edge=True, want=("a", 1.0)) for x, y, _ in signs),
               *(ray((2 * x, 0, z), (-x, y, 0.5), edge=True, want=("a", 1.0)) for x, y, z in signs),
               ray((2, 2, 0), (-1, -1, 1), edge=True, want=("a", 1.0)),
               ray((2.125, 0, 0), (-1, 1, 0), want="miss"), ray((3, 1, 1), (-1, 0, 0), edge=True, want=("a", 2.0)))
    yield case

    case = Case("box-left-by-edge", "from inside out through an edge or corner: the lowest of the faces left by",
                numerics=[15, 19])
    case.box("b", *UNIT)
    case.insert("a", "b", (0, 0, 0))
    case.trace(*(ray((0, 0, 0), d, edge=True, want=("a", 1.0)) for d in product((1.0, -1.0), repeat=3)),
               *(ray((0, 0, 0.25), (x, y, 0), edge=True, want=("a", 1.0)) for x, y in product((1.0, -1.0), repeat=2)),
               *(ray((0.5, 0, 0), (0, x, y), edge=True, want=("a", 1.0)) for x, y in product((1.0, -1.0), repeat=2)))
    yield case

    case = Case("box-without-thickness", "lo == hi on an axis: still hit, also at its edges", numerics=[16])
    case.box("b", (-1, -1, 0), (1, 1, 0))
    case.insert("a", "b", (0, 0, 2))
    case.trace(ray((0.25, 0.5, 0), (0, 0, 1), edge=True, want=("a", 2.0)),
               ray((0.25, 0.5, 5), (0, 0, -1), edge=True, want=("a", 3.0)),
               *(ray((x, y, 0), (0, 0, 1), edge=True, want=("a", 2.0))
                 for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1))),
               ray((-3, 0, 2), (1, 0, 0), edge=True, want=("a", 2.0)),
               ray((0, 3, 2), (0, -1, 0), edge=True, want=("a", 2.0)),
               ray((-3, 0, 2.25), (1, 0, 0), edge=True, want="miss"),
               ray((1.25, 0, 0), (0, 0, 1), edge=True, want="miss"),
               ray((-1, 0, 0), (0.5, 0.25, 1), edge=True))
    yield case

    case = Case("box-line-and-point", "no thickness on two and on three axes: hit only by a ray exactly at it",
                numerics=[16])
    case.box("line", (0, 0, -1), (0, 0, 1))
    case.box("point", (0, 0, 0), (0, 0, 0))
    case.insert("a", "line", (0, 0, 0))
    case.insert("b", "point", (4, 0, 0))
    case.trace(ray((-2, 0, 0.5), (1, 0, 0), edge=True, want=("a", 2.0)),
               ray((0, -2, 0.5), (0, 1, 0), edge=True, want=("a", 2.0)),
               ray((-2, 0.125, 0.5), (1, 0, 0), edge=True, want="miss"),
               ray((4, 0, -2), (0, 0, 1), edge=True, want=("b", 2.0)),
               ray((2, 2, 2), (1, -1, -1), edge=True, want=("b", 2.0)),
               ray((4.125, 0, -2), (0, 0, 1), edge=True, want="miss"))
    yield case


def bad():
    for name, lo, hi, says in [("lo-above-hi", (0, 1, 0), (1, 0.5, 1), "hi"), ("nan", (NAN, 0, 0), (1, 1, 1), "lo"),
                               ("nan-hi", (0, 0, 0), (1, 1, NAN), "hi"),
                               ("empty-infinite", (INF, 0, 0), (INF, 1, 1), "lo"),
                               ("beyond-max", (0, 0, 0), (1, 1.1e100, 1), "hi")]:
        case = Case(f"box-refused-{name}", "bad corners are refused by name and the neighbours stay", numerics=[17])
        case.box("b", *UNIT)
        case.insert("a", "b", (0, 0, 0))
        case.trace(ray((0, 0, -4), (0, 0, 1), want=("a", 3.0)), ray((2, 0, -4), (0, 0, 1), want="miss"))
        case.expect_error("RG_INVALID_VALUE", says, "box", shape="bad", lo=list(map(float, lo)),
                          hi=list(map(float, hi)))
        case.expect_scene(objects=1)
        yield case


def infinite():
    case = Case("box-infinite-slab", "an infinite extent on two axes: hit, no NaN", numerics=[18])
    case.box("b", (-INF, -INF, -1), (INF, INF, 1))
    case.insert("a", "b", (0, 0, 5))
    case.trace(ray((0, 0, 0), (0, 0, 1), want=("a", 4.0)), ray((1e6, -1e9, 0), (0, 0, 1), want=("a", 4.0)),
               ray((0, 0, 9), (1, 1, -1), want=("a", 3.0)), ray((0, 0, 5), (0, 0, 1), want=("a", 1.0)),
               ray((0, 0, 5), (1, 0, 0), want="miss"), ray((0, 0, 0), (1, 1, 0), want="miss"),
               ray((-7, 3, 5), (1, 0, -0.125), want=("a", 8.0)), ray((0, 0, 0), (0, 0, -1), want="miss"))
    case.move_to("a", (0, 0, -5))
    case.trace(ray((0, 0, 0), (0, 0, -1), want=("a", 4.0)), ray((0, 0, 0), (0, 0, 1), want="miss"))
    case.expect_grid(unbounded=1, objects=1)
    case.remove("a")
    case.expect_grid(unbounded=0, objects=0)
    case.trace(ray((0, 0, 0), (0, 0, -1), want="miss"))
    yield case

    case = Case("box-infinite-ways", "half spaces' kin: infinite on one axis, on all, among finite neighbours",
                numerics=[18])
    case.sphere("s", 1.0)
    case.box("beam", (-INF, -1, -1), (INF, 1, 1))
    case.box("space", (-INF,) * 3, (INF,) * 3)
    case.insert("ball", "s", (0, 0, 0))
    case.insert("beam", "beam", (0, 6, 0))
    case.insert("space", "space", (0, 0, 0))
    case.trace(ray((0, 0, -5), (0, 0, 1), want=("ball", 4.0)), ray((0, 3, 0), (0, 1, 0), want=("beam", 2.0)),
               ray((1e8, 3, 0.5), (0, 1, 0), want=("beam", 2.0)), ray((-1e8, 6, 9), (0, 0, -2), want=("beam", 4.0)),
               ray((0, 6, 0), (1, 0, 0), want="miss"), ray((0, 3, 0), (1, 0, 0), want="miss"),
               ray((3, 3, 0), (-1, -1, 0)))
    yield case

    case = Case("box-half-infinite", "infinite to one side only: half spaces and half beams", numerics=[18])
    case.box("ground", (-INF, -INF, -INF), (INF, INF, 0))
    case.box("post", (-1, -1, 0), (1, 1, INF))
    case.insert("ground", "ground", (0, 0, -2))
    case.insert("post", "post", (5, 0, 3))
    case.trace(ray((0, 0, 0), (0, 0, -1), want=("ground", 2.0)),
               ray((1e9, -1e9, 6), (0, 0, -2), want=("ground", 4.0)),
               ray((0, 0, 0), (0, 0, 1), want="miss"), ray((0, 0, -9), (0, 0, 1), want=("ground", 7.0)),
               ray((0, 0, -9), (1, 1, 0), want="miss"), ray((5, 0, 0), (0, 0, 1), want=("post", 3.0)),
               ray((0, 0.5, 1e6), (1, 0, 0), want=("post", 4.0)), ray((5, 0, 9), (0, 0, -1), want=("post", 6.0)),
               ray((5, 0, 9), (0, 0, 1), want="miss"), ray((9, 0.5, 1), (-1, 0, -0.25), want=("ground", 12.0)),
               ray((9, 0.5, 5), (-1, 0, -0.25), want=("post", 3.0)))
    yield case

    case = Case("box-infinite-posed", "an infinite axis needs the identity as linear part", numerics=[18, 39])
    case.sphere("s", 1.0)
    case.box("slab", (-INF, -INF, 0), (INF, INF, 1))
    case.insert("ball", "s", (0, 0, 0))
    case.insert("slab", "slab", (0, 0, 7))
    case.trace(ray((0, 0, 3), (0, 0, 1), want=("slab", 4.0)), ray((0, 0, 3), (0, 0, -1), want=("ball", 2.0)))
    turn = [0, -1, 0, 1, 0, 0, 0, 0, 1]
    case.expect_error("RG_INVALID_VALUE", "linear", "insert", object="bad", shape="slab", position=[0, 0, 0],
                      linear=turn)
    case.expect_error("RG_INVALID_VALUE", "linear", "move", object="slab", position=[0, 0, 0], linear=turn)
    case.expect_scene(objects=2)
    yield case


def inside():
    case = Case("box-origin-inside", "the entry lies at t_min inside the slabs, the surface hit is the exit face",
                numerics=[19])
    case.box("b", (-1, -2, -4), (1, 2, 4))
    case.insert("a", "b", (0, 0, 0))
    case.trace(ray((0, 0, 0), (1, 0, 0), want=("a", 1.0)), ray((0, 0, 0), (-1, 0, 0), want=("a", 1.0)),
               ray((0, 0, 0), (0, 0.5, 0), want=("a", 4.0)), ray((0, 0, 0), (0, 0, -2), want=("a", 2.0)),
               ray((0.5, 1, -3), (0.25, 0.125, 1), want=("a", 2.0)),
               ray((-3, 0, 0), (1, 0, 0), t_min=2.5, want=("a", 4.0)),
               ray((-3, 0, 0), (1, 0, 0), t_min=2.5, t_max=3.5, want="miss"),
               ray((-3, 0, 0), (1, 0, 0), t_min=2.0, edge=True, want=("a", 2.0)),
               ray((-3, 0, 0), (1, 0, 0), t_min=4.0, edge=True, want=("a", 4.0)),
               ray((-3, 0, 0), (1, 0, 0), t_max=2.0, edge=True, want=("a", 2.0)),
               ray((0, 0, 0), (1, 0, 0), t_min=-INF, want=("a", -1.0)))
    yield case

    case = Case("box-origin-on-surface", "on a face t_min is inclusive; beyond it only the far face counts",
                numerics=[6, 19])
    case.box("b", *UNIT)
    case.insert("a", "b", (0, 0, 0))
    case.trace(ray((1, 0.25, 0.25), (1, 0, 0), edge=True, want=("a", 0.0)),
               ray((1, 0.25, 0.25), (-1, 0, 0), edge=True, want=("a", 0.0)),
               ray((1, 0.25, 0.25), (-1, 0, 0), t_min=0.125, edge=True, want=("a", 2.0)),
               ray((1, 0.25, 0.25), (1, 0, 0), t_min=0.125, edge=True, want="miss"))
    yield case


def all_cases():
    for group in (straight, rims, bad, infinite, inside):
        yield from group()
