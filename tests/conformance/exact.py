# SPDX-License-Identifier: MIT
"""Exact numbers: doubles as rationals, square roots by integers, vectors and matrices of rationals."""

import math
import struct
from fractions import Fraction

# Bits of an irrational square root. Results are rounded to 53 bits after at most ~110 bits of cancellation.
ROOT_BITS = 640


def exact(x):
    """The rational number that a double is."""
    return Fraction(x)


def f32(x):
    """x rounded to float, as a double."""
    return struct.unpack("<f", struct.pack("<f", x))[0]


def next_float(x, up):
    """The float after the float x."""
    bits = struct.unpack("<i", struct.pack("<f", x))[0]
    bits += 1 if (x > 0) == up else -1
    return struct.unpack("<f", struct.pack("<i", bits))[0]


def root(q):
    """
    The square root of a rational: itself where it is rational, else the middle of an interval of relative width
    2^-ROOT_BITS/2 that holds it and no number of fewer bits, so that it rounds to double as the true root does.
    """
    n, d = q.numerator, q.denominator
    rn, rd = math.isqrt(n), math.isqrt(d)
    if rn * rn == n and rd * rd == d:
        return Fraction(rn, rd)
    k = max(0, (ROOT_BITS - n.bit_length() + d.bit_length()) // 2 + 1)
    s = math.isqrt((n << (2 * k)) // d)
    return Fraction(2 * s + 1, 1 << (k + 1))


def rounded(q):
    """A rational rounded to the nearest double."""
    return float(q)


def rounded_up(q):
    """The smallest double that is no smaller than q, to few bits: tolerances stay readable."""
    if q == 0:
        return 0.0
    mantissa, exponent = math.frexp(float(q))
    up = math.ldexp(math.ceil(mantissa * 256) / 256, exponent)
    while exact(up) < q:
        up = math.ldexp(math.ceil(math.frexp(up)[0] * 256 + 1) / 256, exponent)
    return up


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def scale(a, s):
    return tuple(x * s for x in a)


def vector(v):
    return tuple(exact(x) for x in v)


def times(m, v):
    """The matrix m (nine numbers by rows) times the column v."""
    return tuple(dot(m[3 * i:3 * i + 3], v) for i in range(3))


def transposed(m):
    return tuple(m[3 * j + i] for i in range(3) for j in range(3))


def inverse(m):
    """The inverse of a 3x3 matrix by its adjugate."""
    rows = [m[0:3], m[3:6], m[6:9]]
    columns = [cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])]
    determinant = dot(rows[0], columns[0])
    return tuple(columns[j][i] / determinant for i in range(3) for j in range(3))


IDENTITY = tuple(exact(float(i % 4 == 0)) for i in range(9))
