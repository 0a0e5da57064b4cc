# SPDX-License-Identifier: MIT
"""The public headers: each compiles alone in every C and C++ that we promise, and takes no names but its own.

test_headers.py LAYOUT, the path of layout.c, which must name every field of every public struct.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import declarations

INCLUDE = pathlib.Path(__file__).resolve().parents[2] / "include"
HEADERS = sorted((INCLUDE / "raygrid").glob("*.h"))
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wundef", "-Werror"]
LANGUAGES = {"c": ["c99", "c11", "c17"], "c++": ["c++98", "c++11", "c++20"]}
COMPILERS = {"c": ["gcc", "clang"], "c++": ["g++", "clang++"]}
OWN_NAME = re.compile(r"(rg_|RG_|RAYGRID_)\w+")
SYSTEM_INCLUDES = "#include <stddef.h>\n#include <stdint.h>\n"


def run_compiler(compiler, language, source, *options):
    """Runs a compiler on source text from its standard input; returns (exit code, output, messages)."""
    command = [compiler, "-x", language, f"-I{INCLUDE}", *options, "-"]
    done = subprocess.run(command, input=source, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


def macros(source):
    """The names of the macros that are defined after the source text."""
    code, output, messages = run_compiler("gcc", "c", source, "-std=c99", "-dM", "-E")
    if code:
        raise RuntimeError(messages)
    return {line.split()[1].split("(")[0] for line in output.splitlines()}


class Headers(unittest.TestCase):
    def test_each_compiles_alone_and_twice(self):
        tried = 0
        for language, standards in LANGUAGES.items():
            for compiler in filter(shutil.which, COMPILERS[language]):
                for standard in standards:
                    for header in HEADERS:
                        with self.subTest(header=header.name, compiler=compiler, standard=standard):
                            source = f"#include <raygrid/{header.name}>\n" * 2
                            options = [f"-std={standard}", *WARNINGS, "-fsyntax-only"]
                            code, _, messages = run_compiler(compiler, language, source, *options)
                            self.assertEqual(code, 0, messages)
                            tried += 1
        self.assertGreater(tried, 0, "no compiler found")

    def test_macros_are_their_own(self):
        before = macros(SYSTEM_INCLUDES)
        for header in HEADERS:
            with self.subTest(header=header.name):
                added = macros(f"{SYSTEM_INCLUDES}#include <raygrid/{header.name}>\n") - before
                self.assertTrue(added, "not even an include guard")
                self.assertEqual([name for name in sorted(added) if not OWN_NAME.fullmatch(name)], [])

    def test_names_are_their_own(self):
        for header in HEADERS:
            with self.subTest(header=header.name):
                names = declarations.names(header.read_text(encoding="utf-8"))
                self.assertTrue(names or header.name == "raygrid.h", "no declarations found")
                self.assertEqual([name for name in names if not OWN_NAME.fullmatch(name)], [])

    def test_the_main_header_includes_all_others(self):
        text = (INCLUDE / "raygrid" / "raygrid.h").read_text(encoding="utf-8")
        included = set(re.findall(r"#include <raygrid/(\w+\.h)>", text))
        self.assertEqual(included, {header.name for header in HEADERS} - {"raygrid.h"})


class Layout(unittest.TestCase):
    layout = ""

    def test_every_field_of_every_struct_is_pinned(self):
        pinned = set(re.findall(r"^FIELD\((\w+), (\w+), \d+\);", self.layout, flags=re.M))
        sized = set(re.findall(r"^SIZE\((\w+), \d+\);", self.layout, flags=re.M))
        declared, fields = set(), set()
        for header in HEADERS:
            for struct, names in declarations.structs(header.read_text(encoding="utf-8")).items():
                declared.add(struct)
                fields |= {(struct, name) for name in names}
        self.assertGreater(len(declared), 0)
        self.assertEqual(sized, declared)
        self.assertEqual(pinned, fields)


if __name__ == "__main__":
    Layout.layout = pathlib.Path(sys.argv.pop(1)).read_text(encoding="utf-8")
    unittest.main()
