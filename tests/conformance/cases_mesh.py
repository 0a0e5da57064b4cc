# SPDX-License-Identifier: MIT
"""Meshes that change their form or are replaced, how they are made, and what of them is right under poses."""

from cases_triangle import CUBE, CUBE_FACES, ball, middle
from script import INF, NAN, Case, ray

MIRROR = (-1, 0, 0, 0, 1, 0, 0, 0, 1)
TURN = (0, -1, 0, 1, 0, 0, 0, 0, 1)
UNEVEN = (2, 0.5, 0, 0, -0.25, 0, 0.125, 0, 4)
# Not round numbers, but in steps of 2^-10.
OFFSETS = {"0": (0, 0, 0), "1e3": (1000.3759765625, -999.5, 1000.0625), "1e7": (10000000.5625, 1e7, -9999999.25)}
# On a cube's faces beside the diagonals that part them, and beside the cube.
PLACES = ((0.25, 0.5), (-0.75, 0.125), (0.5, -0.875), (-0.125, -0.25), (3.5, 0.25))


def wave(step):
    """The corners of the cube, pushed to and fro: all stay multiples of 1/64."""
    return [(x + (3 * i + step) % 5 / 64, y * (1 + step / 4), z + (i * step) % 7 / 64 - 0.5)
            for i, (x, y, z) in enumerate(CUBE)]


def around(centre):
    """Rays along each axis, by turns either way, at places near the centre."""
    rays = []
    for axis in range(3):
        for number, (a, b) in enumerate(PLACES):
            way = -1 if (number + axis) % 2 else 1
            local = [a, b]
            local.insert(axis, -5.0 * way)
            rays.append(ray([c + x for c, x in zip(centre, local)],
                            [0.03125 * way if i != axis else way for i in range(3)], ties="any"))
    return rays


def deformed():
    for quality in (None, "fast"):
        case = Case(f"mesh-deformed{'-' + quality if quality else ''}", "a mesh gets new vertices under several "
                    "objects, again and again: ids stay, the very next ray meets the new form", numerics=[40])
        case.mesh("m0", CUBE, CUBE_FACES, quality=quality)
        case.sphere("s", 0.5)
        places = [(0, 0, 0), (8, 1, -3), (-7, 4, 2)]
        case.insert_many("a", "m0", places, [(1, 0, 0, 0, 1, 0, 0, 0, 1), TURN, UNEVEN])
        case.insert("other", "s", (0, 0, 12))
        case.trace(*(r for p in places for r in around(p)))
        for step in (1, 2, 3):
            case.deform(f"m{step}", f"m{step - 1}", wave(step), vertex_type="f32" if step == 2 else None,
                        quality=quality)
            case.trace(*around(places[1]))  # as before: nothing is replaced yet
            case.replace_shape(f"m{step - 1}", f"m{step}")
            case.release(f"m{step - 1}")
            case.trace(*(r for p in places for r in around(p)), ray((0, 0, 20), (0, 0, -1), want=("other", 7.5)))
            case.expect_scene(objects=4)
        case.move_to("a[0]", (0, -6, 0))
        case.remove("a[1]")
        case.insert("b", "m3", (8, 1, -3))
        case.trace(*around((0, -6, 0)), *around(places[1]), *around(places[2]))
        yield case

    case = Case("mesh-deformed-grown", "new vertices carry a mesh far out of its old bounds, and back into a point "
                "of them: cells and boxes follow")
    case.mesh("small", CUBE, CUBE_FACES)
    case.deform("large", "small", [(64 * x + 100, 64 * y, 64 * z) for x, y, z in CUBE])
    case.deform("tiny", "large", [(x / 256, y / 256, z / 256) for x, y, z in CUBE])
    case.insert_many("a", "small", [(0, 0, 0), (0, 300, 0)])
    beside, within = (ray((100, 1, -100), (0, 0, 1), ties="any"),
                      ray((0.001953125, 0.0009765625, -5), (0, 0, 1), ties="any"))
    case.trace(beside, within)
    case.replace_shape("small", "large")
    case.trace(beside, within, ray((100, 310, -100), (0, 0, 1), want=("a[1]", 36.0)))
    case.replace_shape("large", "tiny")
    case.trace(beside, within, ray((0.5, 0.25, -5), (0, 0, 1), want="miss"))
    yield case

    case = Case("mesh-deformed-flat", "triangles lose their area and get it again: numbers stay", numerics=[24])
    vertices = [(0, 0, 0), (2, 0, 0), (0, 2, 0), (2, 2, 0), (4, 0, 0), (4, 2, 0)]
    faces = [(0, 1, 2), (1, 3, 2), (1, 4, 3), (4, 5, 3)]
    case.mesh("m", vertices, faces)
    flat = vertices[:4] + [(2, 0, 0), (2, 2, 0)]
    case.deform("flat", "m", flat)
    case.deform("again", "flat", vertices)
    case.insert("a", "m", (0, 0, 1))
    rays = [(0.5, 0.5), (1.5, 1.25), (2.5, 0.25), (3.5, 1.75)]
    shots = [ray((x, y, 0), (0, 0, 1), want=("a", 1.0), give={"primitive": i}) for i, (x, y) in enumerate(rays)]
    case.trace(*shots)
    case.replace_shape("m", "flat")
    case.trace(*shots[:2], *(ray((x, y, 0), (0, 0, 1), want="miss") for x, y in rays[2:]),
               ray((2, 1, 0), (0, 0, 1), want=("a", 1.0), give={"primitive": 1}))
    case.replace_shape("flat", "again")
    case.trace(*shots)
    yield case


def replaced():
    case = Case("mesh-replaced", "a shape is replaced by meshes of other triangles and by each other kind, and back: "
                "ids and poses stay")
    case.mesh("cube", CUBE, CUBE_FACES)
    case.mesh("tent", [(-2, -2, 0), (2, -2, 0), (0, 3, 0), (0, 0, 2.5)], [(0, 1, 3), (1, 2, 3), (2, 0, 3)],
              quality="fast")
    case.sphere("s", 1.25)
    case.box("b", (-0.5, -2, -1), (1, 0.75, 1.5))
    case.capsule("c", (-1, 0, 0), (1, 0, 0), 0.75)
    places = [(0, 0, 0), (9, -2, 1)]
    case.insert("a", "cube", places[0])
    case.insert("b", "cube", places[1], linear=TURN)
    case.insert("still", "s", (0, 14, 0))
    shots = [r for p in places for r in around(p)[::2]] + [ray((0, 14, -9), (0, 0, 1), ties="any")]
    case.trace(*shots)
    old = "cube"
    for new in ("tent", "b", "c", "cube", "b", "tent", "cube"):
        case.replace_shape(old, new)
        case.trace(*shots)
        old = new
    case.expect_scene(objects=3)
    yield case

    case = Case("mesh-replaced-by-sphere", "objects of a mesh become spheres, beside others that were: all of them "
                "are meshes then")
    case.mesh("m", CUBE, CUBE_FACES)
    case.sphere("s", 1.0)
    case.insert("a", "m", (0, 0, 0), linear=MIRROR)
    case.insert("b", "s", (5, 0, 0))
    shots = [r for p in ((0, 0, 0), (5, 0, 0)) for r in around(p)[::2]]
    case.trace(*shots)
    case.replace_shape("m", "s")
    case.trace(*shots)
    case.replace_shape("s", "m")
    case.trace(*shots)
    yield case


def refused():
    case = Case("mesh-deformed-refused", "what can't be the new form of a mesh: refused, nothing has changed",
                numerics=[29])
    case.mesh("m", CUBE, CUBE_FACES)
    case.sphere("s", 1.0)
    case.box("plane", (-INF, -1, -INF), (INF, 1, INF))
    case.insert("a", "m", (0, 0, 4), linear=TURN)
    case.trace(*around((0, 0, 4)))
    good = [[float(x) for x in v] for v in CUBE]
    for count in (0, 7, 9):
        case.expect_error("RG_INVALID_VALUE", "vertices", "deform", shape="bad", vertices=(good + good)[:count],
                          **{"from": "m"})
    for value in (NAN, INF, -1.1e100):
        case.expect_error("RG_INVALID_VALUE", "5", "deform", shape="bad",
                          vertices=[v if i != 5 else [0.0, 0.0, value] for i, v in enumerate(good)], **{"from": "m"})
    case.expect_error("RG_INVALID_VALUE", "2", "deform", shape="bad", vertex_type="f32",
                      vertices=[v if i != 2 else [NAN, 0.0, 0.0] for i, v in enumerate(good)], **{"from": "m"})
    case.expect_error("RG_INVALID_ARGUMENT", "mesh", "deform", shape="bad", vertices=good, **{"from": "s"})
    case.expect_error("RG_INVALID_ARGUMENT", "quality", "deform", shape="bad", vertices=good, quality=7,
                      **{"from": "m"})
    case.expect_error("RG_INVALID_ARGUMENT", "quality", "mesh", shape="bad", vertices=good, indices=[[0, 1, 2]],
                      quality=-1)
    case.expect_error("RG_INVALID_VALUE", "infinite", "replace_shape", to="plane", **{"from": "m"})
    case.expect_scene(objects=1)
    case.move("a", (0, 0, 5))
    case.trace(*around((0, 0, 5)))
    yield case


def made():
    vertices, faces = ball(4, 2.0)
    for quality in ("best", "fast"):
        for vertex_type, index_type in (("f32", "u16"), ("f64", "u32"), ("f64", "u64"), ("f32", None)):
            case = Case(f"mesh-{quality}-apart-{vertex_type}-{index_type or 'unindexed'}", "either quality, and x, y "
                        "and z of vertices and indices in arrays of their own, of every type", flags=["costly"])
            exact = [tuple(round(x * 1024) / 1024 for x in v) for v in vertices]
            if index_type:
                case.mesh("m", exact, faces, vertex_type, index_type, apart=True, quality=quality)
            else:
                case.mesh("m", [exact[i] for f in faces for i in f], None, vertex_type, apart=True, quality=quality)
            case.insert("a", "m", (0.5, 0, 0), linear=UNEVEN)
            case.trace(*around((0.5, 0, 0)))
            yield case


def posed():
    """The corners' order turns round in a mirror; the normal must not follow it inward."""
    for where, (x, y, z) in OFFSETS.items():
        case = Case(f"mesh-posed-at-{where}", "primitive, barycentrics and geometric normal under mirrored and uneven "
                    "poses", numerics=[4, 40])
        case.mesh("m", CUBE, CUBE_FACES)
        places = [(x, y, z), (x + 16, y, z), (x, y + 16, z), (x, y, z + 16)]
        case.insert_many("a", "m", places, [MIRROR, UNEVEN, tuple(-v for v in TURN), (1, 1, 0, 0, 1, 0.5, 0, 0, -2)])
        shots = [r for p in places for r in around(p)]
        case.trace(*shots)
        for cull in ("back", "front"):
            case.trace(*shots, cull=cull)
        yield case


def watertight():
    vertices, faces = ball(3, 1.0)
    pushed = [tuple(c * (1 + i % 3 / 16) for c in v) for i, v in enumerate(vertices)]
    for where, offset in OFFSETS.items():
        case = Case(f"mesh-shared-at-{where}", "rays aimed at shared vertices and edges, of a mesh as it was made and "
                    "of its next form: none gets through", numerics=[4, 21, 22], flags=["costly"])
        case.mesh("m", vertices, faces)
        case.deform("n", "m", pushed)
        case.insert("a", "m", offset)
        start = (0.125, -0.0625, 0.25)
        for corners in (vertices, pushed):
            targets = corners + [middle(corners[f[i]], corners[f[i - 1]], 0.375) for f in faces for i in range(3)
                                 if f[i] < f[i - 1]]
            case.trace(*(ray([a + b for a, b in zip(start, offset)], [b - a for a, b in zip(start, p)], ties="any",
                             tight=False) for p in targets))
            if corners is vertices:
                case.replace_shape("m", "n")
        yield case

        case = Case(f"mesh-shared-lowest-at-{where}", "on shared edges and corners met exactly the lowest triangle "
                    "wins, whatever the order in the tree", numerics=[4, 22])
        grid = [(x, y, 0) for y in range(5) for x in range(5)]
        cells = [(x + 5 * y, x + 1 + 5 * y, x + 5 + 5 * y) for y in range(4) for x in range(4)]
        cells += [(x + 6 + 5 * y, x + 5 + 5 * y, x + 1 + 5 * y) for y in range(4) for x in range(4)]
        case.mesh("m", grid, cells[::-1], quality="fast")
        case.insert("a", "m", offset)
        spots = [(x, y) for x in (0, 1, 2.5, 4) for y in (0, 1, 2, 3.5)] + [(0.5, 0.5), (2.25, 3.75), (3.5, 0.5)]
        case.trace(*(ray((offset[0] + x, offset[1] + y, offset[2] - 2), (0, 0, 1), want=("a", 2.0)) for x, y in spots))
        yield case


def all_cases():
    for group in (deformed, replaced, refused, made, posed, watertight):
        yield from group()
