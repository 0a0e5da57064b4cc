# SPDX-License-Identifier: MIT
"""What the public headers declare, read from their text.

The headers are plain C without conditional declarations, so that a small parser is enough: comments and preprocessor
lines are dropped, declarations end at a semicolon outside of braces and parentheses.
"""

import re


def declarations(text):
    """The declarations of a header, each as one line of text, without comments, preprocessor lines and extern "C"."""
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    text = re.sub(r"//[^\n]*", " ", text)
    text = re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*$", " ", text, flags=re.M)
    text = text.replace('extern "C" {', " ")
    found, depth, start = [], 0, 0
    for place, letter in enumerate(text):
        if letter in "{(":
            depth += 1
        elif letter in "})":
            depth = max(depth - 1, 0)
        elif letter == ";" and depth == 0:
            found.append(" ".join(text[start:place].split()).lstrip("} "))
            start = place + 1
    return [declaration for declaration in found if declaration]


def functions(text):
    """The names of the functions that a header exports: those marked RG_API."""
    exported = [line for line in declarations(text) if line.startswith("RG_API ")]
    return [re.search(r"(\w+)\s*\(", line).group(1) for line in exported]


def structs(text):
    """The structs with their fields, {name: [fields]}, opaque ones left out."""
    found = {}
    for line in declarations(text):
        match = re.match(r"typedef struct (\w+) \{(.*)\}", line)
        if match:
            found[match.group(1)] = [name for field in match.group(2).split(";") for name in field_names(field)]
    return found


def field_names(field):
    """The names in one field declaration of a struct: `const void *x, *y`, `double a[3], b[3]`, `int (*f)(void)`."""
    pointer = re.search(r"\(\*(\w+)\)", field)
    if pointer:
        return [pointer.group(1)]
    return [re.search(r"(\w+)\s*(?:\[\w*\])*\s*$", part).group(1) for part in field.split(",") if part.strip()]


def names(text):
    """Every name that a header puts into the scope of its user: functions, types, tags, enumerators; macros not."""
    found = []
    for line in declarations(text):
        if line.startswith("RG_API "):
            found += functions(line + ";")
            continue
        found += re.findall(r"\b(?:struct|union|enum)\s+(\w+)", line)
        enumerators = re.match(r"(?:typedef )?enum (?:\w+ )?\{(.*)\}", line)
        if enumerators:
            found += re.findall(r"(?:^|,)\s*(\w+)", enumerators.group(1))
        if line.startswith("typedef"):
            pointer = re.search(r"\(\*(\w+)\)\s*\(", line)
            found.append(pointer.group(1) if pointer and "{" not in line else re.findall(r"\w+", line)[-1])
        elif not enumerators:
            found += re.findall(r"\w+", line.split("(")[0].split("=")[0])[-1:]
    return found
