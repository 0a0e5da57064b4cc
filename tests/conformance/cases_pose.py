# SPDX-License-Identifier: MIT
"""Poses: NUMERICS 39 and 40."""

from cases_triangle import CUBE, CUBE_FACES
from script import INF, NAN, Case, ray

IDENTITY = (1, 0, 0, 0, 1, 0, 0, 0, 1)
TURN = (0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1)
LINEARS = {
    "turned": TURN,
    "scaled": (2, 0, 0, 0, 2, 0, 0, 0, 2),
    "uneven": (2, 0, 0, 0, 0.5, 0, 0, 0, 1.25),
    "mirrored": (-1, 0, 0, 0, 1, 0, 0, 0, 1),
    "mirrored-uneven": (0, 1.5, 0, 0.5, 0, 0, 0, 0, 1),
    "sheared": (1, 0.5, 0, 0, 1, -0.25, 0.125, 0, 1),
    "point-mirrored": (-1, 0, 0, 0, -1, 0, 0, 0, -1),
    "general": (0.7, -1.3, 0.2, 0.9, 0.4, -0.6, -0.1, 0.8, 1.1),
}
LINES = [(0, 0, 0, 0), (0.3, 0.2, 0, 0), (-0.5, 0.6, 0, 0), (0.8, -0.3, 0, 0), (-3, 1, 0.4, -0.1), (2, 3, -0.3, -0.4),
         (1.3, 0.4, 0, 0), (-0.2, -1.1, 0, 0), (5, -5, -0.5, 0.6), (0.1, 0.45, 0, 0)]


def floats(linear):
    """A pose's linear part is float: what decimal digits become there."""
    from exact import f32
    return tuple(f32(x) for x in linear)


def shapes(case):
    case.sphere("sphere", 1.0)
    case.box("box", (-1, -0.75, -0.5), (1, 0.75, 0.5))
    case.capsule("capsule", (-0.5, 0, 0), (0.5, 0.25, 0), 0.5)
    case.mesh("mesh", CUBE, CUBE_FACES)


def every_shape():
    for name, linear in LINEARS.items():
        for kind in ("sphere", "box", "capsule", "mesh"):
            case = Case(f"pose-{kind}-{name}", "t is the world's, the normal goes by the inverse transpose, outward",
                        numerics=[40])
            shapes(case)
            case.insert("a", kind, (0.5, -0.25, 4), linear=floats(linear))
            case.trace(*(ray((0.5 + x, -0.25 + y, -3), (dx, dy, 1), ties="any") for x, y, dx, dy in LINES),
                       *(ray((x, 6, 4 + y), (0.01, -1, 0.02), ties="any") for x, y, _, _ in LINES[:4]),
                       ray((0.5, -0.25, 4), (0.3, 0.5, -0.7), ties="any"))
            yield case


def facing():
    case = Case("pose-facing", "a mirror turns the winding, not the side that is out: culling stays right",
                numerics=[27, 40])
    case.mesh("m", CUBE, CUBE_FACES)
    for i, name in enumerate(("turned", "mirrored", "sheared", "point-mirrored")):
        case.insert(name, "m", (6 * i, 0, 0), linear=floats(LINEARS[name]))
    rays = [ray((6 * i + 0.25, 0.125, -5), (0.01, 0.02, 1)) for i in range(4)]
    inside = [ray((6 * i + 0.125, 0.1, 0.05), (0.3, -0.2, 1)) for i in range(4)]
    for cull in (None, "back", "front"):
        case.trace(*rays, *inside, cull=cull)
    yield case


def stiff():
    case = Case("pose-scale-1-1e-3-1e3", "a stiff scale: world t right, normal by inverse transpose", numerics=[40])
    shapes(case)
    linear = floats((1, 0, 0, 0, 1e-3, 0, 0, 0, 1e3))
    for i, kind in enumerate(("sphere", "box", "capsule")):
        case.insert(kind, kind, (4 * i, 0, 2000), linear=linear)
    case.trace(*(ray((4 * i + x, y, 0), (0, 0, 1)) for i in range(3) for x, y in ((0, 0), (0.3, 2e-4), (0, 2e-3))),
               *(ray((4 * i + 0.1, -3, 2100), (0, 1, 0)) for i in range(3)),
               *(ray((4 * i + 0.1, 3, 1900), (0.01, -1, 0.1)) for i in range(3)))
    yield case

    case = Case("pose-ellipsoid-flat", "a sphere pressed to a disc of a thousandth: silhouette and normals",
                numerics=[40])
    case.sphere("s", 1.0)
    case.insert("a", "s", (0, 0, 0), linear=floats((8, 0, 0, 0, 8, 0, 0, 0, 0.0078125)))
    case.trace(ray((0, 0, -5), (0, 0, 1)), ray((4, 4, -5), (0, 0, 1)), ray((7.9, 0, -5), (0, 0, 1)),
               ray((-20, 0, 0.003), (1, 0, 0)), ray((-20, 0, 0.01), (1, 0, 0), want="miss"),
               ray((-20, -3, 1), (1, 0.1, -0.05)), ray((8.1, 0, -5), (0, 0, 1), want="miss"))
    yield case

    case = Case("pose-sheared-far", "a condition of a thousand, far from the world's origin", numerics=[4, 40])
    shapes(case)
    at = (1e6, -2e6, 3e6)
    case.insert("a", "box", at, linear=floats((1, 500, 0, 0, 1, 0, 0, 0, 1)))
    case.insert("b", "sphere", (at[0], at[1], at[2] + 10), linear=floats((1, 500, 0, 0, 1, 0, 0, 0, 1)))
    case.trace(ray((at[0] + 0.5, at[1] + 0.001, at[2] - 7), (0, 0, 1)),
               ray((at[0] + 100, at[1] + 0.2, at[2] - 7), (0, 0, 1)),
               ray((at[0] + 100, at[1] + 0.3, at[2] + 17), (0, 0, -1)),
               ray((at[0] - 90, at[1] - 0.2, at[2] + 17), (0, 0, -1)),
               ray((at[0] - 900, at[1] + 0.1, at[2]), (1, 0, 0)))
    yield case

    case = Case("pose-tiny-and-huge-scale", "scales of 1e-30 and 1e30: the determinant under- or overflows",
                numerics=[40])
    case.sphere("s", 1.0)
    case.box("b", (-1, -1, -1), (1, 1, 1))
    for name, size in (("small", 2.0 ** -100), ("large", 2.0 ** 100)):
        linear = tuple(size * x for x in (1, 0, 0, 0, 2, 0, 0, 0, 1))
        for shape in ("s", "b"):
            case.insert("a", shape, (0, 0, 0), linear=linear)
            case.trace(ray((0, 0, -4 * size), (0, 0, 1), want=("a", 3 * size)),
                       ray((0.25 * size, size, -4 * size), (0, 0, 1)),
                       ray((0, 0, 0), (0, 4, 0), want=("a", 0.5 * size)),
                       ray((3 * size, 0, -4 * size), (0, 0, 1), want="miss"))
            case.remove("a")
    yield case


def distant():
    aims = [(0, 0, 0), (0.3, 0.2, 0.1), (-0.4, 0.3, -0.2), (0.6, -0.5, 0.3), (-0.7, -0.3, 0.4), (0.2, 0.6, -0.4),
            (1.4, 0.2, 0.1), (-0.3, 1.6, 0.2), (0.1, -0.2, 1.9), (0.85, 0.6, 0.4), (-0.95, 0.1, 0.05)]
    ways = [(0.36, 0.48, 0.8), (-0.6, 0.64, -0.48), (0.01, -0.02, 0.9999), (-0.8, 0.001, 0.6)]
    for exponent in (4, 8, 12):
        for name in ("general", None):
            case = Case(f"pose-distance-1e{exponent}-{name or 'plain'}",
                        "every shape from far away, away from the world's "
                        "origin too: only moving the ray's origin near it exactly keeps the hits",
                        numerics=[2, 4, 40])
            shapes(case)
            places = {"sphere": (1e3, 2e3, -3e3), "box": (-1e3, 5e3, 1e3), "capsule": (7, 11, -13),
                      "mesh": (0.1, -4e3, 0.3)}
            far = 10.0 ** exponent
            rays = []
            for kind, at in places.items():
                case.insert(kind, kind, at, linear=floats(LINEARS[name]) if name else None)
                for i, aim in enumerate(aims):
                    target = [a + x for a, x in zip(at, aim)]
                    origin = [x - far * w for x, w in zip(target, ways[i % 4])]
                    rays.append(ray(origin, [0.3 * (t - o) for t, o in zip(target, origin)], ties="any"))
            case.trace(*rays)
            yield case


def bad():
    singular = {
        "zero": (0,) * 9, "flat": (1, 0, 0, 0, 1, 0, 0, 0, 0), "rank-one": (1, 2, 3, 2, 4, 6, -1, -2, -3),
        "nan": (1, 0, 0, 0, NAN, 0, 0, 0, 1), "infinite": (1, 0, 0, 0, 1, 0, 0, 0, INF),
        "nearly": (1, 0, 0, 0, 1, 0, 1, 1, 2.0 ** -45),
    }
    for name, linear in singular.items():
        case = Case(f"pose-refused-{name}", "a singular or bad linear part is refused, the old pose kept",
                    numerics=[39])
        case.sphere("s", 1.0)
        case.insert("a", "s", (2, 0, 0), linear=(2, 0, 0, 0, 1, 0, 0, 0, 1))
        case.trace(ray((-3, 0, 0), (1, 0, 0), want=("a", 3.0)), ray((2, 0, -3), (0, 0, 1), want=("a", 2.0)),
                   ray((2, 3, -3), (0, 0, 1), want="miss"))
        linear = [float(x) for x in linear]
        case.expect_error("RG_INVALID_VALUE", "linear", "move", object="a", position=[9.0, 9.0, 9.0], linear=linear)
        case.expect_error("RG_INVALID_VALUE", "linear", "insert", object="b", shape="s", position=[9.0, 9.0, 9.0],
                          linear=linear)
        case.expect_object("a", position=[2.0, 0.0, 0.0], linear=[2, 0, 0, 0, 1, 0, 0, 0, 1])
        case.expect_scene(objects=1)
        yield case

    case = Case("pose-refused-position", "NaN, infinite and too large positions: refused, the old pose kept",
                numerics=[37, 39])
    case.sphere("s", 1.0)
    case.insert("a", "s", (1, 2, 3))
    case.trace(ray((1, 2, 0), (0, 0, 1), want=("a", 2.0)), ray((0, 0, 0), (0, 0, 1), want="miss"))
    for i, value in enumerate((NAN, INF, -INF, 1.1e100)):
        position = [value if j == i % 3 else 0.0 for j in range(3)]
        case.expect_error("RG_INVALID_VALUE", "position", "move_to", object="a", position=position)
        case.expect_error("RG_INVALID_VALUE", "position", "move", object="a", position=position)
        case.expect_error("RG_INVALID_VALUE", "position", "insert", object="b", shape="s", position=position)
    case.expect_object("a", position=[1.0, 2.0, 3.0], linear=list(IDENTITY))
    case.expect_scene(objects=1, slots=1)
    yield case


def kept():
    case = Case("pose-kept-by-move-to", "move_to keeps the linear part; move replaces it, by the identity if none")
    case.box("b", (-1, -1, -1), (1, 1, 1))
    case.insert("a", "b", (0, 0, 0), linear=(2, 0, 0, 0, 3, 0, 0, 0, 1))
    case.trace(ray((0, 0, -5), (0, 0, 1), want=("a", 4.0)), ray((-9, 2.5, 0), (1, 0, 0), want=("a", 7.0)))
    case.move_to("a", (0, 0, 3))
    case.expect_object("a", position=[0.0, 0.0, 3.0], linear=[2, 0, 0, 0, 3, 0, 0, 0, 1],
                       contains=[[-2.0, -3.0, 2.0], [2.0, 3.0, 4.0]])
    case.trace(ray((0, 0, -5), (0, 0, 1), want=("a", 7.0)), ray((-9, 2.5, 3), (1, 0, 0), want=("a", 7.0)))
    case.move("a", (0, 0, 3))
    case.trace(ray((-9, 2.5, 3), (1, 0, 0), want="miss"), ray((-9, 0.5, 3), (1, 0, 0), want=("a", 8.0)))
    case.move("a", (0, 0, 3), linear=(1, 1, 0, 0, 1, 0, 0, 0, 4))
    case.trace(ray((0, 0, -5), (0, 0, 1), want=("a", 4.0)), ray((-9, 0.5, 3), (1, 0, 0), want=("a", 8.5)))
    yield case

    case = Case("pose-many-moved", "many poses at once, with linear parts and without", numerics=[40])
    case.sphere("s", 1.0)
    case.insert_many("a", "s", [(4.0 * i, 0, 0) for i in range(6)],
                     linears=[(1, 0, 0, 0, 1 + 0.25 * i, 0, 0, 0, 1) for i in range(6)])
    names = [f"a[{i}]" for i in range(6)]

    def look():
        case.trace(*(ray((4.0 * i, y, -5), (0, 0, 1)) for i in range(6) for y in (0, 1.125, 3)))
    look()
    case.move_many(names[::-1], [(4.0 * i, 0.5, 1) for i in range(6)])
    look()
    case.move_many(names[1:4], [(4.0 * i, 3, 0) for i in range(3)], linears=[TURNED_FLOAT] * 3)
    look()
    case.move_many(["a[0]", "a[5]", "a[0]"], [(0, -9, 0), (8, 3, 3), (4, 3, 5)])
    look()
    yield case


TURNED_FLOAT = floats(TURN)


def all_cases():
    for group in (every_shape, facing, stiff, distant, bad, kept):
        yield from group()
