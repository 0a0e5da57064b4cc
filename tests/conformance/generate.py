#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""
Makes cases/*.json, their list and a table of what they cover, or with --check makes them again and fails where the
committed files differ. Needs python3-jsonschema; see README.md.
"""

import json
import sys
from pathlib import Path

import jsonschema

import cases_box
import cases_capsule
import cases_grid
import cases_grids
import cases_loose
import cases_mesh
import cases_paper
import cases_pose
import cases_query
import cases_random
import cases_scene
import cases_shapes
import cases_sphere
import cases_triangle
import emit

HERE = Path(__file__).resolve().parent
TOPICS = {
    "sphere": cases_sphere, "box": cases_box, "capsule": cases_capsule, "triangle": cases_triangle,
    "mesh": cases_mesh,
    "shapes": cases_shapes, "pose": cases_pose,
    "query": cases_query, "scene": cases_scene, "grid": cases_grid, "grids": cases_grids, "loose": cases_loose,
    "paper": cases_paper,
    "random": cases_random,
}
LEAST = 120  # cases
EVERY_NUMBER = set(range(1, 41))  # of the list of stiff and extreme cases


KINDS = ["sphere", "box", "capsule", "mesh"]


def cell(names):
    """The first few of them."""
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")


def coverage(cases):
    """The list of stiff and extreme cases: what plays a part in each, by the shapes in it."""
    lines = ["<!-- SPDX-License-Identifier: MIT -->", "<!-- Made by generate.py. -->", "# Which case covers what", "",
             "Numbers are those of the list in [README.md](../README.md). A case that has several shapes is in",
             "several columns. Set-ups: those that the cases of a line are played on, at most; each in every way to",
             "trace.", "",
             "| | " + " | ".join(KINDS) + " | no shape | set-ups |", "|---" * (len(KINDS) + 3) + "|"]
    for number in sorted(EVERY_NUMBER):
        of_number = [case for case in cases if number in case["numerics"]]
        by_kind = {kind: [case["name"] for case in of_number if any(step["do"] == kind for step in case["steps"])]
                   for kind in KINDS}
        without = [case["name"] for case in of_number if not any(case["name"] in names for names in by_kind.values())]
        setups = max(len(case["grids"]) for case in of_number)
        cells = [cell(by_kind[kind]) for kind in KINDS] + [cell(without), str(setups)]
        lines.append(f"| {number} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def texts():
    """The text of each file, checked against the schema."""
    validator = jsonschema.Draft202012Validator(json.loads((HERE / "schema.json").read_text()))
    validator.check_schema(validator.schema)
    names, covered, made, index, every = set(), set(), {}, "", []
    for topic, module in TOPICS.items():
        cases = [case.json() for case in module.all_cases()]
        text = "[\n" + ",\n".join(map(emit.dumps, cases)) + "\n]\n"
        for problem in validator.iter_errors(json.loads(text)):
            raise SystemExit(f"{topic}: {problem.json_path}: {problem.message}")
        for case in cases:
            if case["name"] in names:
                raise SystemExit(f"two cases are named {case['name']}")
            names.add(case["name"])
            covered.update(case["numerics"])
        made[topic + ".json"] = text
        every += cases
        index += f"{topic}.json {len(cases)}\n"
    if len(names) < LEAST:
        raise SystemExit(f"only {len(names)} cases, expected at least {LEAST}")
    if covered != EVERY_NUMBER:
        raise SystemExit(f"numerics without a case: {sorted(EVERY_NUMBER - covered)}")
    print(f"{len(names)} cases in {len(made)} files")
    made["index.txt"] = index
    made["coverage.md"] = coverage(every)
    return made


def main():
    if sys.argv[1:] not in ([], ["--check"]):
        raise SystemExit("usage: generate.py [--check]")
    folder, made = HERE / "cases", texts()
    there = {path.name: path.read_text() for path in folder.glob("*.*")}
    if sys.argv[1:]:
        differ = sorted(name for name in made.keys() | there.keys() if made.get(name) != there.get(name))
        if differ:
            raise SystemExit("not as generated: " + ", ".join(differ))
        return
    folder.mkdir(exist_ok=True)
    for name in there.keys() - made.keys():
        (folder / name).unlink()
    for name, text in made.items():
        (folder / name).write_text(text)


if __name__ == "__main__":
    main()
