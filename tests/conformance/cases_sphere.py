# SPDX-License-Identifier: MIT
"""Spheres: NUMERICS 1 to 12."""

from exact import next_float
from script import INF, NAN, Case, ray

AXES = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]


def distant():
    """Rays from afar at impact parameters from the centre to two radii."""
    impacts = [0, 0.25, 0.5, 0.75, 0.9, 0.99, 0.999, 1.001, 1.01, 1.25, 1.5, 2]
    along, across, other = (0.48, 0.6, 0.64), (-0.8, 0.6, 0.0), (-0.384, -0.512, 0.768)
    for exponent in [*range(1, 9), 10, 12, 15]:
        stiff = exponent > 5
        case = Case(f"sphere-distance-1e{exponent}", "b^2 - 4ac cancels: nearly all hits lost at distance/radius 1e4"
                    if not stiff else "beyond 1e4 the ray's origin must be moved near the sphere first",
                    numerics=[2 if stiff else 1])
        case.sphere("s", 1.0)
        case.insert("a", "s", (0, 0, 0))
        far = 10.0 ** exponent
        rays = []
        for i, impact in enumerate(impacts):
            side = across if i % 2 else other
            origin = [far * a + impact * s for a, s in zip(along, side)]
            # The direction is that to the point next to the centre, so that the impact is right at every distance.
            target = [impact * s for s in side]
            # 0.3: so that t is no whole number, and t * direction rounds.
            rays.append(ray(origin, [0.3 * (t - o) for t, o in zip(target, origin)]))
        case.trace(*rays)
        yield case


def sizes():
    case = Case("sphere-radii-1e-6-and-1e12", "a tiny sphere before a huge one: the huge one's error hides it",
                numerics=[3])
    case.sphere("tiny", 1e-6)
    case.sphere("huge", 1e12)
    case.insert("far", "huge", (0, 0, 1e12 + 5))
    case.insert("near", "tiny", (0, 0, 1))
    case.trace(ray((0, 0, 0), (0, 0, 1)), ray((5e-7, 0, 0), (0, 0, 1)), ray((0, 3e-6, 0), (0, 0, 1)),
               ray((1, 0, 1), (-1, 0, 0)), ray((1, 0, 1), (-1, 3e-6, 0)), ray((0, 0, 1), (0, 0, 1)))
    yield case

    for exponent in (7, 9, 12):
        at = 10.0 ** exponent
        case = Case(f"sphere-world-offset-1e{exponent}", "float or world-relative arithmetic drowns the scene",
                    numerics=[4])
        case.sphere("s", 0.75)
        case.capsule("c", (0, -0.5, 0), (0, 0.5, 0), 0.25)
        case.box("b", (-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))
        case.insert("sphere", "s", (at, -at, at))
        case.insert("capsule", "c", (at + 2, -at, at + 0.25))
        case.insert("box", "b", (at - 2, -at + 0.25, at))
        case.insert("turned", "b", (at, -at + 3, at), linear=(0.75, 0.5, 0, -0.5, 0.75, 0, 0, 0, 1))
        case.trace(*(ray((at + x, -at + y, at - 8), (dx, dy, 1)) for x, y, dx, dy in [
            (0, 0, 0, 0), (0.5, 0.25, 0, 0), (0.8, 0, 0, 0), (2, 0.25, 0, 0), (2.125, 0.5, 0, 0), (2.3, 0.7, 0, 0),
            (-2, 0, 0, 0), (-1.75, 0.5, 0, 0), (-2.6, 0, 0, 0), (0, 3, 0, 0), (0.25, 3.25, 0, 0), (1, 3.5, 0, 0),
            (1, 1, -0.125, -0.125), (-3, 2, 0.125, -0.25), (4, -1, -0.25, 0.125)]),
            ray((at + 9, -at, at - 0.125), (-1, 0, 0)), ray((at, -at + 9, at + 0.25), (0, -2, 0)))
        yield case


def inside_and_on():
    case = Case("sphere-origin-at-centre", "the near root is behind, c/q divides by zero", numerics=[5])
    case.sphere("s", 1.5)
    case.insert("a", "s", (2, -3, 4))
    case.trace(*(ray((2, -3, 4), d, want=("a", 1.5)) for d in AXES),
               ray((2, -3, 4), (3, 4, 0), want=("a", 0.3)), ray((2, -3, 4), (0.1, 0.7, -0.3)))
    yield case

    case = Case("sphere-origin-on-surface", "t_min inclusive; then the start must not hide the far side",
                numerics=[6])
    case.sphere("s", 2.0)
    case.insert("a", "s", (0, 0, 0))
    for axis in AXES:
        at, back = [2 * x for x in axis], [-x for x in axis]
        case.trace(ray(at, axis, edge=True, want=("a", 0.0)), ray(at, back, edge=True, want=("a", 0.0)),
                   ray(at, back, t_min=2.0 ** -30, edge=True, want=("a", 4.0)),
                   ray(at, axis, t_min=2.0 ** -30, edge=True, want="miss"))
    yield case

    case = Case("sphere-origin-inside", "the far root with the outward normal, not one turned to the ray",
                numerics=[7])
    case.sphere("s", 4.0)
    case.insert("a", "s", (1, 1, 1))
    case.trace(ray((1, 1, 4), (0, 0, 1), want=("a", 1.0)), ray((1, 1, 4), (0, 0, -1), want=("a", 7.0)),
               ray((3, 1, 1), (0, 2, 0)), ray((2, 0, 1), (0.3, -0.5, 0.7)), ray((1, 4.99, 1), (0, 1, 0), tight=False))
    yield case

    case = Case("sphere-range-inside", "t_max within the sphere, t_min beyond the near side", numerics=[7])
    case.sphere("s", 1.0)
    case.insert("a", "s", (0, 0, 5))
    case.trace(ray((0, 0, 0), (0, 0, 1), t_max=3.5, want="miss"),
               ray((0, 0, 0), (0, 0, 1), t_max=4.0, edge=True, want=("a", 4.0)),
               ray((0, 0, 0), (0, 0, 1), t_min=4.0, edge=True, want=("a", 4.0)),
               ray((0, 0, 0), (0, 0, 1), t_min=4.5, want=("a", 6.0)),
               ray((0, 0, 0), (0, 0, 1), t_min=4.5, t_max=5.5, want="miss"),
               ray((0, 0, 0), (0, 0, 1), t_min=6.0, edge=True, want=("a", 6.0)),
               ray((0, 0, 0), (0, 0, 1), t_min=6.5, want="miss"),
               ray((0, 0, 0), (0, 0, 1), t_min=6.0, t_max=6.0, edge=True, want=("a", 6.0)))
    yield case

    case = Case("sphere-negative-range", "rays may look backwards: t_min below zero, t_min -inf", numerics=[7])
    case.sphere("s", 1.0)
    case.insert("a", "s", (0, 0, -5))
    case.insert("b", "s", (0, 0, 5))
    case.trace(ray((0, 0, 0), (0, 0, 1), t_min=-INF, want=("a", -6.0)),
               ray((0, 0, 0), (0, 0, 1), t_min=-5.0, want=("a", -4.0)),
               ray((0, 0, 0), (0, 0, 1), t_min=-3.0, want=("b", 4.0)),
               ray((0, 0, 0), (0, 0, -1), t_min=-INF, t_max=-1.0, want=("b", -6.0)),
               ray((0, 0, 0), (0, 1, 0), t_min=-INF, want="miss"))
    yield case


def tangent():
    case = Case("sphere-tangent", "an exact tangent is a hit, the next float outside a miss", numerics=[8])
    case.sphere("s", 1.0)
    case.insert("a", "s", (0, 0, 0))
    outside = next_float(1.0, True)
    within = next_float(1.0, False)
    rays = []
    for axis, side in ((0, 1), (1, 2), (2, 0)):
        for sign in (1.0, -1.0):
            origin, direction = [0.0] * 3, [0.0] * 3
            origin[axis], direction[axis] = -5.0, 1.0
            origin[side] = sign
            rays.append(ray(origin, direction, edge=True, want=("a", 5.0)))
            rays.append(ray([sign * outside if i == side else x for i, x in enumerate(origin)], direction,
                            want="miss"))
            rays.append(ray([sign * within if i == side else x for i, x in enumerate(origin)], direction))
    case.trace(*rays)
    yield case

    case = Case("sphere-tangent-slanted", "a tangent from a 3-4-5 triangle: exact though not along an axis",
                numerics=[8])
    case.sphere("s", 3.0)
    case.insert("a", "s", (0, 0, 0))
    case.trace(ray((5, 0, 0), (-3.2, 2.4, 0), drop=("t", "normal", "position"), edge=True,
                   give={"object": ["a", None]}),
               ray((5, 0, 0), (-3.25, 2.4, 0)), ray((5, 0, 0), (-3.15, 2.4, 0), want="miss"))
    yield case


def refused():
    bad = [("zero", 0.0), ("negative", -1.0), ("nan", NAN), ("infinite", INF), ("too-small", 1e-101),
           ("too-large", 1.1e100), ("minus-infinite", -INF), ("negative-zero", -0.0)]
    for name, radius in bad:
        case = Case(f"sphere-radius-{name}", "a bad radius is refused by name and the neighbours stay",
                    numerics=[9 if radius == 0 else 10])
        case.sphere("s", 1.0)
        case.insert("a", "s", (0, 0, 0))
        case.insert("b", "s", (3, 0, 0))
        case.trace(ray((0, 0, -5), (0, 0, 1), want=("a", 4.0)), ray((-5, 0, 0), (1, 0, 0), want=("a", 4.0)),
                   ray((9, 0, 0), (-1, 0, 0), want=("b", 5.0)), ray((0, 5, 0), (0, 1, 0), want="miss"))
        case.expect_error("RG_INVALID_VALUE", "radius", "sphere", shape="bad", radius=radius)
        case.expect_scene(objects=2)
        yield case


def lengths():
    for name, length in [("1e-20", 1e-20), ("1e20", 1e20), ("1e-40", 1e-40), ("1e-160", 1e-160), ("1e160", 1e160),
                         ("2^-1000", 2.0 ** -1000), ("2^1000", 2.0 ** 1000)]:
        case = Case(f"sphere-direction-length-{name}", "the direction is never normalized for the host; its square "
                    "over- or underflows", numerics=[11])
        case.sphere("s", 1.0)
        case.box("b", (-1, -1, -1), (1, 1, 1))
        case.mesh("m", [(-1, -1, 0), (1, -1, 0), (0, 1, 0)])
        case.insert("ball", "s", (0, 0, 5))
        case.insert("cube", "b", (5, 0, 5))
        case.insert("face", "m", (-5, 0, 5))
        case.trace(*(ray((x, 0.25, 0), (0, 0, length)) for x in (0.25, 5.25, -4.875, 2.5)),
                   *(ray((x, 0.25, 0), (0.01 * length, -0.02 * length, 0.9 * length)) for x in (0.0, 4.5, -5.25,
                                                                                                2.5)))
        yield case

    case = Case("sphere-direction-denormal", "a denormal direction is a direction: 1/d overflows, its square is 0",
                numerics=[11])
    case.sphere("s", 1.0)
    case.sphere("small", 2.0 ** -60)
    case.insert("a", "s", (0, 0, 4))
    case.trace(ray((0, 0, 0), (0, 0, 2.0 ** -1022), want=("a", 3 * 2.0 ** 1022)),
               ray((0, 0.5, 0), (2.0 ** -1026, 0, 2.0 ** -1022)), ray((0, 4, 0), (0, 0, 2.0 ** -1022), want="miss"))
    case.remove("a")
    case.insert("b", "small", (0, 0, 2.0 ** -56))
    case.trace(ray((0, 0, 0), (0, 0, 3 * 2.0 ** -1060)), ray((0, 0, 0), (2.0 ** -1066, 0, 2.0 ** -1060)),
               ray((0, 0, 0), (2.0 ** -1062, 0, 2.0 ** -1060), want="miss"))
    yield case


def duplicates():
    case = Case("sphere-hundred-duplicates", "equal hits go to the lowest id, whatever the order in the cells",
                numerics=[12])
    case.sphere("s", 1.0)
    case.insert_many("a", "s", [(0.5, 0.25, -0.125)] * 100)
    rays = [ray((0.5, 0.25, -5), (0, 0, 1), want=("a[0]", 3.875)), ray((4, 1, 2), (-1, -0.25, -0.5)),
            ray((0.5, 0.25, -0.125), (0, 1, 0), want=("a[0]", 1.0))]
    case.trace(*rays)
    case.remove("a[0]")
    for r in rays:
        r.want = None
    case.trace(*rays)
    case.remove_many(["a[1]", "a[2]", "a[4]"])
    case.trace(*rays)
    case.insert("again", "s", (0.5, 0.25, -0.125))  # a lower slot, but a higher id
    case.trace(*rays)
    case.remove_many([f"a[{i}]" for i in range(3, 100) if i != 4])
    case.trace(*rays)
    yield case

    case = Case("sphere-duplicates-moved", "equal hits don't depend on the order of insertion or moves",
                numerics=[12])
    case.sphere("s", 1.0)
    case.insert_many("a", "s", [(3.0 * i, 0, 0) for i in range(8)])
    for i in (5, 2, 7, 0, 3):
        case.move_to(f"a[{i}]", (1.0, 2.0, 3.0))
    case.trace(ray((1, 2, 9), (0, 0, -1), want=("a[0]", 5.0)), ray((1, 2, 3), (1, 0, 0), want=("a[0]", 1.0)))
    case.move_to("a[0]", (0, 0, 0))
    case.trace(ray((1, 2, 9), (0, 0, -1), want=("a[2]", 5.0)), ray((1, 2, 3), (1, 0, 0), want=("a[2]", 1.0)))
    yield case


def shared():
    case = Case("sphere-shape-released", "an object keeps its shape alive after the host let go")
    case.sphere("s", 1.0)
    case.insert("a", "s", (0, 0, 0))
    case.insert("b", "s", (4, 0, 0))
    case.release("s")
    case.trace(ray((0, 0, -3), (0, 0, 1), want=("a", 2.0)), ray((4, 0, -3), (0, 0, 1), want=("b", 2.0)))
    case.remove("a")
    case.trace(ray((0, 0, -3), (0, 0, 1), want="miss"), ray((4, 0, -3), (0, 0, 1), want=("b", 2.0)))
    yield case

    case = Case("sphere-extreme-radii", "the smallest and largest radii that the header allows", numerics=[3])
    case.sphere("small", 1e-100)
    case.sphere("large", 1e100)
    case.insert("tiny", "small", (0, 0, 0))
    case.trace(ray((0, 0, -1e-99), (0, 0, 1)), ray((0, 0, -1), (0, 0, 1)), ray((2e-100, 0, -1e-98), (0, 0, 1)))
    case.remove("tiny")
    case.insert("vast", "large", (0, 0, 0))
    case.trace(ray((0, 0, 0), (0, 0, 1)), ray((3, 4, 5), (0, 1, 0)), ray((0, 0, 5e99), (1, 0, 0.5)))
    yield case


def all_cases():
    for group in (distant, sizes, inside_and_on, tangent, refused, lengths, duplicates, shared):
        yield from group()

