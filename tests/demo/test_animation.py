# SPDX-License-Identifier: MIT
"""The demo's reading of glTF animations against the formulas of the specification, worked out anew here."""
import math
import os
import subprocess
import sys
import tempfile
import unittest

import gltf_files

POSES = sys.argv.pop(1)


def bracket(times, time):
    """The interval of keys that holds the time, and how far into it, 0 to 1; clamped at both ends."""
    time = min(max(time, times[0]), times[-1])
    for i in range(len(times) - 1):
        if time < times[i + 1]:
            return i, (time - times[i]) / (times[i + 1] - times[i])
    return len(times) - 2, 1.0


def lerp(a, b, s):
    return [x + (y - x) * s for x, y in zip(a, b)]


def slerp(a, b, s):
    dot = sum(x * y for x, y in zip(a, b))
    if dot < 0:
        b, dot = [-y for y in b], -dot
    angle = math.acos(min(dot, 1.0))
    if angle == 0:
        return list(a)
    return [(math.sin((1 - s) * angle) * x + math.sin(s * angle) * y) / math.sin(angle) for x, y in zip(a, b)]


def hermite(keys, i, s, seconds):
    """keys: for each the in-tangent, the value, the out-tangent."""
    return [(2 * s**3 - 3 * s**2 + 1) * p + seconds * (s**3 - 2 * s**2 + s) * m + (3 * s**2 - 2 * s**3) * q +
            seconds * (s**3 - s**2) * n
            for p, m, q, n in zip(keys[i][1], keys[i][2], keys[i + 1][1], keys[i + 1][0])]


def matrix(translation, rotation, scale):
    """The rows of the 3x4 matrix that takes column vectors out of the node."""
    x, y, z, w = rotation
    turn = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return [[turn[i][j] * scale[j] for j in range(3)] + [translation[i]] for i in range(3)]


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) + (a[i][3] if j == 3 else 0) for j in range(4)]
            for i in range(3)]


def expected(time):
    """The world matrices of the three nodes of gltf_files.animated()."""
    half = 0.5 ** 0.5
    i, s = bracket([0.5, 1.5, 2.5], time)
    turns = [(0, 0, 0, 1), (0, half, 0, half), (0, 0, half, -half)]
    hub = matrix((0, 0, 0), slerp(turns[i], turns[i + 1], s), (1, 1, 1) if time < 2 else (1, 2, 0.5))
    i, s = bracket([1, 3], time)
    keys = [[(0, 0, 0), (3, 0.5, 0), (1, 2, 3)], [(4, 5, 6), (0, 2, 1), (7, 8, 9)]]
    arm = matrix(hermite(keys, i, s, 2.0), (0, 0, 0, 1), (0.5, 0.5, 0.5))
    i, s = bracket([0, 1, 2], time)
    path = [(0, 0, 4), (2, 0, 4), (2, -1, 4)]
    return [times(hub, arm), hub, matrix(lerp(path[i], path[i + 1], s), (0, 0, 0, 1), (1, 1, 1))]


class Animation(unittest.TestCase):
    def test_poses(self):
        moments = [0, 0.25, 0.5, 0.75, 1, 1.5, 1.9999, 2, 2.25, 2.5, 2.75, 3, 10]
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'animated.gltf')
            with open(path, 'wb') as file:
                file.write(gltf_files.animated().text())
            lines = subprocess.run([POSES, path] + [str(t) for t in moments], check=True, capture_output=True,
                                   text=True).stdout.splitlines()
        self.assertEqual(len(lines), 3 * len(moments))
        for n, line in enumerate(lines):
            got = [float(word) for word in line.split()]
            want = expected(moments[n // 3])[n % 3]
            for row in range(3):
                for column in range(4):
                    # Printed for row vectors: the transpose. The file's numbers are floats.
                    self.assertAlmostEqual(got[4 * column + row], want[row][column], delta=2e-6,
                                           msg='time %g, node %d' % (moments[n // 3], n % 3))


if __name__ == '__main__':
    unittest.main()
