# SPDX-License-Identifier: MIT
"""Capsules."""

from script import INF, NAN, Case, ray


def plain():
    case = Case("capsule-sides-and-caps", "the body ends where the caps begin: no seam, no lid")
    case.capsule("c", (0, 0, -2), (0, 0, 2), 1.0)
    case.insert("a", "c", (0, 0, 0))
    case.trace(ray((-5, 0, 0), (1, 0, 0), want=("a", 4.0)), ray((-5, 0, 1.75), (1, 0, 0), want=("a", 4.0)),
               ray((0, 0, -9), (0, 0, 1), want=("a", 6.0)), ray((0, 0, 9), (0, 0, -1), want=("a", 6.0)),
               ray((-5, 0, 2), (1, 0, 0), edge=True, want=("a", 4.0)), ray((-5, 0, 2.6), (1, 0, 0)),
               ray((-5, 0, 3.25), (1, 0, 0), want="miss"), ray((-5, 0.5, 2.75), (1, 0, 0.01)),
               ray((0.5, 0.25, -9), (0, 0, 1)), ray((0.5, 0.25, -9), (0.01, -0.02, 1)),
               ray((-5, 0.9, -3), (1, 0, 0.8)), ray((4, 4, 4), (-1, -1, -1)),
               ray((3, 1.5, 0), (0, 0, 1), want="miss"))
    yield case

    case = Case("capsule-inside", "the far side from inside the body, from inside a cap, along the axis")
    case.capsule("c", (-3, 0, 0), (3, 0, 0), 0.5)
    case.insert("a", "c", (0, 1, 0))
    case.trace(ray((0, 1, 0), (0, 1, 0), want=("a", 0.5)), ray((0, 1, 0), (1, 0, 0), want=("a", 3.5)),
               ray((3.25, 1, 0), (-1, 0, 0), want=("a", 6.75)), ray((3.25, 1, 0), (0, 0, 1)),
               ray((-2.9, 1.1, 0.1), (1, 0.01, 0)), ray((-4.5, 1, 0), (1, 0, 0), t_min=1.5, want=("a", 8.0)),
               ray((0, 1, 0), (0, 1, 0), t_min=-INF, want=("a", -0.5)))
    yield case

    case = Case("capsule-one-point", "a == b is a sphere: no 0/0 from the axis")
    case.capsule("c", (1, 2, 3), (1, 2, 3), 0.75)
    case.insert("a", "c", (-1, -2, -3))
    case.trace(ray((0, 0, -4), (0, 0, 1), want=("a", 3.25)), ray((0.5, 0, -4), (0, 0, 1)),
               ray((0, 0, 0), (1, 0, 0), want=("a", 0.75)), ray((0.8, 0, -4), (0, 0, 1), want="miss"),
               ray((3, 2, 1), (-3, -2, -1)))
    yield case

    case = Case("capsule-slanted", "an axis in general position")
    case.capsule("c", (-1.5, 0.25, 2), (2.5, -1, -0.75), 0.6)
    case.insert("a", "c", (0.1, 0.2, 0.3))
    case.trace(*(ray((x, y, -9), (dx, dy, 1)) for x, y, dx, dy in [
        (0, 0, 0, 0), (1, -0.3, 0, 0), (-1.5, 0.5, 0, 0), (2.7, -1, 0, 0), (-2, 1, 0.05, -0.03), (0.5, 1.5, 0, 0),
        (3.3, -1.2, 0, 0), (-4, 2, 0.5, -0.2), (8, -4, -0.8, 0.4), (1, 1, 0.1, -0.2)]),
        ray((0.6, -0.175, 0.925), (4, -1.25, -2.75)))
    yield case


def stiff():
    case = Case("capsule-parallel-to-axis", "a ray parallel to the axis, inside and outside the body", numerics=[13])
    case.capsule("c", (0, -1, 0), (0, 1, 0), 1.0)
    case.insert("a", "c", (0, 0, 0))
    case.trace(ray((0.6, -5, 0), (0, 1, 0)), ray((0, -5, 0), (0, 1, 0), want=("a", 3.0)),
               ray((1.001, -5, 0), (0, 1, 0), want="miss"), ray((0.6, 0, 0), (0, -1, 0)),
               ray((0.6, -5, 0), (1e-9, 1, 0)), ray((0.6, -5, 0), (1e-18, 1, -1e-18)))
    yield case

    case = Case("capsule-long-and-thin", "a length of 1e6 radii cancels the body's quadratic", numerics=[2, 3])
    case.capsule("c", (-500, 0, 0), (500, 0, 0), 0.001)
    case.insert("a", "c", (0, 0, 0))
    case.trace(ray((0, 0, -10), (0, 0, 1)), ray((400, 0.0005, -10), (0, 0, 1)), ray((499.9, -0.0009, -10), (0, 0, 1)),
               ray((400, 0.0011, -10), (0, 0, 1), want="miss"), ray((-400, 4, 4), (1, -0.01, -0.01)),
               ray((-600, 0, 0), (1, 0, 0)), ray((-600, 0.0005, 0), (1, 0, 0)), ray((501, 0, 0.0002), (-1, 0, 0)))
    yield case

    case = Case("capsule-distance-1e6", "far away rays must be moved near the capsule first", numerics=[2])
    case.capsule("c", (0, 0, -1), (0, 0, 1), 0.5)
    case.insert("a", "c", (0, 0, 0))
    case.trace(*(ray((1e6, y, z), (-1, 0, 0)) for y, z in [(0, 0), (0.25, 0.5), (0.49, 0.9), (0.3, 1.2), (0, 1.49),
                                                           (0.51, 0), (0, 1.51), (0.4, -1.25)]),
               ray((1e8, 1e8, 0), (-1, -1, 1e-9)), ray((3e7, -4e7, 2e7), (-3, 4, -2)))
    yield case

    case = Case("capsule-posed", "scaled, turned and mirrored: the caps become ellipsoids", numerics=[40])
    case.capsule("c", (0, 0, -1), (0, 0, 1), 0.5)
    case.insert("a", "c", (0, 0, 0), linear=(2, 0, 0, 0, 1, 0.5, 0, -0.5, 1))
    case.insert("b", "c", (8, 0, 0), linear=(-1, 0, 0, 0, 3, 0, 0, 0, 0.25))
    case.trace(*(ray((x, y, -9), (dx, dy, 1)) for x, y, dx, dy in [
        (0, 0, 0, 0), (0.7, 0.25, 0, 0), (0.9, 0.5, 0, 0), (-0.5, -0.8, 0, 0), (1.2, 0, 0, 0), (8, 0, 0, 0),
        (8.2, 1.2, 0, 0), (7.6, -1.3, 0, 0), (8.6, 0, 0, 0), (4, 1, 0.4, -0.1), (-3, 3, 0.3, -0.3)]),
        ray((8, 0, 0), (0, 1, 0)), ray((0, 0, 0), (1, 2, 3)))
    yield case


def bad():
    case = Case("capsule-refused", "bad radii and ends are refused by name", numerics=[9, 10])
    case.capsule("c", (0, 0, -1), (0, 0, 1), 0.5)
    case.insert("a", "c", (0, 0, 0))
    case.trace(ray((-4, 0, 0), (1, 0, 0), want=("a", 3.5)), ray((-4, 1, 0), (1, 0, 0), want="miss"))
    ends = {"a": [0.0, 0.0, 0.0], "b": [0.0, 0.0, 1.0]}
    for radius in (0.0, -0.5, NAN, INF, 1e-101, 1.1e100):
        case.expect_error("RG_INVALID_VALUE", "radius", "capsule", shape="bad", radius=radius, **ends)
    case.expect_error("RG_INVALID_VALUE", "a", "capsule", shape="bad", radius=1.0, a=[0.0, NAN, 0.0], b=ends["b"])
    case.expect_error("RG_INVALID_VALUE", "b", "capsule", shape="bad", radius=1.0, a=ends["a"], b=[0.0, INF, 0.0])
    case.expect_error("RG_INVALID_VALUE", "b", "capsule", shape="bad", radius=1.0, a=ends["a"],
                      b=[-1.1e100, 0.0, 0.0])
    case.expect_scene(objects=1)
    yield case


def all_cases():
    for group in (plain, stiff, bad):
        yield from group()
