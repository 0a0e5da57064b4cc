# SPDX-License-Identifier: MIT
"""The evaluation's figures of raygrid alone, of tiny scenes and pictures: test_evaluation.py PROGRAM. Times mean
nothing; that every experiment speaks, that no answer is wrong and that wrong ones are noticed does."""
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import tables

PROGRAM = sys.argv.pop(1)
FOLDER = pathlib.Path(__file__).resolve().parent
COMMON = {'scene': str, 'objects': int}
ROUND = {**COMMON, 'side': str, 'resolution': (int, type(None)), 'primary ms': float, 'shadow ms': float,
         'frames a second': float, 'cells a ray': float, 'tests a ray': float, 'updates a second': float,
         'update ns': float, 'single update ns': float, 'tiles': int, 'entries an object': float,
         'bytes an object': float, 'primary': dict, 'shadow': dict, 'moved': dict}
SCHEMA = {
    'resolutions': ROUND,
    'counts': ROUND,
    'shows': {**COMMON, 'kind': str, 'manner': str, 'threads': int, 'runs': int, 'ms': list, 'update ms': list,
              'processor ms': list, 'rebuilding': list, 'rebuilt': list, 'tiles': list, 'judged': dict},
    'sizes': {**COMMON, 'kind': str, 'resolution': int, 'size': float, 'insert ns': float, 'remove ns': float,
              'judged': dict},
    'goal': {**COMMON, 'threads': int, 'frames': int, 'median ms': float, 'best ms': float, 'processor ms': float,
             'frames a second': float, 'primary': dict, 'shadow': dict},
}


def run(*more):
    done = subprocess.run([PROGRAM, '--selftest', '--embree', 'none', *more], capture_output=True, text=True)
    return done.returncode, json.loads(done.stdout), done.stderr


def verdicts(report):
    """Each with where it is from."""
    for name in SCHEMA:
        for record in report[name]:
            for key in tables.VERDICTS:
                if key in record:
                    yield (name, record['scene'], record.get('side', record.get('kind')), key), record[key]


class Figures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.code, cls.report, cls.messages = run()

    def test_nothing_is_wrong(self):
        self.assertEqual(self.code, 0, self.messages)
        for where, verdict in verdicts(self.report):
            self.assertGreater(verdict['checked'], 0, where)
            self.assertEqual(verdict['wrong'], 0, where)

    def test_schema(self):
        self.assertEqual(set(self.report), {'run', *SCHEMA})
        for name, schema in SCHEMA.items():
            self.assertTrue(self.report[name], name)
            for record in self.report[name]:
                self.assertEqual(set(record), set(schema), name)
                for key, kind in schema.items():
                    self.assertIsInstance(record[key], kind, (name, key))

    def test_tiles_are_where_they_should_be(self):
        expected = {'uniform': 1, 'hierarchical': 1, 'uniform, tiles': 2, 'uniform, eight tiles': 8}
        for record in self.report['resolutions']:
            if record['side'] in expected and record['scene'] != 'engine':  # whose parts fill no octants
                self.assertEqual(record['tiles'], expected[record['side']], record)

    def test_shows_are_rebuilt_as_they_should_be(self):
        for show in self.report['shows']:
            busy = [tables.busy(show, i) for i in range(len(show['ms']))]
            if show['kind'] != 'loose':
                self.assertEqual(any(busy), show['manner'] != 'never rebuilt', show)
            if show['manner'] == 'never rebuilt':
                self.assertGreater(show['tiles'][-1], 8, show)

    def test_large_objects_are_listed_in_many_cells_by_the_uniform_grid_alone(self):
        entries = {(r['side'], r['resolution']): r['entries an object']
                   for r in self.report['resolutions'] if r['scene'] == 'flake'}
        self.assertGreater(entries['uniform', 16], 1.5 * entries['uniform', 8])
        self.assertLessEqual(entries['hierarchical', 16], 8)

    def test_tables_have_every_scene(self):
        text = tables.markdown(self.report)
        for scene in ('flake', 'crowd', 'equal'):
            self.assertIn(f'| {scene} |', text)

    @unittest.skipUnless(importlib.util.find_spec('matplotlib'), 'no matplotlib here: script/evaluation fetches it')
    def test_page_and_plots(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / 'figures.json').write_text(json.dumps(self.report), encoding='utf-8')
            page = folder / 'evaluation.md'
            page.write_text('a\n<!-- figures: made by script/evaluation -->\nold\n<!-- end of figures -->\nz\n')
            subprocess.run([sys.executable, FOLDER / 'report.py', folder / 'figures.json', page, folder / 'plots'],
                           check=True)
            text = page.read_text(encoding='utf-8')
            self.assertTrue(text.startswith('a\n') and text.endswith('z\n') and 'old' not in text)
            for plot in ('resolutions', 'shows', 'sizes', 'counts'):
                for kind in ('svg', 'png'):
                    self.assertTrue((folder / 'plots' / f'{plot}.{kind}').stat().st_size, plot)


class Spoilt(unittest.TestCase):
    """Every answer of raygrid is made wrong before it is judged."""

    def test_each_is_noticed(self):
        code, report, messages = run('--spoil', '--only', 'counts')
        self.assertEqual(code, 1, messages)
        for where, verdict in verdicts(report):
            self.assertEqual(verdict['wrong'], verdict['checked'], where)

    def test_other_options_are_refused(self):
        done = subprocess.run([PROGRAM, '--nonsense'], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn('usage', done.stderr)


if __name__ == '__main__':
    unittest.main()
