# SPDX-License-Identifier: MIT
"""Objects come and go: NUMERICS 38, ids and generations, many at once, what the next trace sees."""

from script import NAN, Case, ray

DOWN = ((0, 0, -5), (0, 0, 1))


def empty():
    case = Case("scene-empty", "an empty scene has no box to walk through: a miss at once", numerics=[38])
    rays = [ray(*DOWN, want="miss"), ray((1e50, 0, 0), (-1, 0, 0), want="miss"),
            ray((0, 0, 0), (1, 1, 1), want="miss")]
    case.trace(*rays)
    case.expect_scene(objects=0, slots=0)
    case.expect_grid(objects=0, entries=0, unbounded=0, rebuilds=0)
    yield case

    case = Case("scene-last-object-removed", "after the last remove the scene is as empty as a new one, and works on",
                numerics=[38])
    case.sphere("s", 1.0)
    for place in ((0, 0, 0), (100, 0, 0), (0, -30, 2)):
        case.insert("a", "s", place)
        look = ray((place[0], place[1], place[2] - 5), (0, 0, 1))
        case.trace(look)
        case.remove("a")
        case.trace(look, ray(*DOWN, want="miss"))
        case.expect_scene(objects=0, slots=1)
        case.expect_grid(objects=0, entries=0)
    yield case

    case = Case("scene-emptied-by-many", "remove_many of all", numerics=[38])
    case.sphere("s", 1.0)
    case.insert_many("a", "s", [(3.0 * i, 0, 0) for i in range(20)])
    rays = [ray((3.0 * i, 0, -5), (0, 0, 1)) for i in range(0, 20, 3)]
    case.trace(*rays)
    case.remove_many([f"a[{i}]" for i in range(20)])
    case.trace(*rays)
    case.expect_grid(objects=0, entries=0)
    case.insert("again", "s", (6, 0, 0))
    case.trace(*rays)
    yield case


def at_once():
    case = Case("move-seen-at-once", "no commit: each trace sees the last move, the old place is empty")
    case.sphere("s", 1.0)
    case.insert("a", "s", (0, 0, 0))
    places = [(0, 0, 0), (0.25, 0, 0), (8, 0, 0), (-8, 5, 3), (0, 0, 0), (3, 3, 3)]
    rays = [ray((p[0], p[1], p[2] - 5), (0, 0, 1)) for p in places]
    for place in places:
        case.move_to("a", place)
        case.trace(*rays)
        case.expect_object("a", position=[float(x) for x in place],
                           contains=[[x - 1.0 for x in place], [x + 1.0 for x in place]])
    case.expect_scene(objects=1, slots=1)
    yield case

    case = Case("remove-seen-at-once", "a removed object is no ghost, and its place shows what was behind")
    case.sphere("s", 1.0)
    case.insert_many("a", "s", [(0, 0, 3.0 * i) for i in range(6)])
    for i in (0, 3, 1, 2, 5, 4):
        case.remove(f"a[{i}]")
        case.trace(ray(*DOWN), ray((0, 0, 30), (0, 0, -1)))
    yield case

    case = Case("move-within-cells", "many steps smaller than a cell, forth and back: kept boxes must grow with them")
    case.sphere("s", 0.5)
    case.insert_many("a", "s", [(2.0 * i, 0, 0) for i in range(5)])
    for step in range(1, 13):
        place = (4 + (step % 5) * 0.125 - 0.25, 0.061 * step, 0)
        case.move_to("a[2]", place)
        case.trace(ray((place[0], place[1], -5), (0, 0, 1)), ray((4, 0, -5), (0, 0, 1)),
                   ray((-9, 0.061 * step, 0), (1, 0, 0)))
    yield case


def ids():
    case = Case("id-slots-and-generations", "freed slots come back last in first out, one generation up")
    case.sphere("s", 1.0)
    for i, name in enumerate("abcd"):
        case.insert(name, "s", (3.0 * i, 0, 0))
        case.expect_object(name, slot=i, generation=1)
    case.trace(ray(*DOWN, want=("a", 4.0)), ray((3, 0, -5), (0, 0, 1), want=("b", 4.0)))
    case.remove("b")
    case.remove("d")
    case.insert("e", "s", (3, 0, 0))
    case.expect_object("e", slot=3, generation=2)
    case.insert("f", "s", (9, 0, 0))
    case.expect_object("f", slot=1, generation=2)
    case.insert("g", "s", (12, 0, 0))
    case.expect_object("g", slot=4, generation=1)
    case.trace(*(ray((3.0 * i, 0, -5), (0, 0, 1)) for i in range(5)))
    case.remove("f")
    case.insert("h", "s", (9, 0, 0))
    case.expect_object("h", slot=1, generation=3)
    case.expect_scene(objects=5, slots=5)
    yield case

    case = Case("id-stale", "a stale id is an error in every call, never another object")
    case.sphere("s", 1.0)
    case.insert("old", "s", (0, 0, 0))
    case.insert("other", "s", (4, 0, 0))
    case.remove("old")
    case.insert("new", "s", (0, 0, 0))  # has the slot of the old one
    case.expect_object("new", slot=0, generation=2)
    case.trace(ray(*DOWN, want=("new", 4.0)), ray((4, 0, -5), (0, 0, 1), want=("other", 4.0)))
    at = [9.0, 9.0, 9.0]
    case.expect_error("RG_INVALID_ID", "", "move", object="old", position=at)
    case.expect_error("RG_INVALID_ID", "", "move_to", object="old", position=at)
    case.expect_error("RG_INVALID_ID", "1", "move_many", objects=["other", "old"], positions=[at, at])
    case.expect_error("RG_INVALID_ID", "", "set_mask", object="old", mask=0)
    case.expect_error("RG_INVALID_ID", "", "remove", object="old")
    case.expect_error("RG_INVALID_ID", "2", "remove_many", objects=["other", "new", "old"])
    case.expect_error("RG_INVALID_ID", "", "lookup", object="old")
    case.expect_scene(objects=2, slots=2)
    yield case

    case = Case("id-never-given", "ids that were never given out, and none")
    case.sphere("s", 1.0)
    case.insert("a", "s", (0, 0, 0))
    case.trace(ray(*DOWN, want=("a", 4.0)))
    for id in ("none", "x0000000100000001", "x0000000000000000", "x0000000200000000", "xffffffffffffffff",
               "x00000001ffffffff", "xffffffff00000000", "x0000000000000001"):
        case.expect_error("RG_INVALID_ID", "", "remove", object={"id": id})
        case.expect_error("RG_INVALID_ID", "", "lookup", object={"id": id})
    case.expect_error("RG_INVALID_ID", "", "move_to", object={"id": "none"}, position=[1.0, 0.0, 0.0])
    case.expect_scene(objects=1)
    yield case

    case = Case("id-removed-twice", "removing twice, and after the slot was used again")
    case.sphere("s", 1.0)
    case.insert("a", "s", (0, 0, 0))
    case.remove("a")
    case.trace(ray(*DOWN, want="miss"))
    case.expect_error("RG_INVALID_ID", "", "remove", object="a")
    for i in range(5):
        case.insert(f"b{i}", "s", (0, 0, 0))
        case.expect_object(f"b{i}", slot=0, generation=i + 2)
        case.trace(ray(*DOWN, want=(f"b{i}", 4.0)))
        case.expect_error("RG_INVALID_ID", "", "remove", object="a")
        case.remove(f"b{i}")
        case.trace(ray(*DOWN, want="miss"))
        case.expect_error("RG_INVALID_ID", "", "set_mask", object=f"b{i}", mask=1)
    case.expect_scene(objects=0, slots=1)
    yield case


def many():
    def base(name, note, numerics=()):
        case = Case(name, note, numerics=numerics)
        case.sphere("s", 1.0)
        case.box("b", (-1, -1, -1), (1, 1, 1))
        case.insert_many("a", "s", [(3.0 * i, 0, 0) for i in range(4)])
        case.trace(*(ray((3.0 * i, 0.25, -5), (0, 0, 1)) for i in range(6)))
        return case

    case = base("many-insert-mixed", "shapes, linear parts and masks each their own")
    case.insert_many("m", ["s", "b", "s", "b"], [(3.0 * i, 6, 0) for i in range(4)],
                     linears=[(1 + i, 0, 0, 0, 1, 0, 0, 0, 0.5) for i in range(4)], masks=[1, 2, 4, 0xFFFFFFFF])
    case.trace(*(ray((3.0 * i, 6.25, -5), (0, 0, 1), mask=m) for i in range(4) for m in (1, 2, 4, 0xFFFFFFFF)))
    for i, mask in enumerate((1, 2, 4, 0xFFFFFFFF)):
        case.expect_object(f"m[{i}]", mask=mask, slot=4 + i, generation=1)
    yield case

    case = base("many-insert-all-or-none", "one bad pose of many: none is inserted, its index is named",
                numerics=[29])
    for bad in range(4):
        positions = [[1.0 * i, 9.0, 0.0] for i in range(4)]
        positions[bad][1] = NAN
        case.expect_error("RG_INVALID_VALUE", str(bad), "insert_many", objects="x", shape="s", positions=positions)
    linears = [[1, 0, 0, 0, 1, 0, 0, 0, 1], [1, 0, 0, 0, 1, 0, 0, 0, 1], [1, 0, 0, 1, 0, 0, 0, 0, 1]]
    case.expect_error("RG_INVALID_VALUE", "2", "insert_many", objects="x", shape="s",
                      positions=[[0.0, 9.0, 0.0]] * 3, linears=linears)
    case.expect_scene(objects=4, slots=4)
    case.insert("y", "s", (0, 6, 0))
    case.expect_object("y", slot=4, generation=1)
    case.trace(ray((0, 6, -5), (0, 0, 1), want=("y", 4.0)), ray((1, 9, -5), (0, 0, 1), want="miss"))
    yield case

    case = base("many-move-all-or-none", "one bad pose or id of many: none is moved, its index is named")
    names = [f"a[{i}]" for i in range(4)]
    there = [[3.0 * i, 9.0, 0.0] for i in range(4)]
    for bad in range(4):
        positions = [list(p) for p in there]
        positions[bad][0] = NAN
        case.expect_error("RG_INVALID_VALUE", str(bad), "move_many", objects=names, positions=positions)
        stale = [{"id": "x0000000700000000"} if i == bad else n for i, n in enumerate(names)]
        case.expect_error("RG_INVALID_ID", str(bad), "move_many", objects=stale, positions=there)
    for i in range(4):
        case.expect_object(f"a[{i}]", position=[3.0 * i, 0.0, 0.0])
    yield case

    case = base("many-remove-all-or-none", "a stale id or one given twice: none is removed, its index is named")
    case.expect_error("RG_INVALID_ID", "2", "remove_many", objects=["a[0]", "a[1]", "a[0]"])
    case.expect_error("RG_INVALID_ID", "3", "remove_many", objects=["a[0]", "a[1]", "a[2]", "a[2]"])
    case.expect_error("RG_INVALID_ID", "1", "remove_many", objects=["a[3]", {"id": "x0000000200000000"}, "a[2]"])
    case.expect_scene(objects=4)
    case.remove_many(["a[3]", "a[1]"])
    case.expect_scene(objects=2, slots=4)
    case.trace(*(ray((3.0 * i, 0.25, -5), (0, 0, 1)) for i in range(4)))
    yield case

    case = base("many-of-none", "calls on no object do nothing and succeed")
    case.insert_many("none", "s", [])
    case.move_many([], [])
    case.remove_many([])
    case.trace()
    case.expect_scene(objects=4)
    yield case

    case = Case("many-insert-remove-order", "a thousand come and go in an order of their own; ids stay apart")
    case.sphere("s", 0.375)
    case.insert_many("a", "s", [(i % 10, i // 10 % 10, i // 100) for i in range(300)])
    case.remove_many([f"a[{i * 7 % 300}]" for i in range(150)])
    case.insert_many("b", "s", [(i % 10 + 0.5, i // 10 % 10, i // 100) for i in range(150)])
    case.move_many([f"b[{i}]" for i in range(0, 150, 2)], [(i % 10, i // 10 % 10 + 0.5, -3) for i in range(75)])
    case.trace(*(ray((x * 0.5 + 0.03, y + 0.07, -9), (0, 0, 1)) for x in range(20) for y in range(0, 10, 3)),
               *(ray((-9, x * 0.5 + 0.13, y + 0.07), (1, 0.01, 0)) for x in range(0, 20, 3) for y in range(-3, 3)))
    yield case


def all_cases():
    for group in (empty, at_once, ids, many):
        yield from group()
