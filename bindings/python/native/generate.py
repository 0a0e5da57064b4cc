# SPDX-License-Identifier: MIT
"""Makes the C source of the extension module: generate.py DECLARATIONS MACROS CALLS OUTPUT.

DECLARATIONS and MACROS are the public headers as the preprocessor gives them, CALLS is calls.h. The C compiler checks
all that is declared here against the headers once more when it compiles the result.
"""

import pathlib
import re
import sys

import cffi

# What the library may call back. cffi makes C functions of these, which call what Python defined by that name.
CALLBACKS = """
extern "Python" int32_t py_filter(void *user, uint64_t index, const rg_hit *candidate);
extern "Python" void py_log(void *user, const char *message);
extern "Python" int32_t py_write(void *user, const void *bytes, size_t size);
extern "Python" void py_released(void *user);
"""


def constants(macros: str) -> str:
    """The macros of the headers that stand for numbers, as declarations."""
    lines = []
    for name, value in re.findall(r"^#define (RG_\w+)[ \t]+(\S.*)$", macros, re.MULTILINE):
        if re.search(r"\d[.e]", value):
            lines.append(f"static const double {name};")
        elif re.search(r"\d", value):
            lines.append(f"#define {name} ...")
        else:
            raise SystemExit(f"generate.py: {name} is {value}: neither a whole number nor a double")
    return "\n".join(lines)


def without_bodies(source: str) -> str:
    """The struct and the functions of calls.h, as declarations."""
    source = re.sub(r"/\*.*?\*/|^#.*?$", "", source, flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"^static ([^{]*?) \{.*?^\}", r"\1;", source, flags=re.DOTALL | re.MULTILINE)


def main(declarations: str, macros: str, calls: str, output: str) -> None:
    read = [pathlib.Path(name).read_text(encoding="utf-8") for name in (declarations, macros, calls)]
    builder = cffi.FFI()
    builder.cdef(read[0])
    builder.cdef(constants(read[1]))
    builder.cdef(without_bodies(read[2]))
    builder.cdef(CALLBACKS)
    builder.set_source("raygrid._raygrid", '#include "calls.h"\n')
    builder.emit_c_code(output)


main(*sys.argv[1:])
