# SPDX-License-Identifier: MIT
"""Pictures that the viewer has written, read back."""
import functools
import json
import os
import subprocess
import sys

VIEWER, EXR_DUMP, PNG_DUMP = map(os.path.abspath, sys.argv[1:4])
del sys.argv[1:4]


class Picture:
    """Pixels as a screen has them: R, G, B from 0 to 255, row by row."""

    def __init__(self, width, height, data):
        self.width, self.height = width, height
        self.pixels = [tuple(data[i:i + 3]) for i in range(0, 3 * width * height, 3)]

    def changed(self, other):
        """The numbers of the pixels that differ."""
        assert (self.width, self.height) == (other.width, other.height)
        return {i for i, (a, b) in enumerate(zip(self.pixels, other.pixels)) if a != b}

    def difference(self, other):
        """The mean of how far apart the values are, in steps of a screen."""
        assert (self.width, self.height) == (other.width, other.height)
        return sum(abs(a - b) for p, q in zip(self.pixels, other.pixels)
                   for a, b in zip(p, q)) / (3 * len(self.pixels))


def read_png(path):
    data = subprocess.run([PNG_DUMP, path], check=True, capture_output=True).stdout
    kind, size, _, pixels = data.split(b'\n', 3)
    assert kind == b'P6'
    width, height = map(int, size.split())
    return Picture(width, height, pixels)


class Light:
    """What an EXR holds: `id` (slot + 1, or 0) and `depth` of each pixel, `colour` as (R, G, B)."""

    def __init__(self, path):
        dump = json.loads(subprocess.run([EXR_DUMP, path], check=True, capture_output=True, text=True).stdout)
        channels = {name: channel['values'] for name, channel in dump['channels'].items()}
        self.width, self.height = dump['width'], dump['height']
        self.id, self.depth = channels['id'], channels['Z']
        self.colour = list(zip(channels['R'], channels['G'], channels['B']))

    def at(self, x, y):
        return self.id[y * self.width + x]

    def pixels_of(self, identity):
        return [i for i, other in enumerate(self.id) if other == identity]

    def middle_of(self, identity):
        """The mean x and y of the pixels of an object."""
        pixels = self.pixels_of(identity)
        return (sum(i % self.width for i in pixels) / len(pixels), sum(i // self.width for i in pixels) / len(pixels))

    def error(self, truth):
        """The mean square of how far apart the light is."""
        return sum((a - b) ** 2 for p, q in zip(self.colour, truth.colour) for a, b in zip(p, q)) / len(self.colour)


class Frame:
    """A frame that was written both ways; what is not asked for is not read."""

    def __init__(self, png, exr):
        self.png, self.exr = png, exr

    @functools.cached_property
    def picture(self):
        return read_png(self.png)

    @functools.cached_property
    def light(self):
        return Light(self.exr)
