# SPDX-License-Identifier: MIT
"""The cases that every language plays: tests/conformance of the repository, through this package's interface."""

from __future__ import annotations

import copy
import json
import pathlib
from typing import Any

import pytest

from conformance.runner import play_case
from conformance.script import Malformed

CASES = pathlib.Path(__file__).parents[3] / "tests" / "conformance" / "cases"
COUNTS = {
    name: int(count) for name, count in (line.split() for line in (CASES / "index.txt").read_text().splitlines())
}
FILES: dict[str, list[dict[str, Any]]] = {name: json.loads((CASES / name).read_text()) for name in COUNTS}


@pytest.mark.parametrize("name", COUNTS)
def test_all_cases_are_there(name: str) -> None:
    assert len(FILES[name]) == COUNTS[name]


@pytest.mark.parametrize(
    "case", [pytest.param(case, id=f"{name[:-5]}-{case['name']}") for name, cases in FILES.items() for case in cases]
)
def test_case(case: dict[str, Any]) -> None:
    play_case(case)


def a_case() -> dict[str, Any]:
    return copy.deepcopy(next(case for case in FILES["sphere.json"] if case["steps"][-1]["do"] == "trace"))


def break_step(case: dict[str, Any]) -> None:
    case["steps"].insert(0, {"do": "explode"})


def break_flag(case: dict[str, Any]) -> None:
    case["flags"] = ["hasty"]


def break_setup(case: dict[str, Any]) -> None:
    case["grids"] = ["octree"]


def break_field(case: dict[str, Any]) -> None:
    case["steps"][0]["colour"] = "red"


def break_ray(case: dict[str, Any]) -> None:
    case["steps"][-1]["rays"][0]["hit"]["colour"] = "red"


@pytest.mark.parametrize("damage", [break_step, break_flag, break_setup, break_field, break_ray])
def test_what_is_unknown_fails(damage: Any) -> None:
    case = a_case()
    damage(case)
    with pytest.raises(Malformed):
        play_case(case)


def test_a_wrong_answer_fails() -> None:
    case = a_case()
    for line in case["steps"][-1]["rays"]:
        line["hit"] = None
    with pytest.raises(AssertionError, match="ray 0: hit"):
        play_case(case)
