# SPDX-License-Identifier: MIT
"""Builds the library with parts left out and looks at what is there and what is not.

test_options.py SOURCE COMPILER...: the tree, the compiler's command. Nothing is optimised: speed is not what is
tested.
"""

import os
import pathlib
import shlex
import subprocess
import sys
import tempfile
import unittest

KERNELS = {"portable": 0, "sse2": 1, "avx2": 2, "avx512": 3, "neon": 4}  # and their rg_isa
HERE = pathlib.Path(__file__).resolve().parent


def run(*command, **options):
    """Runs a command; returns what it wrote to standard output; fails with all that it wrote."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    if done.returncode:
        raise AssertionError(f"{shlex.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


class Build:
    """The library as it is with some options, and what is known of it."""

    def __init__(self, source, compiler, out, *options):
        environment = dict(os.environ, CC=shlex.join(compiler))
        run("meson", "setup", out, source, "--buildtype=release", "-Doptimization=0", "--werror", "-Dtests=disabled",
            "-Dexamples=disabled", "-Dbench=disabled", *options, env=environment)
        run("ninja", "-C", out, "lib/libraygrid.so.0", "lib/libraygrid.a")
        self.out, self.source, self.compiler = out, source, compiler
        self.shared, self.archive = out / "lib" / "libraygrid.so.0", out / "lib" / "libraygrid.a"
        self.sources = {member.removesuffix(".o") for member in run("ar", "t", self.archive).split()}
        self.imports = {line.split()[-1].split("@")[0]
                        for line in run("nm", "-D", "--undefined-only", self.shared).splitlines()}

    def probe(self, *kinds):
        """The workers and the instructions of a scene, after all kinds of shapes were tried."""
        program = self.out / "probe"
        run(*self.compiler, "-std=c99", "-I", self.source / "include", HERE / "probe.c", self.shared,
            f"-Wl,-rpath,{self.shared.parent}", "-o", program)
        words = run(program, *kinds).split()
        return int(words[1]), int(words[3])


class Options(unittest.TestCase):
    source = compiler = None

    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="raygrid options ")
        self.addCleanup(scratch.cleanup)
        self.scratch = pathlib.Path(scratch.name)

    def build(self, *options):
        return Build(self.source, self.compiler, self.scratch / "build", *options)

    def check_symbols(self, build):
        """Exports and imports do not depend on the options."""
        run(sys.executable, HERE.parent / "embedding" / "test_symbols.py", build.shared, build.archive,
            self.source / "lib" / "raygrid.map")

    def test_smallest(self):
        build = self.build("-Dkernels=portable", "-Dshapes=sphere", "-Dthreads=false")
        self.assertEqual(build.probe("sphere"), (1, KERNELS["portable"]))
        self.assertIn("sphere.c", build.sources)
        gone = {"box.c", "capsule.c", "mesh.c", "mesh_build.c", *(f"kernels_{isa}.c" for isa in KERNELS)}
        self.assertEqual(build.sources & gone, {"kernels_portable.c"})
        self.assertNotIn("pthread_create", build.imports)
        self.check_symbols(build)

    def test_what_the_smallest_lacks(self):
        """All other kinds of shapes and threads, and of the kernels the least of each machine."""
        build = self.build("-Dkernels=sse2,neon", "-Dshapes=box,capsule,mesh,user")
        workers, isa = build.probe("box", "capsule", "mesh", "user")
        self.assertEqual(workers, 8)
        self.assertEqual({f"kernels_{name}.c" for name in KERNELS if KERNELS[name] in (0, isa)},
                         {name for name in build.sources if name.startswith("kernels_")})
        self.assertIn("pthread_create", build.imports)
        self.check_symbols(build)


if __name__ == "__main__":
    Options.source, Options.compiler = pathlib.Path(sys.argv[1]), sys.argv[2:]
    unittest.main(argv=sys.argv[:1])
