# SPDX-License-Identifier: MIT
"""Random scenes of all shapes under random poses, changed between traces."""

import random

from cases_pose import floats
from cases_triangle import CUBE, CUBE_FACES
from geometry import inverse, root, vector
from script import Ambiguous, Case, ray

SEEDS = range(1, 13)
SHAPES = ["sphere", "box", "capsule", "mesh", "slab"]


def linear_part(rng):
    """None, or nine floats of a condition below 30 or so."""
    if rng.random() < 0.4:
        return None
    while True:
        m = floats([rng.random() * 2 - 1 for _ in range(9)])
        exact = vector(m)
        try:
            inverted = inverse(exact)
        except ZeroDivisionError:
            continue
        if root(sum(x * x for x in exact) * sum(x * x for x in inverted)) < 30:
            return m


def place(rng, spread):
    return [(rng.random() * 2 - 1) * spread for _ in range(3)]


def clear_rays(case, rng, spread, count):
    """Random rays that don't touch any silhouette within the documented bound."""
    rays = []
    while len(rays) < count:
        origin = place(rng, 1.5 * spread)
        target = place(rng, spread)
        r = ray(origin, [t - o for t, o in zip(target, origin)], ties="any",
                t_min=0.25 * int(rng.random() * 3), t_max=(1.5, 3.0, float("inf"))[int(rng.random() * 3)])
        try:
            case.expected(r, None)
        except Ambiguous:
            continue
        rays.append(r)
    return rays


def scene(seed):
    rng = random.Random(seed)
    spread = 2.0 ** (seed % 4) * 3
    case = Case(f"random-{seed}", "all shapes, poses and sizes at once, changed between traces")
    case.sphere("sphere", 0.8)
    case.box("box", (-1, -0.5, -0.3), (0.4, 0.6, 0.7))
    case.capsule("capsule", (-0.7, 0.1, 0), (0.8, -0.2, 0.5), 0.35)
    case.mesh("mesh", CUBE, CUBE_FACES, index_type="u16", vertex_type="f32")
    case.box("slab", (-2, -2, 0), (2, 2, 0.0625))
    count = 40
    for i in range(count):
        case.insert(f"o{i}", SHAPES[int(rng.random() * len(SHAPES))], place(rng, spread), linear=linear_part(rng))
    case.trace(*clear_rays(case, rng, spread, 12))
    for i in range(0, count, 3):
        case.move(f"o{i}", place(rng, 2 * spread), linear=linear_part(rng))
    for i in range(1, count, 9):
        case.remove(f"o{i}")
    case.trace(*clear_rays(case, rng, 2 * spread, 12))
    for i in range(1, count, 9):
        case.insert(f"o{i}", SHAPES[int(rng.random() * len(SHAPES))], place(rng, 4 * spread), linear=linear_part(rng))
    kept = [f"o{i}" for i in range(2, count, 3)]
    case.move_many(kept, [place(rng, spread) for _ in kept])
    case.trace(*clear_rays(case, rng, 3 * spread, 12))
    return case


def all_cases():
    for seed in SEEDS:
        yield scene(seed)
