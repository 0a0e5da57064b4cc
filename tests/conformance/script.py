# SPDX-License-Identifier: MIT
"""
Writes the script of a case, and plays it at the same time on a model of the scene in exact arithmetic, which knows
what every ray must hit. The model is a list: it has no grid, and nothing in common with the library.
"""

import math
from dataclasses import dataclass, field
from fractions import Fraction

import emit
import geometry
from exact import add, dot, exact, f32, root, rounded, rounded_up, scale, sub, vector
from geometry import Box, Capsule, Mesh, Pose, Sphere

ALL_BITS = 0xFFFFFFFF
INF = math.inf
NAN = math.nan

KINDS = ["uniform", "hierarchical", "loose"]
# The paper's two with a small box that is never rebuilt, so that nearly everything lies in other tiles; and all
# rebuilt before each trace, so that the cells always fit (a grid of few objects may do without cells otherwise).
MORE = ["uniform-tiled", "hierarchical-tiled", "uniform-rebuilt", "hierarchical-rebuilt", "loose-rebuilt"]
# What means something, or the same, only where there is a box with cells.
OF_CELLS = {"levels", "levels_used", "resolution", "physical_lo", "physical_hi", "physical_contains", "entries",
            "unbounded", "tiles", "rebuilds"}

SHAPES = ("sphere", "box", "capsule", "mesh", "deform", "release")

NORMAL_WITHIN = Fraction(1, 2 ** 20)  # what a float normal is allowed when nothing else is said


@dataclass
class Ray:
    origin: tuple
    direction: tuple
    t_min: float = 0.0
    t_max: float = INF
    mask: int = ALL_BITS
    edge: bool = False  # the author vouches that the arithmetic of this ray is exact, though it touches a rim
    ties: str = "auto"  # lowest: exact ties go to the lowest id; any: any of them will do
    tight: bool = None  # 4 ulp; None: where t is a double
    want: object = None  # (object, t) as the author sees it, checked against the model; "miss"; "invalid"
    give: dict = field(default_factory=dict)  # fields of the expectation that the author adds or replaces
    drop: tuple = ()  # fields of the expectation left out

    def json(self):
        out = {"origin": emit.numbers(self.origin), "direction": emit.numbers(self.direction)}
        if self.t_min != 0:
            out["t_min"] = emit.number(self.t_min)
        if self.t_max != INF:
            out["t_max"] = emit.number(self.t_max)
        if self.mask != ALL_BITS:
            out["mask"] = self.mask
        return out

    def valid(self):
        numbers = list(self.origin) + list(self.direction)
        return (all(math.isfinite(x) for x in numbers) and max(map(abs, self.origin)) <= 1e100
                and any(self.direction) and self.t_min <= self.t_max)


def ray(origin, direction, **options):
    return Ray(tuple(map(float, origin)), tuple(map(float, direction)), **options)


@dataclass
class Placed:
    """An object of the model."""
    name: str
    id: int
    shape: object
    pose: Pose
    mask: int
    grid: str


@dataclass
class Found:
    """A possible hit of a ray."""
    t: Fraction
    placed: Placed
    crossing: object
    bound: Fraction  # documented error of t

    def order(self):
        return self.t, self.placed.id, self.crossing.primitive


class Ambiguous(Exception):
    """The author aimed at a place where the library may decide either way, without saying so."""


class Ids:
    """The ids that a fresh scene gives out: generation << 32 | slot; freed slots come back last in, first out."""

    def __init__(self):
        self.generation, self.free = [], []

    def take(self):
        if self.free:
            slot = self.free.pop()
            self.generation[slot] += 1
        else:
            slot = len(self.generation)
            self.generation.append(1)
        return self.generation[slot] << 32 | slot

    def give_back(self, id):
        self.free.append(id & ALL_BITS)


class Case:
    def __init__(self, name, note, numerics=(), flags=(), grids=None, grid=None):
        self.name, self.note = name, note
        self.numerics, self.flags, self.grids, self.grid = sorted(numerics), list(flags), grids, grid
        self.steps, self.shapes, self.objects, self.ids = [], {}, {}, Ids()
        self.changed = True  # since the last trace

    # ------------------------------------------------------------------------------------------------ shapes

    def step(self, do, **fields):
        made = {"do": do}
        made.update((k, v) for k, v in fields.items() if v is not None)
        self.steps.append(made)
        if not do.startswith("expect") and do not in SHAPES:
            self.changed = do != "trace"

    def sphere(self, name, radius):
        self.shapes[name] = Sphere(radius)
        self.step("sphere", shape=name, radius=emit.number(radius))

    def box(self, name, lo, hi):
        self.shapes[name] = Box(lo, hi)
        self.step("box", shape=name, lo=emit.numbers(lo), hi=emit.numbers(hi))

    def capsule(self, name, a, b, radius):
        self.shapes[name] = Capsule(a, b, radius)
        self.step("capsule", shape=name, a=emit.numbers(a), b=emit.numbers(b), radius=emit.number(radius))

    def mesh(self, name, vertices, triangles=None, vertex_type=None, index_type=None, apart=None, quality=None):
        given = triangles or [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(len(vertices) // 3)]
        self.shapes[name] = Mesh(vertices, given)
        self.step("mesh", shape=name, vertices=[emit.numbers(v) for v in vertices],
                  indices=[list(t) for t in triangles] if triangles else None,
                  vertex_type=vertex_type, index_type=index_type, apart=apart, quality=quality)

    def deform(self, name, old, vertices, vertex_type=None, apart=None, quality=None):
        """A mesh of the triangles of another one with new vertices."""
        triangles = self.shapes[old].triangles
        assert max(map(max, triangles)) < len(vertices)
        self.shapes[name] = Mesh(vertices, triangles)
        self.step("deform", shape=name, **{"from": old}, vertices=[emit.numbers(v) for v in vertices],
                  vertex_type=vertex_type, apart=apart, quality=quality)

    def release(self, name):
        self.step("release", shape=name)

    # ----------------------------------------------------------------------------------------------- objects

    def place(self, name, shape, position, linear, mask, grid):
        assert all(f32(x) == x for x in linear or ()), f"{self.name}: a linear part is float"
        placed = Placed(name, self.ids.take(), self.shapes[shape], Pose(position, linear), mask, grid)
        self.objects[name] = placed

    def insert(self, name, shape, position, linear=None, mask=None, grid=None):
        self.place(name, shape, position, linear, ALL_BITS if mask is None else mask, grid or "scene")
        self.step("insert", object=name, shape=shape, position=emit.numbers(position),
                  linear=emit.numbers(linear) if linear else None, mask=mask, grid=grid)

    def insert_many(self, name, shapes, positions, linears=None, masks=None, grid=None):
        """Objects name[0], name[1] ... `shapes`: one name for all, or one each."""
        for i, position in enumerate(positions):
            shape = shapes if isinstance(shapes, str) else shapes[i]
            self.place(f"{name}[{i}]", shape, position, linears[i] if linears else None,
                       masks[i] if masks else ALL_BITS, grid or "scene")
        one = isinstance(shapes, str)
        self.step("insert_many", objects=name, shape=shapes if one else None, shapes=None if one else shapes,
                  positions=[emit.numbers(p) for p in positions],
                  linears=[emit.numbers(m) for m in linears] if linears else None, masks=masks, grid=grid)

    def insert_line(self, name, shape, start, step, count, consider=None, grid=None):
        """
        `count` objects at start + i * step. `consider`: the numbers of those that the model keeps; the author has to
        see that no ray meets another one first.
        """
        kept = range(count) if consider is None else sorted(set(consider))
        for i in range(count):
            id = self.ids.take()
            if i in kept:
                position = [rounded(exact(a) + i * exact(b)) for a, b in zip(start, step)]
                self.objects[f"{name}[{i}]"] = Placed(f"{name}[{i}]", id, self.shapes[shape], Pose(position),
                                                      ALL_BITS, grid or "scene")
        self.step("insert_line", objects=name, shape=shape, start=emit.numbers(start), step=emit.numbers(step),
                  count=count, grid=grid)

    def move(self, name, position, linear=None):
        self.repose(name, Pose(position, linear))
        self.step("move", object=name, position=emit.numbers(position),
                  linear=emit.numbers(linear) if linear else None)

    def move_to(self, name, position):
        self.reposition(name, position)
        self.step("move_to", object=name, position=emit.numbers(position))

    def move_many(self, names, positions, linears=None):
        for i, name in enumerate(names):
            if linears:
                self.repose(name, Pose(positions[i], linears[i]))
            else:
                self.reposition(name, positions[i])
        self.step("move_many", objects=names, positions=[emit.numbers(p) for p in positions],
                  linears=[emit.numbers(m) for m in linears] if linears else None)

    def repose(self, name, pose):
        self.objects[name].pose = pose

    def reposition(self, name, position):
        self.repose(name, Pose(position, [rounded(x) for x in self.objects[name].pose.linear]))

    def replace_shape(self, old, new):
        """All objects of one shape get another one; their poses stay."""
        for name, placed in self.objects.items():
            if placed.shape is self.shapes[old]:
                placed.shape = self.shapes[new]
                self.reposition(name, [rounded(x) for x in placed.pose.position])
        self.step("replace_shape", **{"from": old, "to": new})

    def set_mask(self, name, mask):
        self.objects[name].mask = mask
        self.step("set_mask", object=name, mask=mask)

    def remove(self, name):
        self.ids.give_back(self.objects.pop(name).id)
        self.step("remove", object=name)

    def remove_many(self, names):
        for name in names:
            self.ids.give_back(self.objects.pop(name).id)
        self.step("remove_many", objects=names)

    # ------------------------------------------------------------------------------------------------- grids

    def create_grid(self, grid, **config):
        self.step("create_grid", grid=grid, config=grid_config(**config))

    def configure_grid(self, grid, **config):
        self.step("configure_grid", grid=grid, config=grid_config(**config))

    def rebuild_grid(self, grid="scene"):
        self.step("rebuild_grid", grid=grid)

    def destroy_grid(self, grid):
        self.step("destroy_grid", grid=grid)

    # ------------------------------------------------------------------------------------------- expectations

    def expect_error(self, result, message, do, **call):
        """`call` as in the JSON; numbers may be doubles."""
        assert not self.changed, f"{self.name}: trace before expecting an error: nothing to compare the scene with"
        made = {"do": do}
        made.update((k, plain(v)) for k, v in call.items() if v is not None)
        self.step("expect_error", result=result, message=message, call=made)

    def expect_grid(self, grid="scene", on=None, loose=None, **fields):
        """
        `on`: the set-ups for which it holds; not given: all, but what is said of cells only those of the paper's
        kinds. `loose`: what else holds for the loose kind. Where the set-up rebuilds of its own, rebuilds can't be
        counted.
        """
        runs = self.setups()
        if grid == "scene" and "rebuilds" in fields and self.grid is None:
            runs = [s for s in runs if s in KINDS]
        lattice = [s for s in runs if s.startswith("loose")] if grid == "scene" and not on else []
        if lattice and (loose or OF_CELLS & fields.keys()):
            rest = {k: v for k, v in fields.items() if k not in OF_CELLS} | (loose or {})
            if rest:
                self.step("expect_grid", grid=grid, on=lattice, **{k: plain(v) for k, v in rest.items()})
            on = [s for s in runs if s not in lattice]
        elif not on and runs != self.setups():
            on = runs
        self.step("expect_grid", grid=grid, on=on, **{k: plain(v) for k, v in fields.items()})

    def expect_object(self, name, **fields):
        self.step("expect_object", object=name, **{k: plain(v) for k, v in fields.items()})

    def expect_scene(self, **fields):
        self.step("expect_scene", **fields)

    def trace(self, *rays, cull=None, respawn=None):
        out = []
        for r in rays:
            line = r.json()
            try:
                line["hit"] = self.expected(r, cull)
            except Ambiguous as problem:
                raise Ambiguous(f"{self.name}: ray {r.origin} {r.direction}: {problem}") from None
            out.append(line)
        self.step("trace", cull=cull, rays=out, respawn=[emit.numbers(d) for d in respawn] if respawn else None)

    # ------------------------------------------------------------------------------------------ what is hit

    def expected(self, r, cull):
        if not r.valid():
            assert r.want in (None, "invalid"), (self.name, r)
            return "invalid"
        hits = self.hits(r, cull)
        if not hits:
            assert r.want in (None, "miss"), (self.name, r, "is a miss")
            return dict(object=None, **r.give) if r.give else None
        best = min(hits, key=Found.order)
        near = [h for h in hits if h.t - best.t <= best.bound + h.bound]
        same = [h for h in near if h.t == best.t]
        simple = exact_double(best.t) or all(h.placed.shape is best.placed.shape and same_pose(h, best) for h in same)
        lowest = r.ties == "lowest" or (r.ties == "auto" and simple)
        accepted = [best] + [h for h in near if h is not best and not (lowest and h.t == best.t)]
        if isinstance(r.want, tuple):
            name, t = r.want
            assert name == best.placed.name and (t is None or rounded(best.t) == t), (self.name, r, best)
        else:
            assert r.want is None, (self.name, r, best)
        return self.expectation(r, best, accepted)

    def hits(self, r, cull):
        o, d = vector(r.origin), vector(r.direction)
        length = root(dot(d, d))
        along = [float(x / length) for x in d]
        found = []
        for placed in self.objects.values():
            if not placed.mask & r.mask or geometry.off_object(placed.shape, placed.pose, r.origin, along):
                continue
            lo, ld = placed.pose.local(o, d)
            here = crossings(placed.shape, lo, ld, r, cull)
            if not r.edge:
                clear_of_silhouette(placed, lo, ld, r, cull, bool(here))
            found += [Found(c.t, placed, c, documented_error(placed, c, o, d, r)) for c in here]
        if not r.edge:
            for h in found:
                for end in (r.t_min, r.t_max):
                    if abs(end) != INF and h.t != exact(end) and abs(h.t - exact(end)) <= h.bound:
                        raise Ambiguous("a hit too near an end of the range")
        return found

    def expectation(self, r, best, accepted):
        names = unique(h.placed.name for h in accepted)
        primitives = unique(h.crossing.primitive for h in accepted)
        out = {"object": names[0] if len(names) == 1 else names, "t": emit.number(rounded(best.t))}
        tight = r.tight if r.tight is not None else exact_double(best.t)
        bound = exact(0.0) if tight else best.bound
        spread = max(h.t for h in accepted) - best.t
        if bound + spread > 0:
            out["within"] = emit.number(rounded_up(bound + spread))
        if primitives != [0] or best.placed.shape.kind in ("box", "mesh"):
            out["primitive"] = primitives[0] if len(primitives) == 1 else primitives
        normals = unique(unit(h.placed.pose.world_normal(h.crossing.normal)) for h in accepted)
        if len(normals) == 1:
            out["normal"] = emit.numbers(normals[0])
            within = NORMAL_WITHIN + normal_error(best, r)
            if within > 2 * NORMAL_WITHIN:
                out["normal_within"] = emit.number(rounded_up(within))
        if best.placed.shape.kind == "mesh" and len(accepted) == 1:
            out["u"], out["v"] = emit.number(rounded(best.crossing.u)), emit.number(rounded(best.crossing.v))
        position = add(vector(r.origin), scale(vector(r.direction), best.t))
        if tight and all(map(exact_double, position)):
            out["position"] = emit.numbers(map(rounded, position))
        out.update((k, plain(v)) for k, v in r.give.items())
        for name in r.drop:
            out.pop(name, None)
        return out

    def setups(self):
        if self.grids is None and self.grid is None and "costly" not in self.flags:
            return KINDS + MORE
        return self.grids or KINDS

    def json(self):
        out = {"name": self.name, "note": self.note, "numerics": self.numerics, "flags": self.flags,
               "grids": self.setups()}
        if self.grid is not None:
            out["grid"] = grid_config(**self.grid)
        out["steps"] = self.steps
        return out


def grid_config(kind=None, resolution=None, lo=None, hi=None, rebuild_factor=None):
    out = {"kind": kind, "resolution": resolution, "lo": lo and emit.numbers(lo), "hi": hi and emit.numbers(hi),
           "rebuild_factor": rebuild_factor if rebuild_factor in ("never", None) else emit.number(rebuild_factor)}
    return {k: v for k, v in out.items() if v is not None}


def plain(value):
    """A value as JSON: doubles as numbers of the format, through lists and objects."""
    if isinstance(value, float):
        return emit.number(value)
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, dict):
        return {k: plain(v) for k, v in value.items()}
    return value


def unique(values):
    return list(dict.fromkeys(values))


def exact_double(q):
    return exact(rounded(q)) == q


def same_pose(a, b):
    return (a.placed.pose.position, a.placed.pose.linear) == (b.placed.pose.position, b.placed.pose.linear)


def unit(n):
    """A normal of length 1, rounded to double."""
    length = root(dot(n, n))
    return tuple(rounded(x / length) + 0.0 for x in n)


def crossings(shape, o, d, r, cull):
    """The crossings of a local ray that count."""
    def counts(c):
        facing = dot(c.normal, d)
        return r.t_min <= c.t <= r.t_max and not (cull == "back" and facing >= 0 or cull == "front" and facing <= 0)
    return [c for c in shape.crossings(o, d) if counts(c)]


def clear_of_silhouette(placed, o, d, r, cull, hit):
    """A little more or less of the object must not change whether it is hit."""
    lo, hi = placed.shape.bounds()
    sizes = [abs(x) for x in tuple(lo) + tuple(hi) if abs(x) != INF]
    by = max(sizes, default=exact(0.0)) * geometry.SILHOUETTE * placed.pose.condition()
    if placed.shape.kind == "mesh":
        return
    for sign in (1, -1):
        if bool(crossings(placed.shape.grown(sign * by), o, d, r, cull)) != hit:
            raise Ambiguous(f"too near the silhouette of {placed.name}")


def documented_error(placed, c, o, d, r):
    """The bound of raygrid/trace.h for the error of t, in units of t."""
    length = root(dot(d, d))
    away = sub(o, placed.pose.position)
    normal = placed.pose.world_normal(c.normal)
    cosine = abs(dot(normal, d)) / (root(dot(normal, normal)) * length)
    radius = geometry.radius_around_position(placed.shape, placed.pose)
    if cosine == 0:
        return exact(0.0)  # an exact tangent: the author vouches
    world = root(dot(away, away)) / 2 ** 50 + placed.pose.condition() * radius / cosine / 2 ** 40
    return world / length


def normal_error(h, r):
    """How far a curved surface's normal turns within the documented error of t."""
    radius = h.placed.shape.curvature_radius()
    if radius is None:
        return exact(0.0)
    d = vector(r.direction)
    inverse = sum(x * x for x in h.placed.pose.inverse)
    return h.bound * root(dot(d, d)) * root(inverse) * h.placed.pose.condition() / radius


__all__ = ["Case", "ray", "INF", "NAN", "KINDS", "ALL_BITS"]
