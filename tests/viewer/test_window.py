# SPDX-License-Identifier: MIT
"""Runs the viewer in a window on a screen of Xvfb's, with a mouse and keys of xdotool's, as a user would."""
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest

from pictures import VIEWER, Light, Picture, read_png

WIDTH, HEIGHT = 200, 160
GROUND = 821  # its id in a picture, after the 820 spheres of a flake of three generations
LEAKS = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'leaks.txt')
PATIENCE = 60  # seconds for what takes a fraction of one


class Screen:
    """An X server without hardware; `shot` is what is on it."""

    def __init__(self, folder):
        self.folder = folder
        ours, theirs = os.pipe()
        # It begins anew when its last client leaves, as each run of xdotool does: not here.
        command = ['Xvfb', '-displayfd', str(theirs), '-screen', '0', '400x300x24', '-nolisten', 'tcp', '-noreset',
                   '-fbdir', folder]
        self.server = subprocess.Popen(command, pass_fds=[theirs], stderr=subprocess.DEVNULL)
        os.close(theirs)
        with open(ours, encoding='ascii') as line:
            number = line.readline()  # to its end, which Xvfb writes on its own
        if not number:
            self.close()
            raise RuntimeError('Xvfb does not start')
        self.environment = {**os.environ, 'DISPLAY': ':' + number.strip(), 'SDL_VIDEODRIVER': 'x11',
                            'LSAN_OPTIONS': f'suppressions="{LEAKS}":print_suppressions=0'}

    def close(self):
        self.server.terminate()
        self.server.wait(PATIENCE)

    def shot(self, left, top, width, height):
        """A part of the screen, from the file in X's window dump format that Xvfb keeps."""
        with open(os.path.join(self.folder, 'Xvfb_screen0'), 'rb') as file:
            data = file.read()
        words = struct.unpack('>25I', data[:100])
        header, stride, colours = words[0], words[12], words[19]
        assert words[11] == 32 and words[7] == 0, 'four bytes a pixel, the lowest first'
        first = header + 12 * colours
        rows = [data[first + y * stride + 4 * left:first + y * stride + 4 * (left + width)]
                for y in range(top, top + height)]
        return Picture(width, height, bytes(row[4 * x + c] for row in rows for x in range(width) for c in (2, 1, 0)))


@unittest.skipUnless(shutil.which('Xvfb') and shutil.which('xdotool'), 'Xvfb and xdotool are not there')
class Window(unittest.TestCase):
    usual = '--flake', '3', '--size', f'{WIDTH}x{HEIGHT}', '--show', 'none'

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.screen = Screen(self.folder.name)
        self.addCleanup(self.screen.close)
        self.shots = 0

    def open(self, *options):
        self.viewer = subprocess.Popen([VIEWER, *self.usual, *options], env=self.screen.environment,
                                       cwd=self.folder.name, stdout=subprocess.PIPE, text=True, bufsize=1)
        self.addCleanup(self.end)
        self.window = self.find()
        self.tool('windowfocus', '--sync', self.window)

    def find(self):
        """The window, once it is there. xdotool fails if it looks at one that vanishes meanwhile."""
        until = time.monotonic() + PATIENCE
        while self.viewer.poll() is None and time.monotonic() < until:
            found = subprocess.run(['xdotool', 'search', '--onlyvisible', '--name', '^raygrid viewer$'],
                                   env=self.screen.environment, capture_output=True, text=True, timeout=PATIENCE)
            if found.returncode == 0:
                return found.stdout.split()[0]
            time.sleep(0.02)
        self.fail('no window')

    def end(self):
        if self.viewer.poll() is None:
            self.viewer.kill()
        self.viewer.wait(PATIENCE)
        self.viewer.stdout.close()

    def tool(self, *words):
        return subprocess.run(['xdotool', *map(str, words)], env=self.screen.environment, check=True,
                              capture_output=True, text=True, timeout=PATIENCE).stdout

    def key(self, name):
        self.tool('key', name)

    def mouse(self, x, y, *more):
        self.tool('mousemove', '--window', self.window, x, y, *more)

    def save(self, key):
        """Presses the key that saves, waits for the file, reads it. What was done before is on it."""
        self.key(key)
        extension = {'p': 'png', 'o': 'exr'}[key]
        name = f'raygrid-{self.shots:04}.{extension}'
        self.shots += 1
        self.assertEqual(self.viewer.stdout.readline(), f'wrote {name}\n')
        path = os.path.join(self.folder.name, name)
        return read_png(path) if key == 'p' else Light(path)

    def on_screen(self):
        place = dict(line.split('=') for line in self.tool('getwindowgeometry', '--shell', self.window).split())
        return self.screen.shot(int(place['X']), int(place['Y']), WIDTH, HEIGHT)

    def close(self):
        self.key('Escape')
        self.assertEqual(self.viewer.wait(PATIENCE), 0)

    def test_picture(self):
        """What is on the screen is what the viewer saves, and what it draws without a window."""
        still = ['--paused', '--time', '3', '--samples', '6', '--grid', 'hierarchical']
        self.open(*still)
        self.save('p')
        while self.save('p').difference(self.on_screen()) > 0:  # until it has gathered its samples
            pass
        alone = os.path.join(self.folder.name, 'alone.png')
        command = [VIEWER, *self.usual, *still, '--no-window', '--frames', '12', '--shot', alone]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, timeout=PATIENCE)
        shown, expected = self.on_screen(), read_png(alone)
        self.assertLess(shown.difference(expected), 0.5)
        self.key('4')  # the heat is nothing like it
        self.assertGreater(self.save('p').difference(expected), 20)
        self.key('4')
        self.key('g')
        self.save('p')
        self.close()

    def test_drag(self):
        """A ball is put into the flake in its flight, dragged by the mouse, and removed."""
        self.open('--time', '2')
        self.mouse(60, 80)
        self.key('i')
        before = self.save('o')
        ball = GROUND + 1
        self.assertEqual(before.at(60, 80), ball)
        self.mouse(60, 80, 'mousedown', 1, 'mousemove', '--window', self.window, 100, 60,
                   'mousemove', '--window', self.window, 130, 40, 'mouseup', 1)
        after = self.save('o')
        self.assertEqual(after.at(130, 40), ball)
        for now, then, way in zip(after.middle_of(ball), before.middle_of(ball), (70, -40)):
            self.assertAlmostEqual(now - then, way, delta=8)
        # All else went on moving meanwhile.
        self.assertGreater(sum(a != b and ball not in (a, b) for a, b in zip(before.id, after.id)), 200)
        self.key('x')
        self.assertEqual(self.save('o').pixels_of(ball), [])
        self.close()

    def test_flight(self):
        """Keys fly the camera and the right button turns it, as long as they are held; home brings it back."""
        self.open('--paused', '--time', '3')
        at_home = self.save('o')
        self.tool('keydown', 'w')
        while self.save('o').id == at_home.id:
            pass
        self.tool('keyup', 'w')
        self.key('Home')
        self.assertTrue(self.save('o').id == at_home.id)
        self.mouse(100, 80, 'mousedown', 3, 'mousemove', '--window', self.window, 110, 80, 'mouseup', 3)
        turned = self.save('o')
        self.assertFalse(turned.id == at_home.id)
        # Ten pixels of the mouse are 0.04 radians, so that many pixels of the picture (38 degrees are its height).
        way = 0.04 * HEIGHT / (2 * 0.3443)
        largest = max(set(at_home.id) - {0, GROUND}, key=at_home.id.count)
        self.assertAlmostEqual(at_home.middle_of(largest)[0] - turned.middle_of(largest)[0], way, delta=3)
        self.close()

    def test_resize_and_close(self):
        """A window of another size has a picture of that size; closed by whoever manages windows, it ends well."""
        self.open('--paused')
        self.save('o')
        self.tool('windowsize', '--sync', self.window, 240, 180)
        while True:
            light = self.save('o')
            if (light.width, light.height) == (240, 180):
                break
        self.assertGreater(len(set(light.id)), 100)
        self.viewer.terminate()  # which SDL turns into the event that a closed window is
        self.assertEqual(self.viewer.wait(PATIENCE), 0)


if __name__ == '__main__':
    unittest.main()
