# SPDX-License-Identifier: MIT
"""Where a line meets the surfaces of shapes, in exact arithmetic."""

from collections import namedtuple
from fractions import Fraction

from exact import (IDENTITY, add, cross, dot, exact, inverse, root, scale, sub, times, transposed, vector)

# A place where a line meets a surface: parameter, primitive, local outward normal (of any length), barycentrics.
Crossing = namedtuple("Crossing", "t primitive normal u v")

# The share of an object's radius within which the library may decide either way (raygrid/trace.h).
SILHOUETTE = Fraction(1, 2 ** 40)


def quadratic(a, b, c):
    """The real roots of a t^2 + 2 b t + c, rising; one if they are equal."""
    discriminant = b * b - a * c
    if a == 0 or discriminant < 0:
        return []
    if discriminant == 0:
        return [-b / a]
    r = root(discriminant)
    return sorted([(-b - r) / a, (-b + r) / a])


class Sphere:
    kind = "sphere"

    def __init__(self, radius):
        self.radius = exact(radius)

    def crossings(self, o, d):
        for t in quadratic(dot(d, d), dot(o, d), dot(o, o) - self.radius ** 2):
            yield Crossing(t, 0, add(o, scale(d, t)), 0, 0)

    def grown(self, by):
        return Sphere.of(self.radius + by)

    @classmethod
    def of(cls, radius):
        shape = cls(0.0)
        shape.radius = radius
        return shape

    def bounds(self):
        return (-self.radius,) * 3, (self.radius,) * 3

    def curvature_radius(self):
        return self.radius


class Box:
    kind = "box"

    def __init__(self, lo, hi):
        self.lo, self.hi = tuple(map(self.end, lo)), tuple(map(self.end, hi))

    @staticmethod
    def end(x):
        return x if abs(x) == float("inf") else exact(x)

    def crossings(self, o, d):
        """
        The faces' crossings. A line that runs within the plane of a face meets it first and last on its rim, which is
        on other faces too and found there. Where a line enters and leaves at once, only the faces that it enters by.
        """
        found = []
        for axis in range(3):
            for side, plane in enumerate((self.lo[axis], self.hi[axis])):
                if d[axis] == 0 or abs(plane) == float("inf"):
                    continue
                t = (plane - o[axis]) / d[axis]
                p = list(add(o, scale(d, t)))
                p[axis] = plane
                if all(self.lo[i] <= p[i] <= self.hi[i] for i in range(3)):
                    normal = [exact(0.0)] * 3
                    normal[axis] = exact(1.0 if side else -1.0)
                    found.append(Crossing(t, 2 * axis + side, tuple(normal), 0, 0))
        entered = {c.t for c in found if dot(c.normal, d) < 0}
        return [c for c in found if dot(c.normal, d) < 0 or c.t not in entered]

    def grown(self, by):
        box = Box((0.0,) * 3, (0.0,) * 3)
        box.lo, box.hi = tuple(x - by for x in self.lo), tuple(x + by for x in self.hi)
        return box

    def bounds(self):
        return self.lo, self.hi

    def curvature_radius(self):
        return None


class Capsule:
    kind = "capsule"

    def __init__(self, a, b, radius):
        self.a, self.b, self.radius = vector(a), vector(b), exact(radius)

    def crossings(self, o, d):
        w = sub(self.b, self.a)
        ww = dot(w, w)
        for end in (self.a, self.b):
            m = sub(o, end)
            for t in quadratic(dot(d, d), dot(m, d), dot(m, m) - self.radius ** 2):
                s = dot(sub(add(o, scale(d, t)), self.a), w)
                if s <= 0 if end is self.a else s >= ww:
                    yield Crossing(t, 0, sub(add(o, scale(d, t)), end), 0, 0)
        m = sub(o, self.a)
        a = dot(d, d) * ww - dot(d, w) ** 2
        b = dot(m, d) * ww - dot(m, w) * dot(d, w)
        c = (dot(m, m) - self.radius ** 2) * ww - dot(m, w) ** 2
        for t in quadratic(a, b, c):
            p = add(o, scale(d, t))
            s = dot(sub(p, self.a), w)
            if 0 < s < ww:
                yield Crossing(t, 0, sub(p, add(self.a, scale(w, s / ww))), 0, 0)

    def grown(self, by):
        capsule = Capsule((0.0,) * 3, (0.0,) * 3, 0.0)
        capsule.a, capsule.b, capsule.radius = self.a, self.b, self.radius + by
        return capsule

    def bounds(self):
        return (tuple(min(x) - self.radius for x in zip(self.a, self.b)),
                tuple(max(x) + self.radius for x in zip(self.a, self.b)))

    def curvature_radius(self):
        return self.radius


class Mesh:
    kind = "mesh"

    def __init__(self, vertices, triangles):
        self.vertices = [vector(v) for v in vertices]
        self.triangles = [tuple(t) for t in triangles]
        self.faces = [self.face(*t) for t in self.triangles]
        self.ends = tuple(map(min, zip(*self.vertices))), tuple(map(max, zip(*self.vertices)))

    def face(self, i, j, k):
        """A corner, the edges from it, their cross product; in doubles the middle, and the squared reach from it."""
        a, b, c = self.vertices[i], self.vertices[j], self.vertices[k]
        e, f = sub(b, a), sub(c, a)
        middle = [float(x) for x in scale(add(a, add(b, c)), exact(1.0) / 3)]
        reach = max(sum((float(x) - m) ** 2 for x, m in zip(p, middle)) for p in (a, b, c))
        return a, e, f, cross(e, f), middle, reach

    def crossings(self, o, d):
        length = root(dot(d, d))
        start, along = [float(x) for x in o], [float(x / length) for x in d]
        for primitive, (a, e, f, normal, middle, reach) in enumerate(self.faces):
            if clearly_off(start, along, middle, reach):
                continue
            facing = dot(normal, d)
            if facing == 0:
                continue
            t = dot(normal, sub(a, o)) / facing
            p = sub(add(o, scale(d, t)), a)
            area = dot(normal, normal)
            u, v = dot(cross(p, f), normal) / area, dot(cross(e, p), normal) / area
            if u >= 0 and v >= 0 and u + v <= 1:
                yield Crossing(t, primitive, normal, u, v)

    def grown(self, by):
        return self  # its rims are not silhouettes of a solid; the authors of mesh cases keep away from open rims

    def bounds(self):
        return self.ends

    def curvature_radius(self):
        return None


def clearly_off(start, along, middle, reach):
    """
    Whether a line passes a middle by more than the reach around it (squared),
    in doubles and so with a margin of a fifth
    of the reach and 2^-20 of the way, far above their error: saves exact arithmetic, decides nothing.
    """
    m = [x - y for x, y in zip(middle, start)]
    way = m[0] * along[0] + m[1] * along[1] + m[2] * along[2]
    off = sum((x - way * y) ** 2 for x, y in zip(m, along))
    return off > 1.5 * reach + (way * way + off) * 2.0 ** -40


class Pose:
    """world = position + linear * local"""

    def __init__(self, position, linear=None):
        self.position = vector(position)
        self.linear = vector(linear) if linear is not None else IDENTITY
        self.plain = self.linear == IDENTITY
        self.inverse = IDENTITY if self.plain else inverse(self.linear)

    def local(self, o, d):
        m = sub(o, self.position)
        return (m, d) if self.plain else (times(self.inverse, m), times(self.inverse, d))

    def world_normal(self, n):
        return n if self.plain else times(transposed(self.inverse), n)

    def condition(self):
        """An upper bound of the condition number of the linear part, by Frobenius norms."""
        if self.plain:
            return exact(1.0)
        return root(dot_all(self.linear) * dot_all(self.inverse))


def off_object(shape, pose, start, along):
    """Whether the line from `start` along `along` (doubles, length 1) is clearly off an object."""
    if not all(abs(x) < 1e100 for x in shape.bounds()[0] + shape.bounds()[1]):
        return False
    if not hasattr(pose, "reach"):
        pose.reach = float(radius_around_position(shape, pose)) ** 2
        pose.middle = [float(x) for x in pose.position]
    return clearly_off(start, along, pose.middle, pose.reach)


def dot_all(m):
    return sum(x * x for x in m)


def radius_around_position(shape, pose):
    """An upper bound of the distance of the object's points from its position; infinite sides count as 0."""
    lo, hi = shape.bounds()
    corners = [[x if abs(x) != float("inf") else exact(0.0) for x in pair] for pair in zip(lo, hi)]
    if shape.kind == "sphere" and pose.plain:
        return shape.radius
    far = exact(0.0)
    for x in corners[0]:
        for y in corners[1]:
            for z in corners[2]:
                p = times(pose.linear, (x, y, z))
                far = max(far, dot(p, p))
    return root(far)
