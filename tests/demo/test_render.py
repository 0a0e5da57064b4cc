# SPDX-License-Identifier: MIT
"""Runs the demo on small pictures and reads back all that it wrote and said."""
import json
import math
import os
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import gltf_files

DEMO, DUMP = sys.argv[1:3]
del sys.argv[1:3]
SIZE = 64


def png_pixels(path):
    """Width, height and the rows of an 8-bit RGB PNG without interlace, checksums verified."""
    with open(path, 'rb') as file:
        data = file.read()
    assert data[:8] == b'\x89PNG\r\n\x1a\n'
    at, packed, header = 8, b'', None
    while at < len(data):
        length, kind = struct.unpack_from('>I4s', data, at)
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack_from('>I', data, at + 8 + length)[0]
        if kind == b'IHDR':
            header = struct.unpack('>IIBBBBB', body)
        if kind == b'IDAT':
            packed += body
        at += 12 + length
    assert header[2:4] == (8, 2)
    return header[0], header[1], zlib.decompress(packed)


class Render(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def save(self, name, data):
        with open(self.path(name), 'wb') as file:
            file.write(data)
        return self.path(name)

    def run_demo(self, gltf, out, *more, frames=2):
        arguments = [DEMO, '--gltf', gltf, '--frames', str(frames), '--size', '%dx%d' % (SIZE, SIZE), '--out',
                     self.path(out), '--samples', '1', '--sample', '400', *more]
        done = subprocess.run(arguments, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def dump(self, out, frame):
        name = os.path.join(self.path(out), 'frame-%04d.exr' % frame)
        return json.loads(subprocess.run([DUMP, name], check=True, capture_output=True, text=True).stdout)

    def check_frame(self, picture):
        self.assertEqual((picture['width'], picture['height']), (SIZE, SIZE))
        self.assertEqual(picture['compression'], 3)  # ZIP
        channels = picture['channels']
        self.assertEqual({name: channel['type'] for name, channel in channels.items()},
                         {'R': 'half', 'G': 'half', 'B': 'half', 'Z': 'float', 'id': 'uint'})
        ids, depths = channels['id']['values'], channels['Z']['values']
        hits = sum(1 for i in ids if i != 0)
        self.assertGreater(hits, SIZE * SIZE / 2)
        self.assertLess(hits, SIZE * SIZE)
        self.assertGreater(len(set(ids)), 50)
        for i, depth in zip(ids, depths):
            self.assertEqual(i == 0, depth == math.inf)
            self.assertGreater(depth, 0)
        nearest_to_middle = depths[(SIZE // 2) * SIZE + SIZE // 2]
        self.assertTrue(2 < nearest_to_middle < 12, nearest_to_middle)
        colours = [x for name in 'RGB' for x in channels[name]['values']]
        self.assertTrue(all(0 <= x < 100 for x in colours))
        self.assertGreater(max(colours) - min(colours), 0.3)

    def check_table(self, text, frames):
        rows = [line.split() for line in text.splitlines() if re.match(r' *\d+ ', line)]
        self.assertEqual(len(rows), frames)
        for number, row in enumerate(rows):
            self.assertEqual(len(row), 13, row)
            self.assertEqual(int(row[0]), number)
            self.assertEqual(int(row[10]), 400)
            self.assertEqual(int(row[11]), 0)
            self.assertTrue(0 <= float(row[12]) < 1e-9)
            self.assertTrue(all(float(x) > 0 for x in row[4:8]))
        self.assertIn('against brute force: %d rays checked, 0 wrong hits' % (400 * frames), text)
        return rows

    def test_frames(self):
        """Pictures and table, for each kind of grid; the pictures are the same to the last bit."""
        gltf = self.save('animated.gltf', gltf_files.animated().text())
        pictures = []
        for grid in 'uniform', 'hierarchical':
            text = self.run_demo(gltf, grid, '--grid', grid)
            rows = self.check_table(text, 2)
            objects = 2500 + 1500 + 3 + 1
            self.assertEqual([rows[0][1], rows[0][2], rows[0][3]], [str(objects), str(objects), '0'])
            self.assertEqual([rows[1][1], rows[1][2], rows[1][3]], [str(objects), '80', '80'])
            for frame in range(2):
                self.check_frame(self.dump(grid, frame))
            pictures.append([self.dump(grid, frame) for frame in range(2)])
        self.assertEqual(pictures[0], pictures[1])
        self.assertNotEqual(pictures[0][0], pictures[0][1])

    def test_workers(self):
        """One worker or three: the same pictures."""
        gltf = self.save('cube.glb', gltf_files.cube().binary())
        self.run_demo(gltf, 'one', '--workers', '1')
        self.run_demo(gltf, 'three', '--workers', '3')
        self.assertEqual(self.dump('one', 1), self.dump('three', 1))

    def test_contact_sheet(self):
        gltf = self.save('cube.glb', gltf_files.cube(gltf_files.UBYTE).binary())
        self.run_demo(gltf, 'out', '--stills', frames=8)
        width, height, rows = png_pixels(os.path.join(self.path('out'), 'contact.png'))
        self.assertEqual((width, height), (6 * (SIZE + 4) + 4, 2 * (SIZE + 4) + 4))
        self.assertEqual(len(rows), height * (3 * width + 1))
        self.assertGreater(len(set(rows)), 100)
        still = os.path.join(self.path('out'), 'frame-0007.png')
        self.assertEqual(png_pixels(still)[:2], (SIZE, SIZE))

    def test_objects_leave_the_box(self):
        """Over many frames the swarm spreads over tiles of the grid and makes it rebuild, and nothing is wrong."""
        gltf = self.save('cube.gltf', gltf_files.cube(gltf_files.UINT).text())
        rows = self.check_table(self.run_demo(gltf, 'out', '--grid', 'hierarchical', frames=60), 60)
        self.assertGreater(max(int(row[9]) for row in rows), 1)
        self.assertGreater(int(rows[-1][8]), 0)

    def test_animation_moves(self):
        """The same scene with and without its animations: alike at their start, not later."""
        moving = gltf_files.cube()
        moving.animate(0, 'translation', [0, 1], [(0, 0, 0), (6, 0, 0)])
        bare = ['--spheres', '0', '--boxes', '0']
        self.run_demo(self.save('moving.gltf', moving.text()), 'moving', *bare)
        self.run_demo(self.save('still.gltf', gltf_files.cube().text()), 'still', *bare)
        self.assertEqual(self.dump('moving', 0), self.dump('still', 0))
        seen = [self.dump(out, 1)['channels']['id']['values'] for out in ('moving', 'still')]
        self.assertEqual(set(seen[1]), {0, 1, 2})
        self.assertNotEqual(seen[0], seen[1])

    def test_vanishing_part(self):
        """A scale of 0 has no inverse: the part leaves the scene for that time, with a note, and comes back."""
        document = gltf_files.cube()
        document.node(mesh=0, translation=[4, 0, 0])
        document.animate(0, 'scale', [0, 1, 2], [(0, 0, 0), (1, 1, 1), (1, 0, 1)])
        gltf = self.save('vanish.gltf', document.text())
        rows = self.check_table(self.run_demo(gltf, 'out', '--spheres', '0', '--boxes', '0', frames=4), 4)
        self.assertEqual([row[1] for row in rows], ['2', '3', '3', '3'])

    def test_default_input(self):
        """The engine of the README, where Debian's assimp-testmodels is installed."""
        usage = subprocess.run([DEMO, '--help'], check=True, capture_output=True, text=True).stdout
        engine = re.search(r'--gltf FILE .*\((.*)\)', usage).group(1)
        if not os.path.exists(engine):
            self.skipTest(engine + ' is not there')
        text = self.run_demo(engine, 'out')
        self.check_frame(self.dump('out', 0))
        self.assertEqual(self.check_table(text, 2)[0][1], str(2500 + 1500 + 115 + 1))


if __name__ == '__main__':
    unittest.main()
