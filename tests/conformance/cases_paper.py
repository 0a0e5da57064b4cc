# SPDX-License-Identifier: MIT
"""
The mechanisms of Reinhard, Smits and Hansen (2000): tiles and their marks, the logical box, rebuilds,
levels. What can't
be seen in hits shows in the numbers of cells and tests of a ray.
"""

from cases_grid import unit_cells
from script import Case, ray

UNIFORM, HIERARCHICAL = ["uniform"], ["hierarchical"]
BOTH = UNIFORM + HIERARCHICAL  # where cells are counted


def off_axis(axis, x, y=0.5, z=0.5):
    """The point (x, y, z) with its axes turned so that x lies on `axis`."""
    place = [z] * 3
    place[axis], place[(axis + 1) % 3] = x, y
    return place


def tiles():
    for axis in range(3):
        case = Case(f"tile-mark-{'xyz'[axis]}", "an object of another tile in the same cell is not tested",
                    grids=BOTH, grid=unit_cells(8))
        case.sphere("s", 0.25)
        along = off_axis(axis, 0, 1, 0)
        # The ends make the logical box and the tiles; the cell of interest is 4 along the axis.
        for name, x in (("low", -19.5), ("home", 0.5), ("high", 28.5)):
            case.insert(name, "s", off_axis(axis, x))
        case.insert("other", "s", off_axis(axis, 4.5 + 16))
        case.insert("negative", "s", off_axis(axis, 4.5 - 16))

        def across(x, **options):
            return ray(off_axis(axis, x, -3.0), along, **options)
        case.trace(across(4.5, give={"tests": 0}), across(4.5 - 8, give={"tests": 0}),
                   across(4.5 + 8, give={"tests": 0}),
                   across(4.5 + 16, want=("other", 3.25), give={"tests": 1}),
                   across(4.5 - 16, want=("negative", 3.25), give={"tests": 1}),
                   across(0.5, want=("home", 3.25), give={"tests": 1}))
        yield case

    case = Case("tile-mark-aliases", "a mark of two bits makes all outside tiles one: a ray tests its own tile's",
                grids=BOTH, grid=unit_cells(8))
    case.sphere("s", 0.25)
    numbers = list(range(-6, 7))
    case.insert_many("a", "s", [(8.0 * k + 0.5, 0.5, 0.5) for k in numbers])
    case.trace(*(ray((8.0 * k + 0.5, 5, 0.5), (0, -1, 0), want=(f"a[{i}]", 4.25), give={"tests": 1})
                 for i, k in enumerate(numbers)))
    case.expect_grid(tiles=13, entries=13, objects=13)
    yield case

    case = Case("tile-wrap-each-side", "an object that leaves by any side of the box is found there, and only there",
                grid=unit_cells(8))
    case.sphere("s", 0.5)
    case.insert("a", "s", (4.5, 3.5, 2.5))
    for step in [(8, 0, 0), (-8, 0, 0), (0, 8, 0), (0, -8, 0), (0, 0, 8), (0, 0, -8), (8, -8, 16), (-24, 8, 0)]:
        place = [x + d for x, d in zip((4.5, 3.5, 2.5), step)]
        case.move_to("a", place)
        case.trace(ray((place[0], place[1], place[2] - 3), (0, 0, 1), want=("a", 2.5)),
                   ray((place[0] - 3, place[1], place[2]), (1, 0, 0), want=("a", 2.5)),
                   ray((4.5, 3.5, 2.5), (-1, -1, -1), t_max=2.0), ray((4.5, 0, 2.5), (0, 1, 0), t_max=6.0),
                   ray((0, 3.5, 2.5), (1, 0, 0), t_max=7.0))
    yield case

    case = Case("tile-wall-spanned", "an object across a wall of tiles is in both, one across an edge in four",
                grid=unit_cells(8))
    case.sphere("s", 0.4)
    places = {"wall-x": (8, 3.5, 3.5), "wall-y": (3.5, 0, 3.5), "edge": (-8, -8, 4.5), "corner": (16, 16, 16)}
    for name, place in places.items():
        case.insert(name, "s", place)
    case.expect_grid(objects=4, entries={"min": 2 + 2 + 4 + 8, "max": 8 * 4})
    rays = []
    for place in places.values():
        for axis in range(3):
            for sign in (1.0, -1.0):
                for aside in (0.125, -0.125):
                    origin, direction = list(place), [0.0] * 3
                    origin[axis] -= 3 * sign
                    origin[(axis + 1) % 3] += aside
                    origin[(axis + 2) % 3] += aside
                    direction[axis] = sign
                    rays.append(ray(origin, direction, t_max=6.0))
    case.trace(*rays)
    yield case

    case = Case("tile-walls-exact", "boxes that begin and end exactly on walls of tiles, from both sides, negative "
                "tiles too: (int)x - 1 is wrong for whole numbers", grid=unit_cells(8))
    case.box("unit", (0, 0, 0), (1, 1, 1))
    case.sphere("s", 0.5)
    corners = [-24, -16, -9, -8, -1, 0, 7, 8, 15, 16]
    case.insert_many("b", "unit", [(x, 0, 0) for x in corners])
    case.insert_many("s", "s", [(x + 0.5, 4.5, 4.5) for x in corners])
    case.trace(*(ray((x + 0.25, 0.25, 5), (0.0, 0.0, -1)) for x in corners),
               *(ray((x - 0.5, 0.5, 0.5), (1, 0, 0)) for x in corners),
               *(ray((x + 1.5, 0.5, 0.5), (-1, 0, 0)) for x in corners),
               *(ray((x, 4.5, 4.5), (1, 0, 0), t_max=3.0, edge=True, ties="any",
                     drop=("normal",)) for x in corners[:1]),
               *(ray((x + 0.5, 4.5, 9), (0, 0, -1)) for x in corners),
               *(ray((x - 0.125, 4.5, 4.5), (1, 0, 0), t_max=0.5) for x in (-24, -16, 0)))
    yield case

    case = Case("tile-many-away", "hundreds of tiles between two objects: nothing repeats, nothing is lost",
                grid=unit_cells(4))
    case.sphere("s", 0.75)
    case.insert("home", "s", (2, 2, 2))
    case.insert("away", "s", (3002, -1502, 2))
    case.trace(ray((2, 2, -3), (0, 0, 1), want=("home", 4.25)),
               ray((3002, -1502, -3), (0, 0, 1), want=("away", 4.25)),
               ray((2, 2, 2), (3000, -1504, 0), t_min=0.125, want=("away", None)), ray((2, -1502, 2), (1, 0, 0)),
               ray((3002, 9, 2), (0, -1, 0)), ray((4000, -1502, 2), (-1, 0, 0)),
               ray((1502, -750, 2), (-3000, 1504, 0)))
    case.expect_grid(tiles={"min": 2, "max": 8}, logical_contains=[[1.25, 2.75, 2.75], [3002.75, -1502.75, 1.25]])
    yield case


def logical():
    case = Case("logical-box-grows", "the logical box grows at once when an object leaves it, by insert and by move",
                grid=unit_cells(8))
    case.sphere("s", 0.5)
    case.insert("a", "s", (1, 1, 1))
    case.expect_grid(logical_contains=[[0.5, 0.5, 0.5], [1.5, 1.5, 1.5]], rebuilds=0)
    case.insert("b", "s", (20, -7, 3))
    case.expect_grid(logical_contains=[[0.5, 0.5, 0.5], [20.5, -7.5, 3.5]], rebuilds=0)
    case.trace(ray((20, -7, 0), (0, 0, 1), want=("b", 2.5)), ray((20, -7, 9), (0, 0, -1), want=("b", 5.5)))
    case.move_to("a", (-30, 1, 50))
    case.expect_grid(logical_contains=[[-30.5, 0.5, 49.5], [20.5, -7.5, 3.5]])
    case.trace(ray((-30, 1, 0), (0, 0, 1), want=("a", 49.5)), ray((100, 1, 50), (-1, 0, 0), want=("a", 129.5)))
    case.move_many(["a", "b"], [(1, 77, 1), (1, 1, -88)])
    case.expect_grid(logical_contains=[[1.5, 77.5, 1.5], [1.5, 0.5, -88.5]])
    case.trace(ray((1, 1, 0), (0, 0, -1), want=("b", 87.5)), ray((1, 0, 1), (0, 1, 0), want=("a", 76.5)))
    yield case

    case = Case("logical-box-ends-walk", "a ray ends where it leaves the logical box, though cells go on",
                grids=BOTH, grid=unit_cells(64))
    case.sphere("s", 0.25)
    case.insert_many("a", "s", [(1.5, 1.5, 1.5), (3.5, 3.5, 3.5)])
    case.trace(ray((2.5, 2.5, 2.5), (1, 0, 0), want="miss", give={"cells_max": 3}),
               ray((60.5, 2.5, 2.5), (-1, 0, 0), want="miss", give={"cells_max": 5}),
               ray((30, 30, 30), (1, 0, 0), want="miss", give={"cells_max": 0}),
               ray((30, 30, 30), (1, 1, 1), want="miss", give={"cells_max": 0}),
               ray((2.5, 9, 2.5), (0, 1, 0), want="miss", give={"cells_max": 0}),
               ray((1.5, 1.5, -5), (0, 0, 1), want=("a[0]", 6.25), give={"cells_max": 2}))
    yield case

    case = Case("walk-ends-at-t-max", "a ray looks into no cell beyond t_max", grids=BOTH, grid=unit_cells(64))
    case.sphere("s", 0.25)
    case.insert_many("a", "s", [(0.5, 0.5, 0.5), (63.5, 63.5, 63.5), (60.5, 2.5, 2.5)])
    case.trace(ray((2.5, 2.5, 2.5), (1, 0, 0), t_max=2.0, want="miss", give={"cells_max": 4, "tests": 0}),
               ray((2.5, 2.5, 2.5), (1, 0, 0), t_min=40.0, t_max=42.0, want="miss",
                   give={"cells_max": 6, "tests": 0}),
               ray((2.5, 2.5, 2.5), (1, 0, 0), t_min=55.0, want=("a[2]", 57.75), give={"cells_max": 8, "tests": 1}))
    yield case

    case = Case("walk-stops-early", "a ray stops at the first cell with a hit nearer than the next cell",
                grids=BOTH, grid=unit_cells(64))
    case.sphere("s", 0.25)
    case.insert_many("a", "s", [(2.5, 2.5, 2.5)] + [(10.5 + i, 2.5, 2.5) for i in range(50)] + [(0.5, 0.5, 0.5)])
    case.trace(ray((0.5, 2.5, 2.5), (1, 0, 0), want=("a[0]", 1.75), give={"cells_max": 4, "tests": 1}),
               ray((12.0, 2.5, 2.5), (1, 0, 0), want=("a[3]", 0.25), give={"cells_max": 3, "tests": 1}),
               ray((63.5, 2.5, 2.5), (-1, 0, 0), give={"cells_max": 8, "tests": 1}))
    yield case

    case = Case("hit-beyond-cell-kept", "a hit in a cell further on than the present one is kept, not stopped at",
                grid=unit_cells(64))
    case.capsule("long", (1.5, 0.5, 0.5), (9.5, 6.5, 0.5), 0.25)
    case.sphere("s", 0.25)
    case.insert("slanted", "long", (0, 0, 0))
    case.insert_many("a", "s", [(6.5, 2.5, 0.5), (3.5, 5.5, 0.5), (8.5, 4.5, 0.5)])
    case.trace(*(ray((0.1, y, 0.5), (1, 0.02, 0)) for y in (0.5, 1.5, 2.5, 3.5, 4.3, 5.5, 6.4)),
               *(ray((x, 9.5, 0.5), (0.02, -1, 0)) for x in (1.5, 3.6, 5.5, 6.5, 8.4, 9.2)))
    yield case


def rebuilds():
    inner, diagonal = (1.0, 1.0, 1.0), 8.0
    for name, factor, stays, goes in (("2", None, 15.0, 20.0), ("3", 3, 22.0, 27.0), ("1", 1, 7.5, 12.0)):
        case = Case(f"rebuild-at-factor-{name}", "rebuilt when the logical diagonal exceeds the physical one by the "
                    "factor, not before", grid=unit_cells(8, rebuild_factor=factor))
        assert stays < diagonal * (factor or 2) < goes - 2
        case.sphere("s", 0.25)
        case.insert("a", "s", inner)
        case.insert("b", "s", (2.0, 2.0, 3.0))
        case.expect_grid(rebuilds=0, physical_lo=[0.0, 0.0, 0.0], physical_hi=[8.0, 8.0, 8.0])
        case.move_to("b", (stays,) * 3)
        case.expect_grid(rebuilds=0, physical_hi=[8.0, 8.0, 8.0])
        look = [ray((x, x, -3), (0, 0, 1)) for x in (1.0, stays, goes)]
        case.trace(*look)
        case.move_to("b", (goes,) * 3)
        case.expect_grid(rebuilds=1, tiles=1, physical_contains=[[0.75] * 3, [goes + 0.25] * 3], objects=2)
        case.trace(*look)
        yield case

    case = Case("rebuild-by-insert", "an insert may make the logical box too large; many at once rebuild once",
                grid=unit_cells(8, rebuild_factor=None))
    case.sphere("s", 0.25)
    case.insert("a", "s", inner)
    case.insert("b", "s", (40, 1, 1))
    case.expect_grid(rebuilds=1, physical_contains=[[0.75, 0.75, 0.75], [40.25, 1.25, 1.25]], tiles=1)
    case.insert_many("m", "s", [(-50.0 * i, 7, 3.0 * i) for i in range(10)])
    case.expect_grid(rebuilds=2, physical_contains=[[-450.25, 0.75, 0.75], [40.25, 7.25, 27.25]], tiles=1)
    case.trace(ray((40, 1, -4), (0, 0, 1), want=("b", 4.75)),
               *(ray((-50.0 * i, 0, 3.0 * i), (0, 1, 0)) for i in range(10)),
               ray((-500, 7, 27), (1, 0, 0), want=("m[9]", 49.75)))
    yield case

    case = Case("rebuild-never", "with RG_REBUILD_NEVER the box stays, however far objects go", grid=unit_cells(8))
    case.sphere("s", 0.25)
    case.insert("a", "s", inner)
    for i in range(1, 13):
        place = (1 + 37.0 * i, 2 - 11.0 * i, 3.0)
        case.move_to("a", place)
        case.trace(ray((place[0], place[1], -4), (0, 0, 1), want=("a", 6.75)))
    case.expect_grid(rebuilds=0, physical_lo=[0.0, 0.0, 0.0], physical_hi=[8.0, 8.0, 8.0])
    case.insert_many("m", "s", [(3.0 * i, 3.0, 3.0) for i in range(200)])
    case.expect_grid(rebuilds=0, physical_lo=[0.0, 0.0, 0.0], physical_hi=[8.0, 8.0, 8.0], objects=201)
    case.trace(*(ray((3.0 * i, 3, -5), (0, 0, 1)) for i in range(0, 200, 17)))
    yield case

    case = Case("rebuild-now", "rg_grid_rebuild fits the box at once, whatever the factor", grid=unit_cells(8))
    case.sphere("s", 0.25)
    case.insert("a", "s", inner)
    case.insert("b", "s", (100, 50, -25))
    rays = [ray((1, 1, -3), (0, 0, 1), want=("a", 3.75)), ray((100, 50, -30), (0, 0, 1), want=("b", 4.75)),
            ray((1, 1, 1), (99, 49, -26), t_min=0.125), ray((50, 50, -25), (1, 0, 0), want=("b", 49.75))]
    case.trace(*rays)
    case.rebuild_grid()
    case.expect_grid(rebuilds=1, tiles=1, physical_contains=[[0.75, 0.75, -25.25], [100.25, 50.25, 1.25]])
    case.trace(*rays)
    case.rebuild_grid()
    case.expect_grid(rebuilds=2)
    case.remove("b")
    case.rebuild_grid()
    case.expect_grid(rebuilds=3, objects=1, tiles=1, physical_contains=[[0.75] * 3, [1.25] * 3])
    case.trace(rays[0], ray((50, 50, -25), (1, 0, 0), want="miss"))
    case.remove("a")
    case.rebuild_grid()
    case.trace(ray((1, 1, -3), (0, 0, 1), want="miss"))
    yield case

    case = Case("rebuild-keeps-resolution", "a rebuild takes the configured number of cells over the new box",
                grid=dict(resolution=16, lo=(0.0,) * 3, hi=(16.0, 8.0, 4.0), rebuild_factor=None))
    case.sphere("s", 0.25)
    case.expect_grid(resolution=[16, 8, 4])
    case.insert_many("a", "s", [(0, 0, 0), (128, 128, 128)])
    case.expect_grid(resolution=[16, 16, 16], rebuilds=1, tiles=1)
    case.trace(ray((128, 128, 0), (0, 0, 1), want=("a[1]", 127.75)), ray((0, 0, 9), (0, 0, -1), want=("a[0]", 8.75)))
    yield case

    case = Case("rebuild-automatic-resolution", "without a resolution cells follow the number of objects, both ways")
    case.sphere("s", 0.375)
    places = [(i % 10, i // 10 % 10, i // 100) for i in range(1000)]
    case.insert_many("a", "s", places[:20])
    case.expect_grid(rebuilds=0, objects=20, levels={"min": 1}, tiles=1)  # the first cells are no rebuild
    case.insert_many("b", "s", places[20:])
    case.expect_grid(objects=1000, levels={"min": 1}, entries={"min": 1000})
    rays = [ray((x + 0.05, y + 0.03, -5), (0, 0, 1)) for x in range(0, 10, 4) for y in range(0, 10, 4)]
    case.trace(*rays)
    case.remove_many([f"b[{i}]" for i in range(20, 980)])
    case.expect_grid(objects=40)
    case.trace(*rays)
    yield case


def levels():
    sizes = [0.25, 0.75, 1.5, 3.0, 6.0, 12.0, 24.0]  # radii; level i has cells of 2^i

    case = Case("level-fits-size", "an object is at the level whose cells are no smaller than it, in at most 8",
                grids=HIERARCHICAL, grid=unit_cells(64))
    used = 0
    for i, radius in enumerate(sizes):
        case.sphere(f"s{i}", radius)
        case.insert(f"a{i}", f"s{i}", (30.3, 31.1, 29.7))
        used |= 1 << i
        case.expect_grid(levels=7, levels_used=used, entries={"max": 8 * (i + 1)}, unbounded=0, objects=i + 1)
    case.trace(ray((-10, 31, 30), (1, 0, 0)), ray((30.3, 31.1, 29.7), (0, 0, 1)), ray((30, 31, 31), (0, 0, 1)),
               ray((30, 31, 33.5), (0.1, 0.2, 1)), ray((20, 12, 8), (1, 0.3, -0.1)))
    for i in (2, 0, 5, 6, 1):
        case.remove(f"a{i}")
        used &= ~(1 << i)
        case.expect_grid(levels_used=used)
        case.trace(ray((-10, 31, 30), (1, 0, 0)), ray((30.3, 31.1, 29.7), (0, 0, 1)))
    case.move_to("a3", (100, -50, 3))
    case.expect_grid(levels_used=used)
    yield case

    case = Case("level-too-large", "larger than the box on a side: tested for every ray instead", grids=HIERARCHICAL,
                grid=unit_cells(64))
    case.sphere("s", 33.0)
    case.box("b", (-40, -1, -1), (40, 1, 1))
    case.insert("a", "s", (100, 0, 0))
    case.insert("b", "b", (0, 50, 0))
    case.expect_grid(unbounded=2, levels_used=0)
    case.trace(ray((0, 0, 0), (1, 0, 0), want=("a", 67.0)), ray((39, 0, 0), (0, 1, 0), want=("b", 49.0)))
    yield case

    case = Case("level-empty-not-visited", "with nothing but large objects the walk takes large steps",
                grids=HIERARCHICAL,
                grid=unit_cells(64))
    case.sphere("s", 3.5)
    case.insert_many("a", "s", [(4, 4, 4), (60, 60, 60), (28, 4, 20)])
    case.expect_grid(levels_used=1 << 3)
    case.trace(ray((-1, 30, 30), (1, 0, 0), want="miss", give={"cells_max": 9, "tests": 0}),
               ray((30, -1, 40), (0, 1, 0), want="miss", give={"cells_max": 9, "tests": 0}),
               ray((-1, 4, 20), (1, 0, 0), want=("a[2]", 25.5), give={"cells_max": 5, "tests": 1}))
    yield case

    case = Case("level-parent-once", "a large object is tested once, not for each small cell of its large one",
                grids=HIERARCHICAL, grid=unit_cells(64))
    case.sphere("large", 3.5)
    case.sphere("small", 0.25)
    case.insert_many("l", "large", [(12, 12, 12), (36, 12, 12)])
    case.insert_many("s", "small", [(0.5, 0.5, 0.5), (63.5, 63.5, 63.5)])
    case.expect_grid(levels_used=1 << 3 | 1, entries=4)
    case.trace(ray((-1, 8.25, 8.25), (1, 0, 0), want="miss", give={"tests": 2}),
               ray((8.25, 8.25, 70), (0, 0, -1), want="miss", give={"tests": 1}),
               ray((15.75, 70, 8.25), (0, -1, 0), want="miss", give={"tests": 1}),
               ray((24.5, 70, 8.25), (0, -1, 0), want="miss", give={"tests": 0}))
    yield case

    case = Case("level-hit-beyond-cell", "a hit of a large object far ahead is kept while small cells are walked",
                grids=HIERARCHICAL, grid=unit_cells(64))
    case.sphere("large", 3.5)
    case.box("wall", (0, -3, -3), (0.25, 3, 3))
    case.sphere("small", 0.25)
    case.insert("ball", "large", (20, 12, 12))
    case.insert("wall", "wall", (14.5, 12, 12))
    case.insert_many("s", "small", [(11.5, 12.5, 12.5), (13.5, 10.5, 12.5), (15.5, 13.5, 12.5), (0.5, 0.5, 0.5)])
    case.trace(ray((2, 12.5, 12.5), (1, 0, 0), want=("s[0]", 9.25)),
               ray((2, 10.5, 12.5), (1, 0, 0), want=("s[1]", 11.25)),
               ray((2, 13.5, 12.5), (1, 0, 0), want=("wall", 12.5)), ray((30, 13.5, 12.5), (-1, 0, 0)),
               ray((2, 15.25, 12), (1, 0, 0)), ray((2, 11.5, 14.5), (1, 0.01, 0.02)),
               ray((15, 13.5, 12.5), (1, 0, 0)))
    yield case

    case = Case("level-resized", "a new pose of another size brings an object to another level", grids=HIERARCHICAL,
                grid=unit_cells(64))
    case.sphere("s", 0.25)
    case.insert("a", "s", (20.5, 20.5, 20.5))
    for size, level in ((1, 0), (3, 1), (20, 4), (6, 2), (1, 0)):
        case.move("a", (20.5, 20.5, 20.5), linear=(size, 0, 0, 0, size, 0, 0, 0, size))
        case.expect_grid(levels_used=1 << level, entries={"max": 8})
        case.trace(ray((20.5, 20.5, 0), (0, 0, 1), want=("a", 20.5 - 0.25 * size)), ray((0, 20.5, 20.5), (1, 0, 0)))
    yield case

    case = Case("uniform-every-overlapped-cell", "the uniform kind lists an object in each cell that it overlaps",
                grids=UNIFORM, grid=unit_cells(8))
    case.box("b", (-1.25, -0.25, -0.25), (1.25, 0.25, 0.25))
    case.insert("a", "b", (3.5, 3.5, 3.5))
    case.expect_grid(levels=1, entries=3, tiles=1, resolution=[8, 8, 8])
    case.move_to("a", (8, 3.5, 3.5))
    case.expect_grid(entries=4, tiles=2)
    case.move_to("a", (-3.5, 8, 3.5))
    case.expect_grid(entries=6, tiles=2)
    case.trace(ray((-3.5, 9.5, 3.5), (0, -1, 0), want=("a", 1.25)), ray((3.5, 3.5, 0), (0, 0, 1), want="miss"),
               ray((-4.5, 5, 3.5), (0, 1, 0), want=("a", 2.75)))
    yield case


def all_cases():
    for group in (tiles, logical, rebuilds, levels):
        yield from group()

