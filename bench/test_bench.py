# SPDX-License-Identifier: MIT
"""Runs the benchmark as shortly as it can be run: test_bench.py PROGRAM. What it measures then means nothing; how it
reports does, and that its error columns notice a wrong answer."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

import table

PROGRAM = sys.argv.pop(1)

NUMBER = (int, float)
OPTIONAL = (int, float, type(None))
KEYS = {
    'name': str,
    'figure': NUMBER,
    'unit': str,
    'peer_figure': OPTIONAL,
    'ratio': OPTIONAL,
    'goal': OPTIONAL,
    'goal_on': (str, type(None)),
    'reached': (bool, type(None)),
    'checked': (int, type(None)),
    'wrong': (int, type(None)),
    'worst_t_error': OPTIONAL,
    'peer_checked': (int, type(None)),
    'peer_wrong': (int, type(None)),
    'peer_worst_t_error': OPTIONAL,
    'spread': (dict, type(None)),
    'bytes_per_object': OPTIONAL,
    'peer_bytes_per_object': OPTIONAL,
    'threads': int,
    'isa': str,
    'peer_way': (str, type(None)),
    'versions': dict,
}
SECTIONS = {'builds', 'traces', 'meshes', 'updates', 'frames', 'lasting', 'threads', 'omissions', 'latency'}


def run(*more):
    """The exit code, the JSON lines, and what was printed."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, 'bench.json')
        done = subprocess.run([PROGRAM, '--selftest', '--json', path, *more], capture_output=True, text=True)
        with open(path, encoding='utf-8') as file:
            return done.returncode, [json.loads(line) for line in file], done.stdout


class Lines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.code, cls.lines, cls.text = run()

    def test_nothing_is_wrong(self):
        self.assertEqual(self.code, 0, self.text)
        self.assertEqual(sum(line['wrong'] or 0 for line in self.lines), 0)

    def test_schema(self):
        for line in self.lines:
            self.assertEqual(set(line), set(KEYS), line['name'])
            for key, kind in KEYS.items():
                self.assertIsInstance(line[key], kind, (line['name'], key))
            self.assertEqual(set(line['versions']), {'raygrid', 'peer', 'compiler'})

    def test_every_section_speaks(self):
        self.assertEqual({line['name'].split('/')[0] for line in self.lines}, SECTIONS)
        self.assertEqual(len({line['name'] for line in self.lines}), len(self.lines))

    def test_figures_make_sense(self):
        for line in self.lines:
            self.assertGreater(line['figure'], 0, line['name'])
            if line['checked'] is not None:
                self.assertGreater(line['checked'], 0, line['name'])
                self.assertLess(line['worst_t_error'], 1e-6, line['name'])

    def test_rays_have_errors_beside_them(self):
        for line in self.lines:
            if line['unit'] == 'Mrays/s':
                self.assertIsNotNone(line['checked'], line['name'])

    def test_goals_are_held_against_what_they_are_about(self):
        for line in self.lines:
            if line['reached'] is None:
                continue
            on_ratio = line['goal_on'].startswith('ratio')
            got = line['ratio'] if on_ratio else line['figure']
            self.assertEqual(line['reached'], got >= line['goal'] if on_ratio else got <= line['goal'], line['name'])

    def test_table_has_every_line(self):
        text = table.markdown(self.lines)
        for line in self.lines:
            self.assertIn('| ' + line['name'].split('/', 1)[1] + ' |', text)


class Spoilt(unittest.TestCase):
    """Every answer of raygrid is made wrong before it is judged."""

    def test_each_is_noticed(self):
        code, lines, text = run('--embree', 'none', '--spoil')
        self.assertEqual(code, 1, text)
        judged = [line for line in lines if line['checked']]
        self.assertTrue(judged)
        for line in judged:
            self.assertEqual(line['wrong'], line['checked'], line['name'])

    def test_other_options_are_refused(self):
        done = subprocess.run([PROGRAM, '--nonsense'], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn('usage', done.stderr)


if __name__ == '__main__':
    unittest.main()
