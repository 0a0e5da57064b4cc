# SPDX-License-Identifier: MIT
"""Runs the benchmark as shortly as it can be run: test_bench.py PROGRAM. What it measures then means nothing; how it
reports does, and that its error columns notice a wrong answer."""
import base64
import json
import os
import struct
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

    def test_meshes_deform(self):
        deformed = [line for line in self.lines if line['name'].startswith('frames/')
                    and line['name'].endswith('/new vertices')]
        self.assertGreaterEqual({line['name'].split('/')[1] for line in deformed}, {'noisy', 'soup'})
        for line in deformed:
            self.assertIsNotNone(line['checked'], line['name'])
            self.assertIsNone(line['goal'], line['name'])

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


class Instances(unittest.TestCase):
    """Of one mesh: what their goals are, by their number."""

    @classmethod
    def setUpClass(cls):
        _, lines, _ = run('--embree', 'none', '--only', 'traces,updates', '--scene', 'meshes', '--mode', 'batch',
                          '--size', '100,1000,10000,100000')
        cls.goals = {line['name']: (line['goal'], line['goal_on']) for line in lines}

    def test_few_have_no_goals(self):
        few = [goal for name, goal in self.goals.items() if '/100/' in name]
        self.assertTrue(few)
        self.assertEqual(set(few), {(None, None)})

    def test_rays(self):
        for size, incoherent in (1000, 1.5), (10000, 2), (100000, 2.5):
            for rays, goal in ('primary', 2), ('shadow', 2), ('random', incoherent), ('random any', incoherent):
                self.assertEqual(self.goals[f'traces/meshes/{size}/{rays}/batch'], (goal, 'ratio, at least'))

    def test_moves(self):
        for size, goal in (10000, 100), (100000, 500):
            for step in 0.1, 1:
                name = f'updates/meshes/{size}/move 1 % by {step} r'
                self.assertEqual(self.goals[name], (goal, 'ratio, at least'))


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


def write_gltf(path, corners):
    """Two triangles with a side in common, or others of their corners."""
    positions = struct.pack('<12f', 0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 1)
    data = positions + struct.pack(f'<{len(corners)}I', *corners)
    views = [{'buffer': 0, 'byteOffset': 0, 'byteLength': 48},
             {'buffer': 0, 'byteOffset': 48, 'byteLength': len(data) - 48}]
    accessors = [
        {'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'VEC3', 'min': [0, 0, 0], 'max': [2, 2, 1]},
        {'bufferView': 1, 'componentType': 5125, 'count': len(corners), 'type': 'SCALAR'}]
    uri = 'data:application/octet-stream;base64,' + base64.b64encode(data).decode()
    with open(path, 'w', encoding='utf-8') as file:
        json.dump({'asset': {'version': '2.0'}, 'buffers': [{'uri': uri, 'byteLength': len(data)}],
                   'bufferViews': views, 'accessors': accessors, 'scene': 0, 'scenes': [{'nodes': [0, 1]}],
                   'nodes': [{'mesh': 0}, {'mesh': 0, 'translation': [0, 0, 1]}],
                   'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1}]}]}, file)


class Models(unittest.TestCase):
    """Files that are shown as one mesh."""

    def setUp(self):
        if subprocess.run([PROGRAM, '--model', 'any.glb', '--help'], capture_output=True).returncode != 0:
            self.skipTest('built without glTF')
        folder = tempfile.TemporaryDirectory(prefix='with space ')
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, 'two sheets.v1.gltf')

    def run_on_file(self, corners):
        write_gltf(self.path, corners)
        return run('--embree', 'none', '--model', self.path, '--scene', 'two sheets.v1')

    def test_all_parts_are_one_mesh_of_the_name_of_the_file(self):
        code, lines, text = self.run_on_file([0, 1, 2, 0, 2, 3])
        self.assertEqual(code, 0, text)
        self.assertEqual({line['name'].split('/')[0] for line in lines}, {'traces', 'meshes', 'frames'})
        self.assertEqual({tuple(line['name'].split('/')[1:3]) for line in lines}, {('two sheets.v1', '4')})
        self.assertEqual(sum(line['wrong'] or 0 for line in lines), 0)

    def test_corners_that_are_no_vertices_are_refused(self):
        write_gltf(self.path, [0, 1, 4])
        done = subprocess.run([PROGRAM, '--selftest', '--model', self.path, '--scene', 'two sheets.v1'],
                              capture_output=True, text=True)
        self.assertIn('two sheets.v1.gltf: has an index without a vertex', done.stderr)

    def test_names_of_other_scenes_are_refused(self):
        for name in 'noisy.glb', 'gltf.gltf', 'folder/2CylinderEngine.glb':
            done = subprocess.run([PROGRAM, '--selftest', '--model', name], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2, name)
            self.assertIn('already', done.stderr)


if __name__ == '__main__':
    unittest.main()
