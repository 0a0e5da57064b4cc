# SPDX-License-Identifier: MIT
"""`python -m build` in a clean checkout: a source distribution with the library, and from it an abi3 wheel."""

from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
import sys
import tarfile
import zipfile

import pytest

ROOT = pathlib.Path(__file__).parents[3]
LIBRARY = ("LICENSE", "README.md", "include", "lib", "meson.build", "meson_options.txt", "packaging")


def checkout(place: pathlib.Path) -> None:
    """A repository of one commit with the sources as they are now."""
    ignore = shutil.ignore_patterns("__pycache__", ".*", "build", "dist")
    for name in (*LIBRARY, "bindings/python"):
        target = place / name
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, target, symlinks=True, ignore=ignore)
        else:
            shutil.copy(ROOT / name, target)
    who = {
        f"GIT_{role}_{what}": "nobody@example.com" for role in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")
    }
    for command in (["init", "-q"], ["add", "-A"], ["commit", "-q", "-m", "all"]):
        subprocess.run(["git", *command], cwd=place, env=os.environ | who, check=True)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> tuple[pathlib.Path, pathlib.Path]:
    """The source distribution, and the wheel that was built from it."""
    place = tmp_path_factory.mktemp("checkout")
    checkout(place)
    command = [sys.executable, "-m", "build", "--no-isolation", "--outdir", str(place / "out"), "bindings/python"]
    done = subprocess.run(
        command, cwd=place, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
    )
    assert done.returncode == 0, done.stdout
    (source,), (wheel,) = (place / "out").glob("*.tar.gz"), (place / "out").glob("*.whl")
    return source, wheel


def test_the_source_distribution_has_the_library(built: tuple[pathlib.Path, pathlib.Path]) -> None:
    with tarfile.open(built[0]) as archive:
        assert not [member.name for member in archive.getmembers() if member.issym()]
        names = {member.name.partition("/")[2] for member in archive.getmembers()}
    sources = {f"subprojects/raygrid/{path.relative_to(ROOT)}" for path in (ROOT / "lib").glob("*.c")}
    assert sources <= names
    assert {"pyproject.toml", "LICENSE", "PKG-INFO", "subprojects/raygrid/LICENSE", "raygrid/py.typed"} <= names


def test_the_wheel_has_the_package_alone(built: tuple[pathlib.Path, pathlib.Path]) -> None:
    wheel = built[1]
    assert f"-cp3{sys.version_info.minor}-abi3-" in wheel.name  # for this Python and all later
    package = pathlib.Path(__file__).parents[1] / "raygrid"
    modules = {
        f"raygrid/{path.relative_to(package)}" for path in package.rglob("*.py*") if "__pycache__" not in path.parts
    }
    with zipfile.ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if ".dist-info/" not in name}
        assert any(name.endswith(".dist-info/licenses/LICENSE") for name in archive.namelist())
    assert names == modules | {"raygrid/py.typed", "raygrid/_raygrid.abi3.so"}
    assert wheel.stat().st_size < 4e6


def test_the_wheel_keeps_to_the_stable_abi(built: tuple[pathlib.Path, pathlib.Path]) -> None:
    command = [sys.executable, "-m", "abi3audit", "--strict", str(built[1])]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    assert done.returncode == 0, done.stdout


def test_only_the_module_is_seen_from_outside(
    built: tuple[pathlib.Path, pathlib.Path], tmp_path: pathlib.Path
) -> None:
    """Two libraries in one process, this one and a shared libraygrid, must not mix."""
    with zipfile.ZipFile(built[1]) as archive:
        module = archive.extract("raygrid/_raygrid.abi3.so", tmp_path)
    symbols = subprocess.run(
        ["nm", "-D", "--defined-only", module], stdout=subprocess.PIPE, text=True, check=True
    ).stdout
    assert [line.split()[-1] for line in symbols.splitlines()] == ["PyInit__raygrid"]
