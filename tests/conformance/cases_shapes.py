# SPDX-License-Identifier: MIT
"""What the list of stiff and extreme cases says of spheres (and of boxes), for each of the other shapes."""

from cases_grid import unit_cells
from cases_triangle import CUBE, CUBE_FACES
from exact import next_float
from script import INF, Case, ray

# All reach from -1 to 1 along y and z; along x the capsule's caps go to -2 and 2.
SHAPES = {
    "sphere": lambda case, name, size: case.sphere(name, size),
    "box": lambda case, name, size: case.box(name, (-size, -size, -size), (size, size, size)),
    "capsule": lambda case, name, size: case.capsule(name, (-size, 0, 0), (size, 0, 0), size),
    "mesh": lambda case, name, size: case.mesh(name, [tuple(size * x for x in v) for v in CUBE], CUBE_FACES),
}
OTHERS = ("box", "capsule", "mesh")
# Not on the diagonals that part a cube's faces into triangles.
ASIDE = (0.25, 0.125)


def distant():
    """Rays from afar, at places of the shape and beside it."""
    along, places = (0.48, 0.6, 0.64), [(0, 0.1, 0.2), (0.3, -0.2, 0.1), (-0.6, 0.4, -0.3), (0.5, 0.7, -0.6),
                                        (0.2, 3, 0.1), (-0.9, -1.5, 2.5), (4, 0.5, -0.5)]
    for kind in OTHERS:
        case = Case(f"shapes-{kind}-from-afar", "what cancels far away is not the sphere's quadratic alone",
                    numerics=[1, 2])
        SHAPES[kind](case, "s", 1.0)
        case.insert("a", "s", (0, 0, 0))
        for exponent in (1, 2, 3, 5, 8):
            far = 10.0 ** exponent
            origins = [[far * a + p for a, p in zip(along, place)] for place in places]
            case.trace(*(ray(o, [0.3 * (p - x) for p, x in zip(place, o)], ties="any")
                         for place, o in zip(places, origins)))
        yield case


def sizes():
    for kind in OTHERS:
        case = Case(f"shapes-{kind}-1e-6-and-1e12", "a tiny one before a huge one: the huge one's error hides it",
                    numerics=[3])
        SHAPES[kind](case, "tiny", 1e-6)
        SHAPES[kind](case, "huge", 1e12)
        case.insert("far", "huge", (0, 0, 1e12 + 5))
        case.insert("near", "tiny", (0, 0, 1))
        case.trace(ray((1e-7, 2e-7, 0), (0, 0, 1), ties="any"), ray((0, 3e-6, 0), (0.01, 0.02, 1), ties="any"),
                   ray((1, 1e-7, 1), (-1, 0, 1e-7), ties="any"), ray((1e-7, 2e-7, 1), (0.1, 0.2, 1), ties="any"),
                   ray((1e-7, 2e-7, 1 - 1e-5), (0.01, 0.01, 1), ties="any"),
                   ray((3e11, 1e11, -1), (0, 0, 1), ties="any"))
        yield case


def inside_and_on():
    x, y = ASIDE
    for kind in OTHERS:
        case = Case(f"shapes-{kind}-origin-at-centre", "the near side is behind on every axis", numerics=[5, 7])
        SHAPES[kind](case, "s", 1.0)
        case.insert("a", "s", (2, -3, 4))
        end = 2.0 if kind == "capsule" else 1.0
        case.trace(*(ray((2, -3, 4), d, want=("a", t), ties="any") for d, t in
                     [((1, 0, 0), end), ((-1, 0, 0), end), ((0, 1, 0), 1.0), ((0, -2, 0), 0.5), ((0, 0, 1), 1.0),
                      ((0, 0, -0.5), 2.0)]),
                   ray((2, -3, 4), (0.1, 0.7, -0.3), ties="any"),
                   ray((2.5, -2.5, 4.25), (0.3, -0.4, 0.2), ties="any"),
                   ray((2, -3, 4), (0.2, 0.5, 0.9), t_min=-INF, ties="any"),
                   ray((2, -3, 4), (0.2, 0.5, 0.9), t_max=0.5, want="miss"))
        yield case

        case = Case(f"shapes-{kind}-origin-on-surface", "t_min inclusive; then the start must not hide the far side",
                    numerics=[6])
        SHAPES[kind](case, "s", 1.0)
        case.insert("a", "s", (0, 0, 0))
        for side in (-1.0, 1.0):
            # On the round side of a capsule only where its numbers are exact: straight above its axis.
            at = (x, 0 if kind == "capsule" else y, side)
            case.trace(ray(at, (0, 0, side), edge=True, want=("a", 0.0)),
                       ray(at, (0, 0, -side), edge=True, want=("a", 0.0)),
                       ray(at, (0, 0, -side), t_min=2.0 ** -30, edge=True, want=("a", 2.0)),
                       ray(at, (0, 0, side), t_min=2.0 ** -30, edge=True, want="miss"))
        yield case


def tangents():
    case = Case("shapes-capsule-tangent", "an exact tangent of body or cap is a hit, the next float outside a miss",
                numerics=[8])
    SHAPES["capsule"](case, "s", 1.0)
    case.insert("a", "s", (0, 0, 0))
    outside, within = next_float(1.0, True), next_float(1.0, False)
    rays = []
    for x in (-1, -0.5, 0, 1):
        for sign in (1.0, -1.0):
            rays.append(ray((x, sign, -5), (0, 0, 1), edge=True, want=("a", 5.0)))
            rays.append(ray((x, sign * outside, -5), (0, 0, 1), want="miss"))
            rays.append(ray((x, sign * within, -5), (0, 0, 1), drop=("t", "normal", "position"), edge=True))
    rays.append(ray((2, 0, -5), (0, 0, 1), edge=True, want=("a", 5.0)))
    rays.append(ray((next_float(2.0, True), 0, -5), (0, 0, 1), want="miss"))
    case.trace(*rays)
    yield case


def lengths():
    case = Case("shapes-capsule-direction-lengths", "the square of a direction over- or underflows", numerics=[11])
    SHAPES["capsule"](case, "s", 1.0)
    case.insert("a", "s", (0, 0, 5))
    for length in (1e-20, 1e20, 1e-40, 1e-160, 1e160, 2.0 ** -1000, 2.0 ** 1000):
        case.trace(*(ray((x, 0.25, 0), (dx * length, dy * length, 0.9 * length))
                     for x, dx, dy in ((0.5, 0, 0), (1.75, 0, 0), (0, 0.01, -0.02), (-4, 0.5, 0.02), (3, 0.1, 0))))
    yield case


def duplicates():
    for kind in ("box", "capsule"):
        case = Case(f"shapes-{kind}-duplicates", "equal hits go to the lowest id, whatever the order in the cells",
                    numerics=[12])
        SHAPES[kind](case, "s", 1.0)
        case.insert_many("a", "s", [(0.5, 0.25, -0.125)] * 40)
        rays = [ray((0.75, 0.25, -5), (0, 0, 1)), ray((5, 1, 2), (-1, -0.25, -0.5)),
                ray((0.5, 0.25, 0), (0, 1, 0.25))]
        case.trace(*rays)
        case.remove("a[0]")
        case.trace(*rays)
        case.remove_many(["a[1]", "a[3]"])
        case.insert("again", "s", (0.5, 0.25, -0.125))  # a lower slot, but a higher id
        case.move_to("a[2]", (9, 9, 9))
        case.trace(*rays)
        case.move_to("a[2]", (0.5, 0.25, -0.125))
        case.trace(*rays)
        yield case


def respawned():
    for kind in SHAPES:
        case = Case(f"shapes-{kind}-offset-far", "the documented offset far from the world's origin, and from afar",
                    numerics=[4, 28])
        SHAPES[kind](case, "s", 1.0)
        at = (1e9, -7e8, 1.25e8)
        case.insert("a", "s", at)
        case.trace(*(ray((at[0] + x + 64 * d, at[1] + y, at[2] - 64), (-d, 0.01 * d, 1), ties="any")
                     for x, y in (ASIDE, (-0.5, 0.75)) for d in (0, 0.5, -0.25)),
                   respawn=[(0, 0, 1), (0.6, -0.64, 0.48), (-1, 0.001, 0)])
        yield case


def components():
    x, y = ASIDE
    for kind in OTHERS:
        case = Case(f"shapes-{kind}-tiny-components", "components of a direction that are zero of either sign, "
                    "denormal, or too small ever to arrive", numerics=[13, 20])
        SHAPES[kind](case, "s", 1.0)
        case.insert("a", "s", (0, 0, 5))
        for e in (0.0, -0.0, 1e-40, -1e-40, 1e-300, -5e-324, 2.0 ** -61):
            case.trace(ray((x, 0, 0), (e, e, 1), want=("a", 4.0), ties="any"),
                       ray((x, -4, 5.125), (-e, 1, e), ties="any"), ray((9, y, 5.25), (-1, e, e), ties="any"),
                       ray((4, y, 0), (e, e, 1), want="miss"), ray((x, 3, 0), (e, -e, 1), want="miss"))
        yield case


def on_walls():
    """Cells know bounds only, but each shape has its own; and the loose kind keeps balls and boxes apart."""
    x, y = ASIDE
    for kind in OTHERS:
        case = Case(f"shapes-{kind}-on-walls", "on walls, edges and corners of cells and tiles, for rays along them, "
                    "too", numerics=[30, 31, 33], grid=unit_cells(8))
        SHAPES[kind](case, "s", 0.5)
        places = [(2, 2, 2), (5, 3.5, 2.5), (-8, 4, 4), (12, 4, 4), (2.0 ** 31, 4, 4), (-(2.0 ** 34), 4, 4.25)]
        case.insert_many("a", "s", places)
        for place in places:
            px, py, pz = place
            rays = []
            for sign in (1.0, -1.0):
                back = [v - 2 * sign for v in place]
                rays += [ray((px + x / 2, py + y / 2, pz - 4 * sign), (0, 0, sign), ties="any"),
                         ray((px - 3 * sign, py, pz), (sign, 0, -0.0), ties="any"),
                         ray((px, py + 4 * sign, pz), (0.0, -sign, 0), ties="any"),
                         ray(back, (sign, sign, sign), ties="any", t_max=4.0),
                         ray(place, (sign, -0.0, 0.25), ties="any", t_max=4.0)]
            case.trace(*rays)
        yield case


def round_the_torus():
    for kind in OTHERS:
        case = Case(f"shapes-{kind}-carried-round", "an object carried round the torus: no ghost, no loss",
                    numerics=[36], grid=unit_cells(8))
        SHAPES[kind](case, "s", 0.75)
        case.insert("still", "s", (4, 4, 4))
        case.insert("a", "s", (2, 2, 2))
        for i in range(1, 13):
            place = (2 + 5.375 * i, 2 - 3.25 * i, 2 + 7.125 * i)
            case.move_to("a", place)
            wrapped = tuple(v % 8 for v in place)
            aside = (0, 0) if kind == "capsule" else (0.125, 0.25)
            case.trace(ray((place[0] + aside[0], place[1] + aside[1], place[2] - 3), (0, 0, 1), want=("a", 2.25),
                           ties="any"),
                       ray((wrapped[0], wrapped[1], wrapped[2]), (0.1, 0.2, 1), t_max=2.0, ties="any"),
                       ray((0, 4.125, 4.25), (1, 0, 0), ties="any", t_max=8.0))
        yield case


def all_cases():
    for group in (distant, sizes, inside_and_on, tangents, lengths, duplicates, respawned, components, on_walls,
                  round_the_torus):
        yield from group()
