# SPDX-License-Identifier: MIT
"""Case files as text: numbers that every language reads the same, and one step or ray a line."""

import json
import math
import struct
from fractions import Fraction

LINE = 180


def number(x):
    """A double as JSON: a decimal where one of at most 16 characters is exactly the double, else the bits in hex."""
    x = float(x)
    if math.isnan(x):
        return "nan"
    if math.isinf(x):
        return "inf" if x > 0 else "-inf"
    if x == 0 and math.copysign(1, x) < 0:
        return "x8000000000000000"
    text = repr(x)
    if len(text) <= 16 and Fraction(text) == Fraction(x):
        return int(x) if x == int(x) and abs(x) < 2 ** 53 else x
    return "x" + struct.pack(">d", x).hex()


def numbers(values):
    return [number(x) for x in values]


def dumps(value, indent=0):
    """JSON that breaks a value over lines only where it doesn't fit one."""
    text = json.dumps(value, ensure_ascii=True)
    if indent + len(text) <= LINE or not isinstance(value, (dict, list)) or not value:
        return text
    inner = " " * (indent + 1)
    if isinstance(value, dict):
        items = [inner + json.dumps(k) + ": " + dumps(v, indent + 1) for k, v in value.items()]
        return "{\n" + ",\n".join(items) + "\n" + " " * indent + "}"
    if all(not isinstance(v, (dict, list)) for v in value):
        return text
    return "[\n" + ",\n".join(inner + dumps(v, indent + 1) for v in value) + "\n" + " " * indent + "]"
