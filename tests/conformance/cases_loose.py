# SPDX-License-Identifier: MIT
"""
The loose kind, where its cells, boxes and float bounds could go wrong. Every case runs on the other kinds too: what
is hit is no matter of the kind.
"""

from script import INF, Case, ray

AXES = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


def turned(axis, x, y, z):
    """The point (x, y, z) with its axes turned so that x lies on `axis`."""
    place = [z] * 3
    place[axis], place[(axis + 1) % 3] = x, y
    return place


def flat():
    case = Case("loose-flat-at-zero", "what has no thickness, at coordinate 0 of everything, met along axes at any "
                "distance: a bound that is relative to the coordinate is no bound there", numerics=[13, 16])
    for axis in range(3):
        case.box(f"segment{axis}", turned(axis, -1, 0, 0), turned(axis, 1, 0, 0))
        case.box(f"square{axis}", turned(axis, 0, -1, -1), turned(axis, 0, 1, 1))
    case.box("point", (0, 0, 0), (0, 0, 0))
    for shape in [f"{kind}{axis}" for kind in ("segment", "square") for axis in range(3)] + ["point"]:
        case.insert("a", shape, (0, 0, 0))
        rays = []
        for axis in range(3):
            for distance in (0.5, 3.0, 1024.0, 2.0 ** 30, 2.0 ** 60):
                for sign in (1, -1):
                    rays.append(ray(turned(axis, -sign * distance, 0, 0), turned(axis, sign, 0, 0), edge=True))
        case.trace(*rays)
        case.remove("a")
    yield case

    case = Case("loose-flat-among-others", "the same where cells have been made, and the flat ones are a few of many",
                numerics=[13, 16])
    case.sphere("s", 0.25)
    case.box("flat", (-1, -1, 0), (1, 1, 0))
    case.insert_many("s", "s", [(3 * (i % 4) - 4.5, 3 * (i // 4 % 4) - 4.5, 3 * (i // 16) + 1.5) for i in range(48)])
    case.insert_many("f", "flat", [(3 * (i % 5) - 6, 3 * (i // 5) - 6, 0) for i in range(25)])
    case.trace(*(ray((3 * (i % 5) - 6, 3 * (i // 5) - 6, -2.0 ** (i + 1)), (0, 0, 1),
                     want=(f"f[{i}]", 2.0 ** (i + 1)), edge=True) for i in range(25)))
    case.trace(*(ray((3 * (i % 5) - 6, 3 * (i // 5) - 6 + 0.5, 64), (0, 0, -1), want=(f"f[{i}]", 64.0), edge=True)
                 for i in range(25)))
    case.trace(*(ray((-32, 3 * i - 6, 0), (1, 0, 0), want=(f"f[{5 * i}]", 25.0), edge=True) for i in range(5)))
    yield case

    case = Case("loose-flat-mesh", "a mesh in a plane of coordinate 0", numerics=[13, 26])
    case.mesh("m", [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [(0, 1, 2), (0, 2, 3)])
    case.insert("a", "m", (0, 0, 0))
    case.trace(*(ray((0.25, -0.5, z), (0, 0, -1 if z > 0 else 1), want=("a", abs(z)))
                 for z in (1.0, -1.0, 4096.0, -2.0 ** 40)),
               ray((-3, 0.25, 0), (1, 0, 0), want="miss", edge=True))
    yield case


def sizes():
    case = Case("loose-twelve-decades", "spheres from 1e-6 to 1e6, each inside the next, and beside it; the largest "
                "first, last and in between", numerics=[3])
    case.sphere("unit", 1.0)
    exponents = [20, -20, 0, 10, -10, 4, -4, 16, -16, 8, -8, 2, -2, 18, -18]
    for e in exponents:
        r = 2.0 ** e
        case.insert(f"round{e + 20}", "unit", (0, 0, 0), linear=[r, 0, 0, 0, r, 0, 0, 0, r])
        case.insert(f"beside{e + 20}", "unit", (4 * r, r, 0), linear=[r, 0, 0, 0, r, 0, 0, 0, r])
    rays = [ray((0, 0, 0), (1, 2 ** -30, 0))]
    for e in exponents:
        r = 2.0 ** e
        rays += [ray((0, 0, -1.5 * r), (2 ** -12, 2 ** -13, 1)), ray((4 * r, r, 1.25 * r), (0, 0, -1)),
                 ray((4 * r, 3 * r, 0.0), (2 ** -8, -1, 2 ** -9))]
    case.trace(*rays)
    for e in exponents[:7]:
        case.remove(f"round{e + 20}")
        case.trace(*rays)
    yield case

    case = Case("loose-first-decides-nothing", "the frame is made from the first object: others far larger, smaller "
                "or farther away than that are found all the same, and so is what comes when all have gone",
                numerics=[3, 4])
    case.sphere("unit", 1.0)
    for number, (first, second) in enumerate([(-60, 40), (60, -40), (0, 90), (0, -90), (-100, 0), (100, 0)]):
        a, b = 2.0 ** first, 2.0 ** second
        case.insert(f"a{number}", "unit", (0, 0, 0), linear=[a, 0, 0, 0, a, 0, 0, 0, a])
        case.insert(f"b{number}", "unit", (8 * max(a, b), 0, 0), linear=[b, 0, 0, 0, b, 0, 0, 0, b])
        case.trace(ray((0, 0, -3 * a), (0, 0, 1), want=(f"a{number}", 2 * a)),
                   ray((8 * max(a, b), 0, 3 * b), (0, 0, -1), want=(f"b{number}", 2 * b)),
                   ray((8 * max(a, b), 0, 3 * b), (0, 1, -1), want="miss"))
        case.remove(f"a{number}")
        case.trace(ray((0, 0, -3 * a), (0, 0, 1), t_max=4 * a), ray((8 * max(a, b), 0, 3 * b), (0, 0, -1)))
        case.remove(f"b{number}")
        case.expect_grid(objects=0, loose={"entries": 0, "unbounded": 0, "levels": 0})
    yield case

    case = Case("loose-cell-and-no-cell", "moves between what has a cell and what has none", numerics=[18])
    case.sphere("s", 0.5)
    case.box("slab", (-INF, -INF, -0.5), (INF, INF, 0.5))
    case.insert("s", "s", (0, 0, 0))
    case.insert("slab", "slab", (0, 0, 5))
    case.expect_grid(objects=2, loose={"entries": 1, "unbounded": 1})
    for far in (2.0 ** 80, 2.0 ** 200, -2.0 ** 300):
        case.move_to("s", (far, 0, 0))
        case.expect_grid(objects=2, loose={"entries": 0, "unbounded": 2})
        case.trace(ray((far, 0, -far), (0, 0, 1 if far > 0 else -1)), ray((1, 0, -5), (0, 0, 1), want=("slab", 9.5)))
        case.move_to("s", (1, 0, 0))
        case.expect_grid(objects=2, loose={"entries": 1, "unbounded": 1})
        case.trace(ray((1, 0, -5), (0, 0, 1), want=("s", 4.5)), ray((33, 0, -5), (0, 0, 1), want=("slab", 9.5)))
    yield case


def moves():
    case = Case("loose-drift", "a crowd is carried away by more than its own size, again and again: what is stored "
                "follows it", numerics=[4])
    case.sphere("s", 0.375)
    places = [(i % 5 - 2, i // 5 % 5 - 2, i // 25 - 1) for i in range(75)]
    names = [f"a[{i}]" for i in range(75)]
    case.insert_many("a", "s", places)
    for step in range(12):
        x = 7.0 * 3 ** step
        case.move_many(names, [(p[0] + x, p[1] - x, p[2]) for p in places])
        case.trace(ray((x, -x, -9), (0, 0, 1), want=("a[12]", 7.625)),
                   ray((x - 2, -x + 2, 9), (0, 0, -1), want=("a[70]", 7.625)),
                   ray((x - 9, -x + 1, 1), (1, 0, 0), want=("a[65]", 6.625)), ray((0, 0, -9), (0, 0, 1), want="miss"))
    case.expect_grid(objects=75, logical_contains=[(x, -x, 0.0)], loose={"entries": 75})
    yield case

    case = Case("loose-crowd", "a hundred in one place: cells can't part them; the lowest id wins as they go",
                numerics=[12])
    case.sphere("s", 0.5)
    case.box("b", (-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))
    case.insert_many("a", ["s" if i % 3 else "b" for i in range(100)], [(1, 2, 3)] * 100)
    case.insert("beside", "s", (3, 2, 3))
    look = ray((1, 2, -5), (0, 0, 1))
    beside = ray((3, 2, -5), (0, 0, 1), want=("beside", 7.5))
    case.trace(look, beside)
    for first in range(0, 100, 20):
        case.trace(ray((1, 2, -5), (0, 0, 1), want=(f"a[{first}]", 7.5)), beside)
        case.remove(f"a[{first}]")
        case.trace(look)
        case.remove_many([f"a[{i}]" for i in range(first + 1, first + 20)])
    case.trace(ray((1, 2, -5), (0, 0, 1), want="miss"), beside)
    case.expect_grid(objects=1, loose={"entries": 1, "levels": 0})
    yield case

    case = Case("loose-ball-becomes-box", "spheres are stored by their radius, all else by its box: a pose makes one "
                "of the other and back", numerics=[40])
    case.sphere("s", 1.0)
    case.insert_many("a", "s", [(3 * (i % 6), 3 * (i // 6), 0) for i in range(30)])
    stretched = [2, 0, 0, 0, 1, 0, 0, 0, 0.5]
    for i in range(0, 30, 4):
        case.move(f"a[{i}]", (3 * (i % 6), 3 * (i // 6), 0), linear=stretched)
    look = [ray((3 * (i % 6), 3 * (i // 6), -4), (0, 0, 1)) for i in range(30)]
    look += [ray((3 * (i % 6) - 1.5, 3 * (i // 6) + 0.25, 4), (0, 0, -1)) for i in range(30)]
    case.trace(*look)
    for i in range(0, 30, 8):
        case.move(f"a[{i}]", (3 * (i % 6), 3 * (i // 6), 1))
    case.trace(*look)
    case.remove_many([f"a[{i}]" for i in range(0, 30, 2)])
    case.trace(*look)
    yield case


def batches():
    def scene(case):
        case.sphere("s", 0.75)
        case.box("b", (-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))
        case.insert_many("a", ["s", "b"] * 27, [(3 * (i % 6) - 7.5, 3 * (i // 6 % 3) - 3, 3 * (i // 18)) for i in
                                                range(54)])

    case = Case("loose-neighbours", "blocks of neighbouring rays, as a camera sends them: from outside, from inside, "
                "parallel, towards a light", numerics=[11])
    scene(case)
    for eye in ((0.31, 0.17, -12.0), (0.04, 0.31, 1.52), (-7.43, -3.05, 0.07)):
        case.trace(*(ray(eye, (0.083 * x - 0.61, 0.23 * y - 0.29, 1)) for y in range(3) for x in range(16)))
    case.trace(*(ray((0.53 * x - 4.03, 0.97 * y - 2.06, -9), (0, 0, 1)) for y in range(2) for x in range(16)))
    light = (1.03, 0.52, 14.0)
    points = [(1.11 * x - 8.3, 2.57 * y - 3.1, -3.0) for y in range(3) for x in range(16)]
    case.trace(*(ray(p, [b - a for a, b in zip(p, light)], t_max=1.0) for p in points))
    yield case

    case = Case("loose-odd-neighbours", "among 16 neighbouring rays some run the other way along an axis, along "
                "walls, in a range of their own, backward, or are no rays", numerics=[11, 37])
    scene(case)
    eye = (0.31, 0.17, -12.0)
    rays = []
    for i in range(64):
        d = [0.083 * (i % 16) - 0.61, 0.13 * (i // 16) - 0.23, 1.0]
        options = {}
        if i % 16 == 3:
            d[i // 16 % 3] *= -1
        if i % 16 == 5:
            d[0] = -0.0 if i // 16 % 2 else 0.0
        if i % 16 == 7:
            options = dict(t_min=11.0 + i // 16, t_max=13.5 + i // 16)
        if i % 16 == 9:
            options = dict(t_max=4.0 + 2.0 * (i // 16))
        if i % 16 == 10:
            options = dict(t_min=-INF)
        if i % 16 == 12:
            d = [0.0, 0.0, 0.0]
        if i % 16 == 13:
            d = [-x for x in d]
            options = dict(t_min=-40.0, t_max=0.0)
        if i % 16 == 14:
            d = [2.0 ** 40 * x for x in d]
        rays.append(ray(eye, d, **options))
    case.trace(*rays)
    case.trace(*rays, cull="back")
    yield case


def all_cases():
    for group in (flat, sizes, moves, batches):
        yield from group()
