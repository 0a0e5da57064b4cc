# SPDX-License-Identifier: MIT
"""What the built libraries show to the linker, and what they ask from it.

test_symbols.py SHARED ARCHIVE MAP [NAME...]: the two libraries, the linker's version script, and what this build alone
imports besides.
"""

import pathlib
import re
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "headers"))
import declarations

INCLUDE = pathlib.Path(__file__).resolve().parents[2] / "include" / "raygrid"
SYSTEM_LIBRARIES = re.compile(r"(libc|libm|libpthread|ld-linux[-\w]*)\.so\.\d+")

# A library must not end the process of its host, print, read its environment, or change how it takes signals.
FORBIDDEN = {
    "abort", "exit", "_exit", "_Exit", "quick_exit", "atexit", "raise", "kill", "__assert_fail", "__assert",
    "printf", "vprintf", "fprintf", "vfprintf", "dprintf", "vdprintf", "puts", "fputs", "putchar", "putc", "fputc",
    "fwrite", "write", "perror", "psignal", "stdout", "stderr", "syslog", "__printf_chk", "__fprintf_chk",
    "__vfprintf_chk", "__vprintf_chk", "getenv", "secure_getenv", "setenv", "putenv", "setlocale", "signal",
    "sigaction", "rand", "srand", "strtok",
}


def tool(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def public_functions():
    found = []
    for header in sorted(INCLUDE.glob("*.h")):
        found += declarations.functions(header.read_text(encoding="utf-8"))
    return sorted(found)


class Symbols(unittest.TestCase):
    shared = archive = version_script = ""
    allowed = ()

    def test_exports_are_the_headers_functions(self):
        lines = [line.split() for line in tool("nm", "-D", "--defined-only", self.shared).splitlines()]
        # Type A: the name of the version itself.
        exported = sorted(fields[2].split("@")[0] for fields in lines if fields[1] != "A")
        self.assertGreater(len(exported), 0)
        self.assertEqual(exported, public_functions())

    def test_the_version_script_lists_them_too(self):
        text = pathlib.Path(self.version_script).read_text(encoding="utf-8")
        self.assertEqual(sorted(re.findall(r"^\s+(rg_\w+);", text, flags=re.M)), public_functions())

    def test_imports_do_nothing_behind_the_hosts_back(self):
        lines = tool("nm", "-D", "--undefined-only", self.shared).splitlines()
        imported = {line.split()[-1].split("@")[0] for line in lines}
        self.assertIn("free", imported, "not the list that was meant")
        self.assertEqual(sorted(imported & FORBIDDEN), sorted(self.allowed))

    def test_needs_only_the_system(self):
        text = tool("readelf", "-dW", self.shared)
        needed = re.findall(r"\(NEEDED\).*\[(.+)\]", text)
        self.assertIn("libc.so.6", needed)
        self.assertEqual([name for name in needed if not SYSTEM_LIBRARIES.fullmatch(name)], [])
        self.assertEqual(re.findall(r"\(SONAME\).*\[(.+)\]", text), ["libraygrid.so.0"])

    def test_archive_keeps_to_its_prefixes(self):
        lines = tool("nm", "--defined-only", "--extern-only", self.archive).splitlines()
        names = [line.split()[2] for line in lines if len(line.split()) == 3]
        self.assertTrue(set(public_functions()) <= set(names))
        self.assertEqual([name for name in names if not re.match(r"rgi?_", name)], [])

    def test_no_global_state_and_no_constructors(self):
        # Thread-local data (.tdata, .tbss) and constant tables with pointers (.data.rel.ro) are neither.
        columns = r"\]\s+(\.\S+)\s+\w+\s+[0-9a-f]+\s+[0-9a-f]+\s+([0-9a-f]+)"  # name, type, address, offset, size
        sections = re.findall(columns, tool("readelf", "-SW", self.archive))
        self.assertIn(".text", [name for name, _ in sections])
        state = re.compile(r"\.(data|bss|init_array|ctors|preinit_array)(?!\.rel\.ro)(\.|$)")
        self.assertEqual([name for name, size in sections if state.match(name) and int(size, 16) > 0], [])


if __name__ == "__main__":
    Symbols.shared, Symbols.archive, Symbols.version_script, *Symbols.allowed = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
