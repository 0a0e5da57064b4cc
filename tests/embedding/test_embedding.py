# SPDX-License-Identifier: MIT
"""Builds examples/hello.c outside of the tree as a user of the library would, in each of the ways we promise.

test_embedding.py SOURCE BUILD COMPILER...: the tree, its build directory (already built), the compiler's command.
The library is installed under a path with a space, by DESTDIR, so the files that describe it must not rely on theirs.
"""

import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

EXPECTED = "inserted: 4\nmoved: 8\nremoved: inf\n"

CMAKE_PROJECT = """
cmake_minimum_required(VERSION 3.16)
project(embedding C)
find_package(raygrid 99 QUIET)
if(raygrid_FOUND)
  message(FATAL_ERROR "a version was found that can't be there yet")
endif()
find_package(raygrid 0.1 REQUIRED)
add_executable(shared hello.c)
target_link_libraries(shared PRIVATE raygrid::raygrid)
add_executable(static hello.c)
target_link_libraries(static PRIVATE raygrid::raygrid_static)
"""

MESON_PROJECT = """
project('embedding', 'c', default_options: ['c_std=c99'])
executable('hello', 'hello.c', dependencies: dependency('raygrid', fallback: 'raygrid'))
"""


def run(command, **options):
    """Runs a command; returns what it wrote to standard output; fails with all that it wrote."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    if done.returncode:
        raise AssertionError(f"{shlex.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def needed(program):
    """The shared libraries that a program asks for."""
    lines = run(["readelf", "-dW", program]).splitlines()
    return [line.split("[")[1].rstrip("]") for line in lines if "(NEEDED)" in line]


class Embedding(unittest.TestCase):
    source = build = compiler = None

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(prefix="raygrid embedding ")
        root = pathlib.Path(cls.scratch.name)
        cls.installed = root / "installed"
        run(["meson", "install", "-C", cls.build, "--no-rebuild", "--destdir", cls.installed])
        cls.pc = next(cls.installed.rglob("raygrid.pc"))
        cls.prefix = next(cls.installed.rglob("include/raygrid")).parents[1]
        cls.library = next(cls.installed.rglob("libraygrid.so")).parent
        cls.work = root / "work"
        cls.work.mkdir()
        shutil.copy(cls.source / "examples" / "hello.c", cls.work)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def pkg_config(self, *options):
        environment = dict(os.environ, PKG_CONFIG_LIBDIR=str(self.pc.parent))
        prefix = "--define-variable=prefix=" + str(self.prefix).replace(" ", "\\ ")
        return shlex.split(run(["pkg-config", prefix, *options, "raygrid"], env=environment))

    def check_output(self, program):
        environment = dict(os.environ, LD_LIBRARY_PATH=str(self.library))
        self.assertEqual(run([program], env=environment), EXPECTED)

    def compile_hello(self, name, *options):
        program = self.work / name
        run([*self.compiler, "-std=c99", self.work / "hello.c", "-o", program, *options])
        return program

    def test_pkg_config(self):
        program = self.compile_hello("by-pkg-config", *self.pkg_config("--cflags", "--libs"))
        self.assertIn("libraygrid.so.0", needed(program))
        self.check_output(program)

    def test_pkg_config_static(self):
        flags = self.pkg_config("--static", "--cflags", "--libs")
        program = self.compile_hello("by-pkg-config-static", "-static", *flags)
        self.assertEqual(needed(program), [])
        self.check_output(program)

    def test_pkg_config_knows_the_version(self):
        self.pkg_config("--atleast-version=0.1")
        with self.assertRaises(AssertionError):
            self.pkg_config("--atleast-version=99")

    def test_cmake(self):
        (self.work / "CMakeLists.txt").write_text(CMAKE_PROJECT, encoding="utf-8")
        out = self.work / "cmake-build"
        run(["cmake", "-S", self.work, "-B", out, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}",
             f"-DCMAKE_C_COMPILER={self.compiler[-1]}"])
        run(["cmake", "--build", out])
        self.assertIn("libraygrid.so.0", needed(out / "shared"))
        self.assertNotIn("libraygrid.so.0", needed(out / "static"))
        self.check_output(out / "shared")
        self.check_output(out / "static")

    def test_meson_subproject(self):
        project = self.work / "subproject"
        (project / "subprojects").mkdir(parents=True)
        (project / "subprojects" / "raygrid").symlink_to(self.source)
        (project / "meson.build").write_text(MESON_PROJECT, encoding="utf-8")
        shutil.copy(self.work / "hello.c", project)
        environment = dict(os.environ, CC=shlex.join(self.compiler))
        out = project / "out"
        run(["meson", "setup", "--wrap-mode=forcefallback", out, project], env=environment)
        run(["ninja", "-C", out, "hello"])
        self.assertEqual(run([out / "hello"]), EXPECTED)


if __name__ == "__main__":
    Embedding.source, Embedding.build = (pathlib.Path(argument) for argument in sys.argv[1:3])
    Embedding.compiler = sys.argv[3:]
    unittest.main(argv=sys.argv[:1])
