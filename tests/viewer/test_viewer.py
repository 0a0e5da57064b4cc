# SPDX-License-Identifier: MIT
"""Runs the viewer without a window, by its script and its options, and looks at the pictures that it writes."""
import os
import re
import subprocess
import sys
import tempfile
import unittest

from pictures import VIEWER, Frame

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'demo'))
import gltf_files  # noqa: E402, the path is needed first

WIDTH, HEIGHT = 160, 120
GRIDS = 'loose', 'hierarchical', 'uniform'
GROUND = 821  # inserted after the 820 spheres of a flake of three generations: slot 820, and its id in a picture
MIDDLE = WIDTH // 2, HEIGHT // 2


class Viewer(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def start(self, *options):
        return subprocess.run([VIEWER, '--no-window', '--fixed', '--size', f'{WIDTH}x{HEIGHT}', *options],
                              cwd=self.folder.name, capture_output=True, text=True, timeout=60)

    def view(self, *options, frames=2, script=(), show='none'):
        """Shows a flake, or what the options say; returns the last frame."""
        self.views = getattr(self, 'views', 0) + 1
        steps, png, exr = (self.path(f'{self.views}.{end}') for end in ('steps', 'png', 'exr'))
        with open(steps, 'w', encoding='utf-8') as file:
            file.write('# steps of a test\n\n' + '\n'.join(script) + '\n')
        done = self.start('--flake', '3', '--time', '3', '--frames', str(frames), '--show', show, '--script', steps,
                          '--shot', png, '--shot', exr, *options)
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        self.said = done.stdout
        return Frame(png, exr)

    def assert_same(self, a, b):
        """The same pixels, objects and depths; not more is told than how many differ."""
        self.assertEqual(len(a.picture.changed(b.picture)), 0)
        self.assertTrue(a.light.id == b.light.id and a.light.depth == b.light.depth)

    def test_grids_alike(self):
        """Each kind of grid shows the same, moving, from the start or switched to by keys."""
        seen = [self.view('--grid', grid, frames=20) for grid in GRIDS]
        seen.append(self.view(frames=20, script=['2 key G', '4 key ]', '6 key [', '8 key R', '12 key G']))
        for frame in seen[1:]:
            self.assert_same(frame, seen[0])
        self.assertGreater(len(self.view(frames=2).picture.changed(seen[0].picture)), 500)

    def test_drag(self):
        """What is dragged stays under the mouse while all else moves as ever; let go it stays where it is."""
        held = self.view(frames=3).light.at(*MIDDLE)
        self.assertNotIn(held, (0, GROUND))
        steps = [f'2 press {MIDDLE[0]} {MIDDLE[1]}', '4 move 60 30', '5 move 40 30']
        dragged, alone = (self.view(frames=8, script=script).light for script in (steps, ()))
        self.assertEqual(dragged.at(40, 30), held)
        self.assertNotEqual(dragged.at(*MIDDLE), held)
        for now, ever, way in zip(dragged.middle_of(held), alone.middle_of(held), (40 - MIDDLE[0], 30 - MIDDLE[1])):
            self.assertAlmostEqual(now - ever, way, delta=8)
        others = [i for i in range(len(alone.id)) if held not in (alone.id[i], dragged.id[i])]
        same = sum(alone.id[i] == dragged.id[i] for i in others)
        self.assertGreater(same, 0.95 * len(others))
        released = self.view(frames=40, script=steps + ['7 release 40 30', '8 move 90 90']).light
        self.assertEqual(released.at(40, 30), held)
        self.assertNotEqual(set(released.id), set(dragged.id))

    def test_ground_stays(self):
        """The ground can't be dragged."""
        x, y = 10, HEIGHT - 5
        still = self.view('--paused', frames=6).light
        self.assertEqual(still.at(x, y), GROUND)
        pulled = self.view('--paused', frames=6, script=[f'1 press {x} {y}', '2 move 80 20', '3 release 80 20']).light
        self.assertTrue(pulled.id == still.id and pulled.depth == still.depth)

    def test_insert_and_remove(self):
        """A ball and a box appear under the mouse; removed, all is as if they had never been."""
        def put(*keys):
            return self.view('--paused', '--samples', '1', frames=9, script=['1 move 70 50', *keys])
        nothing = put()
        for key in 'I', 'B':
            shown = put(f'2 key {key}')
            self.assertEqual(shown.light.at(70, 50), GROUND + 1)
            self.assertGreater(len(shown.light.pixels_of(GROUND + 1)), 20)
            self.assertGreater(len(shown.picture.changed(nothing.picture)), 20)
            self.assert_same(put(f'2 key {key}', '5 key X'), nothing)

    def test_remove_while_it_moves(self):
        """One of the flake's own is removed in its flight, also while it is held; the others fly on."""
        gone = self.view(frames=3).light.at(*MIDDLE)
        ever = self.view(frames=12).light
        others = [i for i in range(len(ever.id)) if ever.id[i] != gone]
        for script in (['3 move 80 60', '3 key Delete'], ['2 press 80 60', '3 move 90 60', '4 key X']):
            after = self.view(frames=12, script=script).light
            self.assertEqual(after.pixels_of(gone), [])
            self.assertGreater(sum(ever.id[i] == after.id[i] for i in others), 0.99 * len(others))

    def test_overlays(self):
        """Each overlay changes just what it is about."""
        for grid in GRIDS:
            plain = self.view('--grid', grid)
            things = {i for i, slot in enumerate(plain.light.id) if slot not in (0, GROUND)}
            boxes, cells, levels, heat = (plain.picture.changed(self.view('--grid', grid, show=name).picture)
                                          for name in ('boxes', 'cells', 'levels', 'heat'))
            self.assertTrue(100 < len(boxes) < WIDTH * HEIGHT / 5, len(boxes))
            self.assertGreater(len(heat), 0.8 * WIDTH * HEIGHT)
            self.assertEqual(len((cells | levels) - things), 0)
            if grid == 'loose':  # which tells of no cells
                self.assertEqual((len(cells), len(levels)), (0, 0))
            else:
                self.assertGreater(len(levels), 0.9 * len(things))
                self.assertTrue(30 < len(cells) < 0.5 * len(things), len(cells))

    def test_overlay_keys(self):
        """Pressed once they show what the option does, pressed twice nothing."""
        plain = self.view(frames=4).picture
        for key, show in ('1', 'boxes'), ('4', 'heat'), ('H', 'help'):
            once = self.view(frames=4, script=[f'1 key {key}']).picture
            self.assertEqual(len(once.changed(self.view(frames=4, show=show).picture)), 0)
            twice = self.view(frames=4, script=[f'1 key {key}', f'2 key {key}']).picture
            self.assertEqual(len(twice.changed(plain)), 0)
            self.assertGreater(len(once.changed(plain)), 100)

    def test_text(self):
        """Text is white on what it darkens; that of heat is at the lower left."""
        plain = self.view().picture
        for show, lines in ('text', 4), ('help', 7):
            shown = self.view(show=show).picture
            changed = plain.changed(shown)
            self.assertGreater(len(changed), 1000)
            self.assertTrue(all(i // WIDTH < 17 * lines for i in changed), max(changed) // WIDTH)
            self.assertEqual(max(shown.pixels[i] for i in changed), (255, 255, 255))
        legend = self.view(show='heat').picture.changed(self.view(show='heat,legend').picture)
        self.assertGreater(len(legend), 1000)
        self.assertTrue(all(i // WIDTH > HEIGHT / 2 for i in legend))

    def test_refinement(self):
        """While nothing moves a picture comes nearer to what it is of many samples, and stops at a limit."""
        truth = self.view('--paused', frames=100).light
        errors = [self.view('--paused', frames=frames).light.error(truth) for frames in (2, 5, 20)]
        self.assertGreater(errors[0], 2 * errors[1])
        self.assertGreater(errors[1], 2 * errors[2])
        limited = [self.view('--paused', '--samples', '5', frames=frames).light.colour for frames in (6, 20)]
        self.assertTrue(limited[0] == limited[1])

    def test_pause_and_camera(self):
        """Space halts the animation; the camera stands where it is told to."""
        halted, later = (self.view(frames=frames, script=['2 key Space']).light.id for frames in (9, 30))
        self.assertTrue(halted == later)
        self.assertFalse(halted == self.view(frames=9).light.id)
        self.assertFalse(self.view('--paused', '--eye', '2,1,3').light.id == self.view('--paused').light.id)

    def test_field(self):
        """A share of a field moves, the others rest; the report tells the frames a second."""
        field = ['--spheres', '400', '--moving', '0.1', '--seed', '5', '--report']
        now, later = (self.view(*field, frames=frames).light for frames in (2, 12))
        changed = {slot for a, b in zip(now.id, later.id) if a != b for slot in (a, b)} - {0}
        self.assertGreater(len(changed), 5)
        still = {slot for slot in set(now.id) if now.pixels_of(slot) == later.pixels_of(slot)} - {0}
        self.assertGreater(len(still), 100)
        self.assertRegex(self.said, r'11 frames of 160x120, \d+ workers: \d+\.\d frames/s; median .* load average')

    def test_gltf(self):
        """A file is shown and its parts can be dragged; one that is not there is told of."""
        cube = self.path('a cube.glb')
        with open(cube, 'wb') as file:
            file.write(gltf_files.cube().binary())
        light = self.view(cube).light
        self.assertEqual(set(light.id), {0, 1, 2})
        x, y = (round(v) for v in light.middle_of(1))
        dragged = self.view(cube, frames=6, script=[f'1 press {x} {y}', f'3 move {x - 30} {y}']).light
        self.assertAlmostEqual(dragged.middle_of(1)[0], x - 30, delta=8)
        broken = self.start('--frames', '1', self.path('none.glb'))
        self.assertEqual(broken.returncode, 1)
        self.assertIn('none.glb', broken.stderr)

    def test_bad_input(self):
        """Command lines and files that can't be used: one line that says why, and the exit code."""
        bad_script = self.path('bad')
        with open(bad_script, 'w', encoding='utf-8') as file:
            file.write('0 key Space\n1 dance\n')
        for code, words, options in ((2, '--show', ['--show', 'all']), (2, '--eye', ['--eye', '1,2']),
                                     (2, '--frames', ['--shot', 'x.png']), (2, '--moving', ['--moving', '1.5']),
                                     (2, '--grid', ['--grid', 'best', '--frames', '1']),
                                     (1, 'line 2', ['--script', bad_script, '--frames', '1']),
                                     (1, 'font', ['--font', self.path('none.ttf'), '--frames', '1']),
                                     (1, 'nowhere', ['--shot', self.path('nowhere/a.png'), '--frames', '1'])):
            done = self.start(*options)
            self.assertEqual(done.returncode, code, (options, done.stderr))
            self.assertRegex(done.stderr, r'^raygrid-viewer: [^\n]*' + re.escape(words) + r'[^\n]*\n$')


if __name__ == '__main__':
    unittest.main()
