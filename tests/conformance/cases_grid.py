# SPDX-License-Identifier: MIT
"""Cells: NUMERICS 30 to 36, on grids whose walls are at whole numbers."""

import math
import random

from script import Case, ray

NEVER = "never"


def unit_cells(side, lo=0.0, rebuild_factor=NEVER):
    """A cube of `side` cells of size 1 a side from (lo, lo, lo)."""
    return dict(resolution=side, lo=(lo,) * 3, hi=(lo + side,) * 3, rebuild_factor=rebuild_factor)


def walls():
    case = Case("wall-start", "a start exactly on a wall, with each sign: floor and the first step must agree",
                numerics=[30], grid=unit_cells(8, -4.0))
    case.sphere("s", 0.25)
    axes = range(3)
    for axis in axes:
        for sign in (1, -1):
            case.insert(f"{axis}{sign}", "s", [sign * 2.5 if i == axis else 0.5 for i in axes])
    for wall in (0, 1, -1, 2, -2, 4, -4):
        rays = []
        for axis in axes:
            for sign in (1.0, -1.0):
                for zero in (0.0, -0.0):
                    origin, direction = [0.5] * 3, [zero] * 3
                    origin[axis], direction[axis] = wall, sign
                    rays.append(ray(origin, direction))
        case.trace(*rays)
    yield case

    case = Case("wall-start-of-tiles", "the same on walls of the physical box and of tiles far on either side",
                numerics=[30], grid=unit_cells(4, 0.0))
    case.sphere("s", 0.25)
    places = [-40, -12, -8, -4, 0, 4, 8, 12, 40]
    case.insert_many("a", "s", [(p + 0.5, 0.5, 0.5) for p in places] + [(p - 0.5, 0.5, 2.5) for p in places])
    case.trace(*(ray((p, 0.5, z), (sign, 0, 0)) for p in places for sign in (1, -1) for z in (0.5, 2.5)))
    case.trace(*(ray((p + 0.5, 4, 0.5), (0, -1, 0)) for p in places),
               *(ray((p - 0.5, -4, 2.5), (0, 1, 0)) for p in places))
    yield case

    case = Case("wall-along", "rays along walls and along the edges of cells meet what touches either side",
                numerics=[31], grid=unit_cells(8))
    case.sphere("s", 0.375)
    case.insert("on-edge", "s", (5.5, 3, 3))
    case.insert("on-wall", "s", (2.5, 4.5, 3))
    case.insert("beside", "s", (6.5, 5.75, 5.5))
    case.insert("corner", "s", (2, 6, 6))
    rays = []
    for zero in (0.0, -0.0):
        rays += [ray((0, 3, 3), (1, zero, zero), want=("on-edge", 5.125)), ray((9, 3, 3), (-1, zero, zero)),
                 ray((0, 4.5, 3), (1, zero, zero), want=("on-wall", 2.125)), ray((2.5, 0, 3), (zero, 1, zero)),
                 ray((0, 6, 5.5), (1, zero, zero)), ray((0, 5, 5.5), (1, zero, zero), want="miss"),
                 ray((0, 6, 6), (1, zero, zero), want=("corner", 1.625)), ray((2, 9, 6), (zero, -1, zero)),
                 ray((2, 6, 0), (zero, zero, 1)), ray((0, 4, 4), (1, zero, zero), want="miss"),
                 ray((4, 8, 4), (zero, -1, zero), want="miss")]
    case.trace(*rays)
    yield case

    case = Case("wall-corners", "diagonals through the corners of cells: three walls at once, either way",
                numerics=[31], grid=unit_cells(8))
    case.sphere("s", 0.25)
    case.sphere("large", 0.5)
    case.insert("middle", "s", (4.5, 4.5, 4.5))
    case.insert("at-corner", "large", (6, 6, 6))
    case.insert("off", "s", (2.5, 3.5, 2.5))
    case.insert("flat", "s", (5.5, 2.5, 0.5))
    case.trace(ray((0, 0, 0), (1, 1, 1)), ray((8, 8, 8), (-1, -1, -1)), ray((-5, -5, -5), (2, 2, 2)),
               ray((0, 8, 0), (1, -1, 1), want="miss"), ray((0, 1, 0), (1, 1, 1)), ray((8, 9, 8), (-1, -1, -1)),
               ray((8, 0, 0.5), (-1, 1, 0)), ray((3, 0, 0.5), (1, 1, 0)), ray((8, 4, 8), (-1, 1, -1)),
               ray((9, 3, 9), (-1, 1, -1)), ray((2, 2, 2), (1, 1, 1)), ray((5, 5, 5), (-1, -1, -1)),
               ray((5, 5, 5), (1, 1, 1)), ray((6, 6, 6), (-1, -1, -1)))
    yield case

    case = Case("wall-tiny-components", "components so small that no wall on their axis is ever reached",
                numerics=[20, 30], grid=unit_cells(8))
    case.sphere("s", 0.25)
    case.insert_many("a", "s", [(6.5, 2, 2), (6.5, 5.875, 3.125), (2.5, 2.5, 6.5)])
    for e in (1e-40, -1e-40, 1e-300, -5e-324, 2.0 ** -61, -2.0 ** -59):
        case.trace(ray((0, 2, 2), (1, e, -e), want=("a[0]", 6.25)), ray((9, 2, 2), (-1, e, e), want=("a[0]", 2.25)),
                   ray((0, 6, 3), (1, e, e)), ray((2.5, 2.5, 8), (e, e, -1), want=("a[2]", 1.25)),
                   ray((0, 4, 4), (1, e, -e), want="miss"))
    yield case


def stretches(origin, direction, side):
    """The stretches of a ray within unit cells of a square: length and middle, in units of the direction; in doubles."""
    walls_met = sorted((i - origin[a]) / direction[a] for a in (0, 1) for i in range(side + 1))
    for start, end in zip(walls_met, walls_met[1:]):
        middle = (start + end) / 2
        if all(0 < origin[a] + middle * direction[a] < side for a in (0, 1)):
            yield end - start, middle


def clipped_corners(rng, side, count):
    """Of some dozen random rays those that clip a cell's corner by the least, and where."""
    found = []
    for _ in range(96):
        origin = (rng.random() * side, -rng.random(), 0.25 + 0.5 * rng.random())
        direction = (rng.random() * 2 - 1, rng.random() + 0.1, 0.0)
        found.append((*min(stretches(origin, direction, side)), origin, direction))
    return sorted(found)[:count]


def fine():
    side, rng = 1024, random.Random(1024)
    clips = clipped_corners(rng, side, 48)
    for number in range(4):
        case = Case(f"walk-clipped-corners-{number}", "t += dt skips cells that rays only clip, on 31 to 43 % of them "
                    "at 1024 cells a side: an object is in each", numerics=[32],
                    grid=dict(resolution=side, lo=(0.0, 0.0, 0.0), hi=(1024.0, 1024.0, 1.0), rebuild_factor=NEVER))
        case.sphere("corner", 0.0625)
        case.insert_many("c", "corner", [(0.5, 0.5, 0.125), (1023.5, 1023.5, 0.875)])  # the logical box is the whole
        rays = []
        for i, (_, middle, origin, direction) in enumerate(clips[number::4]):
            place = [a + middle * b for a, b in zip(origin, direction)]
            # Smaller than the corner that is clipped, larger than the rounding of its place.
            case.sphere(f"s{i}", min(abs(x - round(x)) for x in place[:2]) / 2)
            case.insert(f"a{i}", f"s{i}", place)
            rays.append(ray(origin, direction, want=(f"a{i}", None)))
        case.trace(*rays)
        yield case

    case = Case("walk-a-million-cells", "an accumulated step drifts by 1,288 cells after 1e6 steps", numerics=[32],
                flags=["costly"], grid=dict(resolution=2 ** 20, lo=(0.0, 0.0, 0.0), hi=(2.0 ** 20, 1.0, 1.0),
                                            rebuild_factor=NEVER))
    case.sphere("s", 2.0 ** -8)
    last = 2.0 ** 20 - 0.5
    case.insert("first", "s", (0.5, 0.125, 0.125))
    case.insert("last", "s", (last, 0.75, 0.5))
    case.trace(ray((-1, 0.75, 0.5), (1, 0, 0)), ray((-1, 0.76, 0.5), (1, 0, 0), want="miss"),
               ray((0, 0.25, 0.5), (last, 0.5, 0)), ray((0, 1, 1), (last, -0.25, -0.5)),
               ray((2.0 ** 20 + 3, 0.125, 0.125), (-1, 0, 0)), ray((2.0 ** 20, 0.75, 0.25), (-last, 0, 0.25 * 0.999)))
    yield case


def far_away():
    for name, at in (("2^31", 2.0 ** 31), ("-2^31", -(2.0 ** 31)), ("2^34", 2.0 ** 34), ("-2^34", -(2.0 ** 34)),
                     ("2^50", 2.0 ** 50), ("-2^50", -(2.0 ** 50)), ("1e30", 2.0 ** 100)):
        case = Case(f"tile-index-{name}", "cell or tile numbers beyond 32 bits, or any integer: float to int "
                    "beyond the range is undefined", numerics=[33], grid=unit_cells(8))
        case.sphere("s", 0.25)
        size = max(0.5, abs(at) * 2.0 ** -48)
        case.sphere("far", size)
        case.insert("home", "s", (0.5, 0.5, 0.5))
        for axis in range(3):
            case.insert(f"far{axis}", "far", [at if i == axis else 4.5 for i in range(3)])
        rays = [ray((0.5, 0.5, -5), (0, 0, 1), want=("home", 5.25))]
        for axis in range(3):
            along, across = [0.0] * 3, [0.0] * 3
            along[axis], across[(axis + 1) % 3] = 1.0, 1.0
            for sign in (1.0, -1.0):
                rays.append(ray([at - sign * 8 * size if i == axis else 4.5 for i in range(3)],
                                [sign * x for x in along]))
                rays.append(ray([at if i == axis else 4.5 - sign * 8 * size if across[i] else 4.5 for i in range(3)],
                                [sign * x for x in across]))
            rays.append(ray([4.5] * 3, [math.copysign(1.0, at) * x for x in along]))
        case.trace(*rays)
        yield case


def crowds():
    case = Case("cell-with-1e6-objects", "a million objects in one cell: right, and in bounded time and memory",
                numerics=[34], flags=["costly"], grid=dict(resolution=1, lo=(0.0,) * 3, hi=(1.0,) * 3,
                                                           rebuild_factor=NEVER))
    case.sphere("s", 0.125)
    step, count = 2.0 ** -21, 1000000
    # When a ray enters a ball is a convex function of the ball's centre: what is least among its neighbours is least.
    middle = 500000
    case.insert_line("a", "s", (0.25, 0.5, 0.5), (step, 0, 0), count,
                     consider=[0, 1, 2, count - 3, count - 2, count - 1, *range(middle - 2, middle + 3)])
    case.trace(ray((-1, 0.5, 0.5), (1, 0, 0), want=("a[0]", 1.125)),
               ray((2, 0.5, 0.5), (-1, 0, 0), want=(f"a[{count - 1}]", 2 - 0.375 - (count - 1) * step)),
               ray((0.25 + middle * step, 0.5, -1), (0, 0, 1), want=(f"a[{middle}]", 1.375)),
               ray((0.25, 0.7, 0.5), (1, 0, 0), want="miss"))
    case.expect_grid(objects=count, entries=count, tiles=1)
    case.expect_scene(objects=count)
    yield case

    case = Case("object-over-1e9-cells", "an object larger than all cells together is stored once and tested once",
                numerics=[35], grid=dict(resolution=64, lo=(0.0,) * 3, hi=(1.0,) * 3, rebuild_factor=NEVER))
    case.sphere("s", 1000.0)
    case.sphere("small", 2.0 ** -8)
    case.insert("a", "s", (0, 0, 0))
    case.insert("b", "small", (0.5, 0.5, 0.5))
    case.expect_grid(unbounded=1, objects=2, entries={"max": 9})
    case.trace(ray((-2000, 0, 0), (1, 0, 0), want=("a", 1000.0)), ray((0, 0, 0), (0, 1, 0), want=("a", 1000.0)),
               ray((0.5, 0.5, 0), (0, 0, 1), want=("b", 0.5 - 2.0 ** -8)), ray((0.5, 0.25, 0.5), (0, 0, 1)),
               ray((2000, 0, 0), (1, 0, 0), want="miss"))
    case.move_to("a", (5000, 0, 0))
    case.trace(ray((-2000, 0, 0), (1, 0, 0), want=("a", 6000.0)), ray((0, 0, 0), (0, 1, 0), want="miss"))
    case.remove("a")
    case.expect_grid(unbounded=0, objects=1)
    case.trace(ray((-2000, 0, 0), (1, 0, 0), want="miss"))
    yield case

    case = Case("object-at-coarsest-level", "an object nearly as large as the box goes to the coarsest level",
                numerics=[35], grids=["hierarchical"], grid=unit_cells(256))
    case.sphere("s", 120.0)
    case.sphere("small", 0.25)
    case.insert("a", "s", (128, 128, 128))
    case.expect_grid(unbounded=0, entries={"max": 8}, levels=9, levels_used=1 << 8)
    case.insert("b", "small", (0.5, 0.5, 0.5))
    case.expect_grid(levels_used=1 << 8 | 1)
    case.trace(ray((128, 128, -100), (0, 0, 1), want=("a", 108.0)), ray((0.5, 0.5, -1), (0, 0, 1), want=("b", 1.25)),
               ray((128, 128, 128), (1, 0, 0), want=("a", 120.0)))
    yield case


def torus():
    step = (5.375, -3.25, 7.125)
    case = Case("torus-carried-round", "an object carried round the torus many times: no ghost, no loss",
                numerics=[36], grid=unit_cells(8))
    case.sphere("s", 0.75)
    case.insert("still", "s", (4, 4, 4))
    case.insert("a", "s", (2, 2, 2))
    for i in range(1, 41):
        place = tuple(2 + i * x for x in step)
        before = tuple(2 + (i - 1) * x for x in step)
        case.move_to("a", place)
        if i % 4 == 0:
            wrapped = tuple(x % 8 for x in place)
            case.trace(ray((place[0] - 3, place[1], place[2]), (1, 0, 0), want=("a", 2.25)),
                       ray((before[0], before[1] + 3, before[2]), (0, -1, 0), t_max=4.0),
                       ray((wrapped[0], wrapped[1], wrapped[2]), (0, 0, 1), t_max=2.0, ties="any"),
                       ray((0, 4, 4), (1, 0, 0), want=("still", 3.25)))
            case.expect_grid(objects=2, entries={"max": 2 * 27}, tiles={"max": 16})
    case.move_to("a", (2, 2, 2))
    case.expect_grid(objects=2, tiles=1)
    case.trace(ray((2, 2, 0), (0, 0, 1), want=("a", 1.25)), ray((-9, 4, 4), (1, 0, 0), want=("still", 12.25)),
               ray((217, -128, 287), (-1, 0, 0), want="miss"))
    yield case

    case = Case("torus-equals-fresh", "after many turns the scene answers as one that was made where it is now",
                numerics=[36], grid=unit_cells(4))
    case.sphere("s", 0.4)
    case.box("b", (-0.5, -0.25, -0.125), (0.5, 0.25, 0.125))
    case.insert_many("a", ["s", "b"] * 12, [(0.3 * i, 0.17 * i, 0.23 * i) for i in range(24)])
    for turn in range(1, 7):
        case.move_many([f"a[{i}]" for i in range(24)],
                       [(0.9 * (i % 5) + turn * (i % 3 - 1) * 7.3, 1.1 * (i // 5) - turn * 2.9, 0.61 * i + turn * 3.7)
                        for i in range(24)])
    case.remove_many([f"a[{i}]" for i in range(0, 24, 6)])

    def final(i):
        return (0.9 * (i % 5), 1.1 * (i // 5), 1.3 * (i % 7))
    kept = [i for i in range(24) if i % 6]
    case.move_many([f"a[{i}]" for i in kept], [final(i) for i in kept])
    case.trace(*(ray((final(i)[0] + 0.07, final(i)[1] - 0.03, -6), (0, 0, 1)) for i in range(24)),
               *(ray((-30, final(i)[1] + 0.04, final(i)[2] + 0.02), (1, 0, 0)) for i in range(24)))
    case.expect_grid(objects=20, tiles={"max": 27})
    yield case


def all_cases():
    for group in (walls, fine, far_away, crowds, torus):
        yield from group()

