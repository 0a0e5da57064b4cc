# SPDX-License-Identifier: MIT
"""Triangle meshes: NUMERICS 21 to 29."""

import math

from script import INF, NAN, Case, ray

# Corners of the cube from -1 to 1, number 4 z + 2 y + x, and its twelve triangles, counter-clockwise from outside.
CUBE = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
CUBE_FACES = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4),
              (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]


def ball(n, radius):
    """A closed mesh: n x 2n faces over the sphere, with its poles; corners are rounded to multiples of 2^-20."""
    def corner(i, j):
        a, b = math.pi * i / n, math.pi * j / n
        p = (math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a))
        return tuple(round(radius * x * 2 ** 20) / 2 ** 20 for x in p)
    vertices = [corner(0, 0), corner(n, 0)] + [corner(i, j) for i in range(1, n) for j in range(2 * n)]

    def at(i, j):
        return 0 if i == 0 else 1 if i == n else 2 + (i - 1) * 2 * n + j % (2 * n)
    faces = []
    for i in range(n):
        for j in range(2 * n):
            quad = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1))
            faces += [t for t in (quad[:3], (quad[0], quad[2], quad[3])) if len(set(t)) == 3]
    return vertices, faces


def middle(a, b, s=0.5):
    return [x + (y - x) * s for x, y in zip(a, b)]


def plain():
    case = Case("triangle-barycentrics", "u belongs to the second corner, v to the third; normal counter-clockwise")
    case.mesh("m", [(0, 0, 0), (4, 0, 0), (0, 4, 0)])
    case.insert("a", "m", (1, 1, 2))
    case.trace(ray((2, 2, 9), (0, 0, -1), want=("a", 7.0), give={"u": 0.25, "v": 0.25, "normal": [0.0, 0.0, 1.0]}),
               ray((4, 1.5, 9), (0, 0, -1), want=("a", 7.0), give={"u": 0.75, "v": 0.125}),
               ray((1.5, 4, -3), (0, 0, 1), want=("a", 5.0), give={"u": 0.125, "v": 0.75, "normal": [0.0, 0.0, 1.0]}),
               ray((4, 4, 9), (0, 0, -1), want="miss"), ray((0.5, 2, 9), (0, 0, -1), want="miss"),
               ray((7, 2, 9), (-1, 0, -1.75)), ray((2, 2, 9), (0, 0, 1), want="miss"))
    yield case

    for vertex_type in ("f32", "f64"):
        for index_type in ("u16", "u32", "u64", None):
            name = f"mesh-{vertex_type}-{index_type or 'unindexed'}"
            case = Case(name, "every type of vertices and indices reads the same mesh")
            if index_type:
                case.mesh("m", CUBE, CUBE_FACES, vertex_type=vertex_type, index_type=index_type)
            else:
                case.mesh("m", [CUBE[i] for face in CUBE_FACES for i in face], vertex_type=vertex_type)
            case.insert("a", "m", (3, 0, 0))
            case.trace(ray((2.5, 0.25, -4), (0, 0, 1), want=("a", 3.0)), ray((3.5, 0.25, 4), (0, 0, -1)),
                       ray((3.25, -5, 0.5), (0, 1, 0)), ray((3.25, 5, 0.75), (0, -1, 0)),
                       ray((9, 0.25, 0.5), (-1, 0, 0)), ray((-1, 0.25, 0.5), (1, 0, 0)),
                       ray((3.125, 0.25, 0), (0, 0, 1), want=("a", 1.0)), ray((5, 0.25, -4), (0, 0, 1), want="miss"),
                       ray((0, 0.3, -0.4), (1, 0.05, 0.1)))
            yield case


def watertight():
    vertices, faces = ball(9, 1.0)
    for name, numerics, targets in [
            ("vertices", [21], list(vertices)),
            ("edges", [22], [middle(vertices[a], vertices[b]) for f in faces for a,
                             b in zip(f, f[1:] + f[:1]) if a < b]),
            ("edge-points", [22], [middle(vertices[f[0]], vertices[f[2]], s) for f in faces[::2]
                                   for s in (0.125, 0.375, 0.75)])]:
        case = Case(f"mesh-shared-{name}", "rays aimed at shared vertices and edges from inside a closed mesh leak; "
                    "random aim proves nothing", numerics=numerics, flags=["costly"])
        case.mesh("m", vertices, faces)
        case.insert("a", "m", (0, 0, 0))
        start = (0.125, -0.0625, 0.25)
        case.trace(*(ray(start, [x - s for x, s in zip(p, start)], ties="any", tight=False) for p in targets))
        outside = (0.5, 3.0, -2.0)
        seen = [p for p in targets if sum(x * s for x, s in zip(p, outside)) > 1.5]
        case.trace(*(ray(outside, [x - s for x, s in zip(p, outside)], ties="any", tight=False) for p in seen))
        yield case

    case = Case("mesh-shared-posed", "the same under a scaling and turning pose, at a distance", numerics=[21, 22])
    case.mesh("m", CUBE, CUBE_FACES)
    case.insert("a", "m", (1000, -500, 250), linear=(2, 0.5, 0, -0.5, 1, 0.25, 0, -0.5, 0.75))
    start = (1000.125, -500.0625, 250.03125)

    def world(p):
        return (1000 + 2 * p[0] + 0.5 * p[1], -500 - 0.5 * p[0] + p[1] + 0.25 * p[2], 250 - 0.5 * p[1] + 0.75 * p[2])
    targets = [world(p) for p in CUBE] + [world(middle(CUBE[f[i]],
                                                       CUBE[f[i - 1]])) for f in CUBE_FACES for i in range(3)]
    case.trace(*(ray(start, [x - s for x, s in zip(p, start)], ties="any", tight=False) for p in targets))
    yield case

    case = Case("mesh-shared-lowest", "on a shared edge or corner hit exactly the lowest triangle wins",
                numerics=[22])
    case.mesh("m", [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 0)],
              [(2, 3, 4), (0, 1, 4), (3, 0, 4), (1, 2, 4)])
    case.insert("a", "m", (0, 0, 2))
    case.trace(*(ray((x, y, 0), (0, 0, 1), want=("a", 2.0), give={"primitive": p}) for x, y, p in [
        (0, 0, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0), (0.5, -0.5, 1), (-0.5, -0.5, 1), (0, 0.5, 0), (0.5, 0, 3),
        (-0.5, 0, 2), (0, -0.5, 1)]))
    case.trace(*(ray((x, y, 4), (0, 0, -2), want=("a", 1.0), give={"primitive": p}) for x, y, p in [
        (0, 0, 0), (0.5, -0.5, 1), (-0.5, -0.5, 1)]))
    yield case


def slender():
    case = Case("triangle-slivers", "an aspect of 1e7: barycentrics in [0, 1], no leak between neighbours",
                numerics=[23])
    thin = 2.0 ** -20
    case.mesh("m", [(-4, 0, 0), (4, 0, 0), (0, thin, 0), (0, -thin, 0)], [(0, 1, 2), (1, 0, 3)])
    case.insert("a", "m", (0, 0, 1))
    case.trace(*(ray((x, 0, 0), (0, 0, 1), want=("a", 1.0), give={"primitive": 0})
                 for x in (-3.875, -1.0, -0.125, 0.0, 0.75, 2.5, 3.75)),
               *(ray((x, y * thin, 0), (0, 0, 1), want=("a", 1.0))
                 for x, y in ((0, 0.5), (0, -0.5), (2, 0.25), (-2, -0.375), (3, 0.125))),
               ray((0, 1.25 * thin, 0), (0, 0, 1), want="miss"), ray((2, -0.625 * thin, 0), (0, 0, 1), want="miss"),
               ray((-7, 0, -6), (0.5, 0, 0.5)), ray((1, 0, 0), (0.1, 0, 0.3)))
    yield case

    case = Case("triangle-sliver-fan", "slivers round one corner: the corner and all their edges are tight",
                numerics=[21, 23])
    rim = [(8, -4 + i / 64, 0) for i in range(0, 513, 32)]
    case.mesh("m", [(-8, 0, 0)] + rim, [(0, i + 1, i + 2) for i in range(len(rim) - 1)])
    case.insert("a", "m", (0, 0, 0))
    targets = [(-8, 0, 0)] + [middle((-8, 0, 0), p, s) for p in rim[1:-1] for s in (0.03125, 0.5, 0.96875)]
    case.trace(*(ray((x, y, 3), (0, 0, -1), ties="any", want=("a", 3.0)) for x, y, _ in targets[1:]),
               *(ray((3, 1, 8), (x - 3, y - 1, -8), ties="any", want=("a", 1.0)) for x, y, _ in targets[1:]))
    yield case

    case = Case("triangle-without-area", "triangles without area are misses, make no NaN and keep their numbers",
                numerics=[24])
    case.mesh("m", [(0, 0, 0), (2, 0, 0), (4, 0, 0), (0, 2, 0)],
              [(0, 1, 2), (1, 1, 1), (0, 1, 0), (0, 1, 3), (3, 3, 0)])
    case.insert("a", "m", (0, 0, 1))
    case.trace(ray((0.5, 0.5, 0), (0, 0, 1), want=("a", 1.0), give={"primitive": 3}),
               ray((3, 0, 0), (0, 0, 1), want="miss"), ray((3, 0, 0), (0, 0, 1), want="miss"),
               ray((1, 0, 0), (0, 0, 1), want=("a", 1.0), give={"primitive": 3}),
               ray((5, 0, 1), (-1, 0, 0), want="miss"), ray((2, 0, 9), (0, 0, -1), give={"primitive": 3}),
               ray((0, 3, 1), (0, -1, 0), want="miss"))
    yield case

    case = Case("mesh-without-area", "a mesh of nothing but flat triangles is never hit", numerics=[24])
    case.mesh("m", [(1, 1, 1), (1, 1, 1), (1, 1, 1), (0, 0, 0), (1, 1, 1), (2, 2, 2)])
    case.insert("a", "m", (0, 0, 0))
    case.trace(ray((1, 1, -3), (0, 0, 1), want="miss"), ray((-1, -1, -1), (1, 1, 1), want="miss"),
               ray((0, 2, 0), (1, -1, 1), want="miss"))
    yield case

    case = Case("mesh-flattened", "a closed mesh without thickness: the lowest face that faces each way",
                numerics=[25])
    case.mesh("m", [(x, y, 0) for x, y, z in CUBE], CUBE_FACES)
    case.insert("a", "m", (0, 0, 3))
    places = ((-0.5, -0.25), (0.5, 0.75), (0.125, -0.5))
    case.trace(*(ray((x, y, 0), (0, 0, 1), want=("a", 3.0), drop=("normal",)) for x, y in places),
               *(ray((x, y, 8), (0, 0, -1), want=("a", 5.0), drop=("normal",)) for x, y in places))
    case.trace(*(ray((x, y, 0), (0, 0, 1), want=("a", 3.0)) for x, y in places), cull="back")
    case.trace(*(ray((x, y, 0), (0, 0, 1), want=("a", 3.0)) for x, y in places), cull="front")
    yield case

    case = Case("triangle-ray-in-plane", "a ray within the triangle's plane is a miss", numerics=[26])
    case.mesh("m", [(0, 0, 0), (4, 0, 0), (0, 4, 0)])
    case.insert("a", "m", (0, 0, 1))
    case.trace(ray((-2, 1, 1), (1, 0, 0), want="miss"), ray((1, 1, 1), (1, 0, 0), want="miss"),
               ray((-1, -1, 1), (1, 1, 0), want="miss"), ray((-2, 0, 1), (1, 0, 0), want="miss"),
               ray((1, 1, 1), (0, 0, 1), edge=True, want=("a", 0.0)),
               ray((1, 1, 1), (0, 0, 1), t_min=2.0 ** -40, edge=True, want="miss"))
    yield case

    case = Case("triangle-coincident", "opposite windings at one place: lowest id, and culling each face",
                numerics=[27])
    case.mesh("m", [(0, 0, 0), (4, 0, 0), (0, 4, 0)], [(0, 1, 2), (0, 2, 1)])
    case.insert("a", "m", (0, 0, 1))
    down, up = ((1, 1, 4), (0, 0, -1)), ((1, 1, -4), (0, 0, 1))
    case.trace(ray(*down, give={"primitive": 0}, want=("a", 3.0)), ray(*up, give={"primitive": 0}, want=("a", 5.0)))
    case.trace(ray(*down, give={"primitive": 0}), ray(*up, give={"primitive": 1}), cull="back")
    case.trace(ray(*down, give={"primitive": 1}), ray(*up, give={"primitive": 0}), cull="front")
    yield case

    case = Case("mesh-coincident-objects", "two objects of one mesh at one place: the lowest object",
                numerics=[12, 27])
    case.mesh("m", CUBE, CUBE_FACES)
    case.insert_many("a", "m", [(1, 2, 3), (1, 2, 3), (1, 2, 3)])
    case.trace(ray((1.25, 2.5, 0), (0, 0, 1), want=("a[0]", 2.0)), ray((1, 2, 3), (0.1, 0.3, 0.9)))
    case.remove("a[0]")
    case.trace(ray((1.25, 2.5, 0), (0, 0, 1), want=("a[1]", 2.0)), ray((1, 2, 3), (0.1, 0.3, 0.9)))
    yield case


def again():
    directions = [(1, 0, 0.03125), (-1, 0, 0.03125), (0, 1, 0.03125), (0, -1, 0.03125), (0, 0, 1), (0.3, 0.4, 0.1),
                  (-0.6, 0.2, 0.5), (1, 1, 0.001), (-1, 1, 0.0001)]
    for exponent in (-8, -4, 0, 4, 8):
        s = 10.0 ** exponent
        case = Case(f"offset-at-1e{exponent}", "a ray from a hit, moved by the documented offset, hits the same spot "
                    "again", numerics=[28])
        case.mesh("m", [(-s, -s, 0), (s, -s, 0), (0, s, 0.25 * s)])
        case.sphere("s", 0.5 * s)
        case.box("b", (-0.5 * s,) * 3, (0.5 * s,) * 3)
        case.capsule("c", (0, -0.5 * s, 0), (0, 0.5 * s, 0), 0.25 * s)
        case.insert("face", "m", (3 * s, -s, 7 * s))
        case.insert("ball", "s", (-3 * s, -s, 7 * s))
        case.insert("cube", "b", (3 * s, 4 * s, 7 * s), linear=(0.75, 0.5, 0, -0.5, 0.75, 0, 0, 0.25, 1))
        case.insert("rod", "c", (-3 * s, 4 * s, 7 * s))
        case.trace(*(ray((x * s, y * s, 0), (dx, dy, 1)) for x, y, dx, dy in [
            (3, -1, 0, 0), (3.125, -1.25, 0.01, -0.02), (-3, -1, 0, 0), (-3.25, -0.875, 0, 0), (0, 0, -0.41, -0.13),
            (3, 4, 0, 0), (3.125, 4.25, 0, 0), (-3, 4, 0, 0), (-3.125, 4.5, 0.001, 0), (-3, 4.6, 0, 0)]),
            respawn=directions)
        yield case

    case = Case("offset-far-from-origin", "the offset must grow with the world's coordinates", numerics=[4, 28])
    case.mesh("m", [(-1, -1, 0), (1, -1, 0), (0, 1, 0.25)])
    case.sphere("s", 0.5)
    case.insert("face", "m", (1e9 + 3, -1e9, 1e9))
    case.insert("ball", "s", (1e9 - 3, -1e9, 1e9))
    case.trace(ray((1e9 + 3, -1e9, 1e9 - 7), (0, 0, 1)), ray((1e9 - 3, -1e9, 1e9 - 7), (0, 0, 1)),
               ray((1e9 - 3.25, -1e9, 1e9 - 7), (0.01, 0.02, 1)), ray((1e9 + 3.25, -1e9, 1e9 - 7), (0.01, 0.02, 1)),
               respawn=directions)
    yield case


def bad():
    good = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]

    def base(name, note):
        case = Case(name, note, numerics=[29])
        case.mesh("m", [(-1, -1, 0), (1, -1, 0), (0, 1, 0)])
        case.insert("a", "m", (0, 0, 1))
        case.trace(ray((0, 0, 0), (0, 0, 1), want=("a", 1.0)), ray((2, 0, 0), (0, 0, 1), want="miss"))
        return case

    case = base("mesh-refused-vertices", "NaN, infinite and too large vertices: the message names the vertex")
    for bad_value in (NAN, INF, -INF, 1.1e100):
        vertices = [list(v) for v in good] + [[0.0, bad_value, 0.0]]
        case.expect_error("RG_INVALID_VALUE", "3", "mesh", shape="bad", vertices=vertices, indices=[[0, 1, 2]])
    case.expect_error("RG_INVALID_VALUE", "1", "mesh", shape="bad", vertices=[good[0], [NAN, 0.0, 0.0], good[2]],
                      vertex_type="f32")
    case.expect_scene(objects=1)
    yield case

    case = base("mesh-refused-indices", "an index without a vertex: the message names it, for every type")
    for index_type in ("u16", "u32", "u64"):
        case.expect_error("RG_INVALID_VALUE", "3", "mesh", shape="bad", vertices=good,
                          indices=[[0, 1, 2], [0, 3, 1]], index_type=index_type)
    case.expect_error("RG_INVALID_VALUE", "65535", "mesh", shape="bad", vertices=good, indices=[[0, 1, 65535]],
                      index_type="u16")
    case.expect_scene(objects=1)
    yield case

    case = base("mesh-refused-empty", "no triangle at all, or vertices that make no whole triangle")
    case.expect_error("RG_INVALID_VALUE", "triangle", "mesh", shape="bad", vertices=good, indices=[])
    case.expect_error("RG_INVALID_VALUE", "triangle", "mesh", shape="bad", vertices=[])
    case.expect_scene(objects=1)
    yield case


def all_cases():
    for group in (plain, watertight, slender, again, bad):
        yield from group()
