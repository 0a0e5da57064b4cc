# SPDX-License-Identifier: MIT
"""The precision report's figures of raygrid alone, of few rays: test_precision.py PROGRAM. Times mean nothing."""
import json
import subprocess
import sys
import unittest

PROGRAM = sys.argv.pop(1)
KINDS = ['loose', 'uniform', 'hierarchical']


class Figures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        done = subprocess.run([PROGRAM, '--embree', 'none', '--objects', '200', '--rays', '2048', '--judged', '64'],
                              check=True, capture_output=True, text=True)
        cls.lines = [json.loads(text) for text in done.stdout.splitlines()]

    def test_every_scene_with_every_kind(self):
        scenes = list(dict.fromkeys((line['scene'], line['offset']) for line in self.lines))
        self.assertEqual(len(scenes), 9)
        self.assertEqual([line['side'] for line in self.lines], KINDS * len(scenes))

    def test_nothing_is_wrong(self):
        for line in self.lines:
            self.assertGreater(line['hits'], 0, line)
            counts = line['by the promise']
            self.assertEqual((counts['wrong'], counts['missed']), (0, 0), line)
            self.assertLessEqual(line['worst t of the promise'], 1, line)

    def test_errors_are_those_of_doubles_and_normals_those_of_floats(self):
        for line in self.lines:
            self.assertTrue(0 < line['normal ulp']['most'] < 16, line)
            if line['scene'] == 'ordinary':
                self.assertTrue(0 < line['t ulp']['median'] < 2, line)

    def test_kinds_do_not_differ(self):
        for first in range(0, len(self.lines), len(KINDS)):
            errors = [line['t ulp'] for line in self.lines[first:first + len(KINDS)]]
            self.assertEqual(errors, [errors[0]] * len(KINDS))


if __name__ == '__main__':
    unittest.main()
