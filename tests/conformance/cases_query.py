# SPDX-License-Identifier: MIT
"""Queries: range, mask, culling, invalid rays (NUMERICS 37), what a batch may not do to its rays."""

from script import INF, NAN, Case, ray


def scene(case):
    case.sphere("s", 1.0)
    case.box("b", (-1, -1, -1), (1, 1, 1))
    case.insert("ball", "s", (0, 0, 5))
    case.insert("cube", "b", (4, 0, 5))


GOOD = ((0, 0, 0), (0, 0, 1))


def invalid():
    zero = (0, 0, 0)
    bad = {
        "origin": [((v, 0, 0), (0, 0, 1), {}) for v in (NAN, INF, -INF, 1.1e100)]
        + [((0, 0, NAN), (0, 0, 1), {}), ((0, -1.1e100, 0), (0, 0, 1), {})],
        "direction": [(zero, (v, 0, 1), {}) for v in (NAN, INF, -INF)] + [(zero, (0, 0, 0), {}),
                                                                        (zero, (-0.0, 0.0, -0.0), {})],
        "range": [(*GOOD, dict(t_min=NAN)), (*GOOD, dict(t_max=NAN)), (*GOOD, dict(t_min=3.0, t_max=2.0)),
                  (*GOOD, dict(t_min=NAN, t_max=NAN)), (*GOOD, dict(t_max=-1.0)), (*GOOD, dict(t_min=INF, t_max=0.0)),
                  (*GOOD, dict(t_max=-INF))],
    }
    for name, rays in bad.items():
        case = Case(f"ray-invalid-{name}", "an invalid ray is a defined miss for itself alone, and is counted",
                    numerics=[37])
        scene(case)
        mixed = []
        for origin, direction, options in rays:
            mixed += [ray(*GOOD, want=("ball", 4.0)), ray(origin, direction, want="invalid", **options),
                      ray((4, 0, 0), (0, 0, 1), want=("cube", 4.0))]
        case.trace(*mixed)
        case.trace(*(ray(o, d, **k) for o, d, k in rays))
        case.trace(ray(*GOOD, want=("ball", 4.0)))
        yield case

    case = Case("ray-range-empty-but-valid", "t_min == t_max is valid; so are infinite ends", numerics=[37])
    scene(case)
    case.trace(ray(*GOOD, t_min=4.0, t_max=4.0, edge=True, want=("ball", 4.0)),
               ray(*GOOD, t_min=3.0, t_max=3.0, want="miss"), ray(*GOOD, t_min=INF, t_max=INF, want="miss"),
               ray(*GOOD, t_min=-INF, t_max=-INF, want="miss"), ray(*GOOD, t_min=-INF, t_max=INF, want=("ball", 4.0)),
               ray(*GOOD, t_min=-0.0, t_max=0.0, want="miss"), ray((0, 0, 0), (0, 0, -1), t_max=0.0, want="miss"))
    yield case

    case = Case("ray-origin-at-limit", "an origin of exactly the largest coordinate is valid", numerics=[37])
    scene(case)
    case.trace(ray((1e100, 0, 0), (0, 0, 1), want="miss"), ray((0, -1e100, 0), (0, 1, 0), want="miss"),
               ray((0, 0, 1e100), (0, 0, 1), want="miss"), ray((1e100, 1e100, 1e100), (1, 0, 0), want="miss"))
    yield case

    case = Case("ray-invalid-in-empty-scene", "the check comes first, with nothing to hit too", numerics=[37, 38])
    case.trace(ray((NAN, 0, 0), (0, 0, 1), want="invalid"), ray(*GOOD, want="miss"),
               ray((0, 0, 0), (0, 0, 0), want="invalid"))
    yield case


def ranges():
    case = Case("ray-range-ends", "both ends are inclusive, and a hit before t_min hides nothing behind it")
    scene(case)
    case.insert("back", "s", (0, 0, 9))
    for scale in (1.0, 0.5, 4.0):
        d = (0, 0, scale)
        case.trace(ray((0, 0, 0), d, t_max=4 / scale, edge=True, want=("ball", 4 / scale)),
                   ray((0, 0, 0), d, t_max=3.875 / scale, want="miss"),
                   ray((0, 0, 0), d, t_min=6.0 / scale, edge=True, want=("ball", 6 / scale)),
                   ray((0, 0, 0), d, t_min=6.125 / scale, want=("back", 8 / scale)),
                   ray((0, 0, 0), d, t_min=6.125 / scale, t_max=7.0 / scale, want="miss"),
                   ray((0, 0, 0), d, t_min=8.0 / scale, t_max=8.0 / scale, edge=True, want=("back", 8 / scale)),
                   ray((0, 0, 0), d, t_min=10.125 / scale, want="miss"))
    yield case

    case = Case("ray-starts-beyond-scene", "t_min beyond all that is, and an origin far outside that looks in")
    scene(case)
    case.trace(ray(*GOOD, t_min=1e6, want="miss"), ray((0, 0, -1000), (0, 0, 1), want=("ball", 1004.0)),
               ray((0, 0, -1000), (0, 0, 1), t_max=999.0, want="miss"),
               ray((0, 0, -1000), (0, 0, -1), want="miss"), ray((-500, 0, 5), (1, 0, 0), want=("ball", 499.0)),
               ray((500, 0, 5), (-1, 0, 0), want=("cube", 495.0)), ray((0, 700, -695), (0, -1, 1)),
               ray((0, 0, 1000), (0, 0, 1), t_min=-INF, want=("ball", -996.0)))
    yield case


def masks():
    case = Case("mask-bits", "a ray sees objects that share a bit with it; all 32 bits count")
    case.sphere("s", 0.5)
    case.insert_many("a", "s", [(0, 0, 2.0 * i) for i in range(32)], masks=[1 << i for i in range(32)])
    case.trace(*(ray((0, 0, -3), (0, 0, 1), mask=1 << i, want=(f"a[{i}]", 2.0 * i + 2.5)) for i in range(32)),
               ray((0, 0, -3), (0, 0, 1), mask=0, want="miss"),
               ray((0, 0, -3), (0, 0, 1), mask=0x80000100, want=("a[8]", 18.5)),
               ray((0, 0, 70), (0, 0, -1), mask=0x0000FFFF, want=("a[15]", 39.5)))
    yield case

    case = Case("mask-changed", "set_mask acts at once, also back, and a mask of 0 hides an object from all rays")
    scene(case)
    case.trace(ray(*GOOD, mask=2, want=("ball", 4.0)))
    case.set_mask("ball", 5)
    case.expect_object("ball", mask=5)
    case.trace(ray(*GOOD, mask=2, want="miss"), ray(*GOOD, mask=4, want=("ball", 4.0)),
               ray(*GOOD, want=("ball", 4.0)))
    case.set_mask("ball", 0)
    case.trace(ray(*GOOD, want="miss"), ray(*GOOD, mask=5, want="miss"),
               ray((4, 0, 0), (0, 0, 1), want=("cube", 4.0)))
    case.move_to("ball", (0, 0, 6))
    case.expect_object("ball", mask=0, position=[0.0, 0.0, 6.0])
    case.set_mask("ball", 0xFFFFFFFF)
    case.trace(ray(*GOOD, mask=0x80000000, want=("ball", 5.0)))
    yield case

    case = Case("mask-hides-nearer", "a nearer object that the ray doesn't see shadows nothing, equal ones neither",
                numerics=[12])
    scene(case)
    case.insert("twin", "s", (0, 0, 5), mask=2)
    case.insert("front", "s", (0, 0, 2), mask=4)
    case.trace(ray(*GOOD, mask=1, want=("ball", 4.0)), ray(*GOOD, mask=2, want=("ball", 4.0)),
               ray(*GOOD, mask=4, want=("front", 1.0)))
    case.set_mask("ball", 1)
    case.trace(ray(*GOOD, mask=1, want=("ball", 4.0)), ray(*GOOD, mask=2, want=("twin", 4.0)),
               ray(*GOOD, mask=3, want=("ball", 4.0)), ray(*GOOD, want=("front", 1.0)))
    yield case


def culling():
    case = Case("cull-solids", "back faces culled: from inside nothing is hit; front faces culled: the far side")
    scene(case)
    case.capsule("c", (-1, 0, 0), (1, 0, 0), 0.5)
    case.insert("rod", "c", (-4, 0, 5))
    outside = [ray((x, 0.125, 0), (0, 0, 1)) for x in (0, 4, -4)]
    inside = [ray((x, 0.125, 5), (0, 0.25, 1)) for x in (0, 4, -4)]
    for cull in (None, "back", "front"):
        case.trace(*outside, *inside, cull=cull)
    yield case

    case = Case("cull-through", "a culled face lets the ray go on to the next object, and doesn't shadow")
    case.mesh("m", [(-2, -2, 0), (2, -2, 0), (0, 2, 0)])
    case.mesh("w", [(-2, -2, 0), (0, 2, 0), (2, -2, 0)])
    case.insert("first", "m", (0, 0, 1))
    case.insert("second", "w", (0, 0, 2))
    case.insert("third", "m", (0, 0, 3))
    rays = [ray((0, 0, 0), (0, 0, 1)), ray((0.25, 0, 4), (0, 0, -1)), ray((0, 0, 1.5), (0, 0, 1)),
            ray((0, 0, 2.5), (0, 0, 1))]
    for cull in (None, "back", "front"):
        case.trace(*rays, cull=cull)
    yield case

    case = Case("cull-ties", "of two hits at one place the culled one is no hit: the higher id wins",
                numerics=[12, 27])
    case.mesh("m", [(-2, -2, 0), (2, -2, 0), (0, 2, 0)])
    case.mesh("w", [(-2, -2, 0), (0, 2, 0), (2, -2, 0)])
    case.insert("a", "m", (0, 0, 1))
    case.insert("b", "w", (0, 0, 1))
    rays = [ray((0, 0, 0), (0, 0, 1)), ray((0.25, 0, 4), (0, 0, -1))]
    for cull in (None, "back", "front"):
        case.trace(*rays, cull=cull)
    case.expect_error("RG_INVALID_ARGUMENT", "cull", "trace", cull=3, rays=[rays[0].json()])
    yield case


def batches():
    case = Case("batch-of-many", "a batch of more rays than a tile of work: every ray as if alone")
    scene(case)
    case.insert_many("more", ["s", "b"] * 8, [(3.0 * (i % 4) - 5, 3.0 * (i // 4) - 4, 9.0 + i) for i in range(16)])
    rays = []
    for i in range(18):
        for j in range(16):
            rays.append(ray(((i - 9) * 0.75 + 0.0671, (j - 8) * 0.75 + 0.0337, -3), (0.0317 * (j % 3 - 1), 0, 1)))
    case.trace(*rays)
    yield case

    case = Case("batch-of-all-directions", "neighbours in a batch that share nothing")
    scene(case)
    case.insert_many("more", "s", [(3.0 * x, 3.0 * y, 3.0 * z) for x in (-2, 0, 2) for y in (-2, 1) for z in (-2, 0)])
    rays = [ray((0.25 * i - 3.03, 0.51, 0.375 * i - 6.07), (((7 * i) % 11) - 5, ((5 * i) % 13) - 6,
                                                            ((3 * i) % 7) - 2.5))
            for i in range(64)]
    case.trace(*rays)
    yield case


def all_cases():
    for group in (invalid, ranges, masks, culling, batches):
        yield from group()
