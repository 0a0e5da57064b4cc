# SPDX-License-Identifier: MIT
"""Feeds the demo broken glTF files: each must end with exit code 1 and one line that names the file and the fault."""
import json
import os
import random
import struct
import subprocess
import sys
import tempfile
import unittest

import gltf_files
from gltf_files import FLOAT, UINT, cube

DEMO = sys.argv.pop(1)
ASSIMP = '/usr/share/assimp/models/glTF2'


def changed(*path, value):
    """A cube's file with one place of its JSON set to something else."""
    document = cube()
    place = document.json
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] = value
    return document.text()


def with_node(**properties):
    document = cube()
    document.node(**properties)
    return document.text()


def with_sparse(**sparse):
    document = cube()
    places = document.view(struct.pack('<2H', 1, 99))
    values = document.view(struct.pack('<6f', *range(6)))
    document.json['accessors'][0]['sparse'] = {
        'count': 2, 'indices': {'bufferView': places, 'componentType': 5123}, 'values': {'bufferView': values},
        **sparse}
    return document.text()


def with_corner(*corner):
    document = gltf_files.Document()
    corners = [corner] + gltf_files.CUBE_CORNERS[1:]
    document.node(mesh=document.mesh(corners, gltf_files.CUBE_TRIANGLES))
    return document.text()


def with_animation(times=(0, 1), values=((0, 0, 0), (1, 1, 1)), path='translation', interpolation='LINEAR', **target):
    document = cube()
    document.animate(0, path, list(times), values, interpolation)
    document.json['animations'][0]['channels'][0]['target'].update(target)
    return document.text()


def with_chunk(at, value):
    data = bytearray(cube().binary())
    struct.pack_into('<I', data, at, value)
    return bytes(data)


def nested(depth, opening, closing):
    text = cube().text().decode()
    return (text[:-1] + ', "extras": ' + opening * depth + '1' + closing * depth + '}').encode()


VIEW, ACCESSOR, PRIMITIVE = ('bufferViews', 0), ('accessors', 0), ('meshes', 0, 'primitives', 0)
LOOP = [{'children': [1]}, {'children': [2], 'mesh': 0}, {'children': [1]}]

# name: (the file, a part of what must be said about it)
BROKEN = {
    'empty': (b'', 'is empty'),
    'text': (b'not a model', 'JSON'),
    'noise': (random.Random(7).randbytes(5000), 'JSON'),
    'no-asset': (b'{}', 'asset'),
    'array': (b'[]', 'object'),
    'cut': (cube().text()[:-40], 'JSON'),
    'duplicate-key': (b'{"asset": {"version": "2.0", "version": "2.0"}}', 'duplicate'),
    'deep-extras': (nested(100000, '[', ']'), 'depth'),
    'deep-objects': (nested(100000, '{"a":', '}'), 'depth'),
    'huge-number': (cube().text().replace(b'"count": 8', b'"count": 1e999'), 'JSON'),
    'version-1': (changed('asset', 'version', value='1.0'), "version '1.0'"),
    'glb-header': (cube().binary()[:15], 'header'),
    'glb-version': (with_chunk(4, 1), 'version 1'),
    'glb-cut': (cube().binary()[:-4], 'cut short'),
    'glb-json-length': (with_chunk(12, 0xFFFFFFF0), 'cut short'),
    'glb-json-empty': (with_chunk(12, 0), 'JSON'),
    'glb-chunk-kind': (with_chunk(16, 0), 'JSON'),
    'extension': (changed('extensionsRequired', value=['KHR_draco_mesh_compression']), 'KHR_draco'),
    'scene-type': (changed('scene', value='first'), 'scene is not'),
    'scene-missing': (changed('scene', value=3), 'scene 3'),
    'scene-node': (changed('scenes', 0, 'nodes', value=[5]), 'node 5'),
    'nodes-type': (changed('nodes', value={}), 'nodes is not an array'),
    'node-type': (changed('nodes', 0, value=3), 'nodes is not an array of objects'),
    'node-mesh': (changed('nodes', 0, 'mesh', value=1), 'mesh 1'),
    'node-mesh-negative': (changed('nodes', 0, 'mesh', value=-1), 'nodes[0].mesh'),
    'node-loop': (changed('nodes', value=LOOP), 'twice'),
    'node-own-child': (changed('nodes', 0, 'children', value=[0]), 'twice'),
    'node-listed-twice': (changed('scenes', 0, 'nodes', value=[0, 0]), 'twice'),
    'node-child-missing': (changed('nodes', 0, 'children', value=[7]), 'node 7'),
    'node-matrix-short': (with_node(matrix=[1, 0, 0, 0]), 'nodes[1].matrix'),
    'node-matrix-projective': (with_node(matrix=[1, 0, 0, 1] + [0] * 11 + [1]), 'affine'),
    'node-rotation-zero': (with_node(rotation=[0, 0, 0, 0]), 'quaternion'),
    'node-scale-words': (with_node(scale=['a', 1, 1]), 'nodes[1].scale'),
    'node-far': (with_node(mesh=0, translation=[1e305, 0, 0]), 'extent'),
    'mesh-mode': (changed(*PRIMITIVE, 'mode', value=7), 'mode 7'),
    'mesh-points': (changed(*PRIMITIVE, 'mode', value=0), 'no triangles'),
    'mesh-primitives': (changed('meshes', 0, 'primitives', value={}), 'primitives is not'),
    'mesh-material': (changed(*PRIMITIVE, 'material', value=2), 'material 2'),
    'mesh-position': (changed(*PRIMITIVE, 'attributes', value={'POSITION': 9}), 'accessor 9'),
    'mesh-position-scalar': (changed(*PRIMITIVE, 'attributes', value={'POSITION': 1}), 'component'),
    'mesh-indices': (changed(*PRIMITIVE, 'indices', value=9), 'accessor'),
    'mesh-indices-vector': (changed(*PRIMITIVE, 'indices', value=0), 'component'),
    'index-range': (cube(UINT).text().replace(b'"count": 8', b'"count": 7'), 'is not below the 7 vertices'),
    'vertex-nan': (with_corner(float('nan'), 0, 0), 'vertex 0'),
    'vertex-infinite': (with_corner(0, float('-inf'), 0), 'vertex 0'),
    'no-extent': (cube().text().replace(b'"count": 8', b'"count": 1').replace(b'"count": 36', b'"count": 3'), ''),
    'accessor-view': (changed(*ACCESSOR, 'bufferView', value=4), 'buffer view 4'),
    'accessor-count': (changed(*ACCESSOR, 'count', value=9), 'more than buffer view'),
    'accessor-count-huge': (changed(*ACCESSOR, 'count', value=1 << 47), 'more elements'),
    'accessor-count-wraps': (changed(*ACCESSOR, 'count', value=1 << 62), 'accessors[0].count'),
    'accessor-count-zero': (changed(*ACCESSOR, 'count', value=0), 'no elements'),
    'accessor-offset': (changed(*ACCESSOR, 'byteOffset', value=(1 << 48) - 4), 'more than buffer view'),
    'accessor-offset-negative': (changed(*ACCESSOR, 'byteOffset', value=-4), 'byteOffset'),
    'accessor-component': (changed(*ACCESSOR, 'componentType', value=5124), 'component type 5124'),
    'accessor-type': (changed(*ACCESSOR, 'type', value='VEC9'), 'VEC9'),
    'accessor-no-bytes': (changed('accessors', 0, value={'componentType': FLOAT, 'type': 'VEC3', 'count': 1 << 40}),
                          'more elements'),
    'accessor-all-zero': (changed('accessors', 0, value={'componentType': FLOAT, 'type': 'VEC3', 'count': 8}),
                          'no extent'),
    'view-buffer': (changed(*VIEW, 'buffer', value=1), 'buffer 1'),
    'view-beyond': (changed(*VIEW, 'byteLength', value=100000), 'beyond its buffer'),
    'view-offset': (changed(*VIEW, 'byteOffset', value=(1 << 48) - 1), 'beyond its buffer'),
    'view-stride': (changed(*VIEW, 'byteStride', value=4), 'overlap'),
    'view-stride-huge': (changed(*VIEW, 'byteStride', value=252), 'more than buffer view'),
    'buffer-missing': (changed('buffers', 0, value={'byteLength': 4, 'uri': 'nowhere.bin'}), 'nowhere.bin'),
    'buffer-folder': (changed('buffers', 0, value={'byteLength': 4, 'uri': '.'}), "can't read"),
    'buffer-short': (changed('buffers', 0, 'byteLength', value=100000), ''),
    'buffer-base64': (changed('buffers', 0, 'uri', value='data:application/octet-stream;base64,!!!'), ''),
    'buffer-none': (changed('buffers', value=[]), 'buffer 0'),
    'sparse-index': (with_sparse(), 'sparse index'),
    'sparse-count': (with_sparse(count=9), 'sparse count'),
    'sparse-view': (with_sparse(values={'bufferView': 77}), 'buffer view 77'),
    'sparse-indices-type': (with_sparse(indices={'bufferView': 2, 'componentType': 5126 + 3}), 'component type'),
    'animation-node': (with_animation(node=8), 'node 8'),
    'animation-times-equal': (with_animation(times=(1, 1)), 'do not rise'),
    'animation-times-nan': (with_animation(times=(0, float('nan'))), 'do not rise'),
    'animation-values': (with_animation(values=((0, 0, 0),)), '2 keys'),
    'animation-cubic': (with_animation(interpolation='CUBICSPLINE'), '2 keys'),
    'animation-interpolation': (with_animation(interpolation='SMOOTH'), 'SMOOTH'),
    'animation-infinite': (with_animation(values=((0, 0, 0), (float('inf'), 0, 0))), 'not finite'),
    'animation-no-turn': (with_animation(path='rotation', values=((0, 0, 0, 1), (0, 0, 0, 0))), 'quaternion'),
}

# What Debian's assimp-testmodels has of broken files.
ASSIMP_BROKEN = [
    'BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb', 'IndexOutOfRange/AllIndicesOutOfRange.gltf',
    'IndexOutOfRange/IndexOutOfRange.gltf', 'MissingBin/BoxTextured.gltf', 'RecursiveNodes/RecursiveNodes.gltf',
    'SchemaFailures/sceneWrongType.gltf', 'TestNoRootNode/NoScene.gltf', 'TestNoRootNode/SceneWithoutNodes.gltf',
    'draco/2CylinderEngine.gltf', 'wrongTypes/badArray.gltf', 'wrongTypes/badExtension.gltf',
    'wrongTypes/badNumber.gltf', 'wrongTypes/badObject.gltf', 'wrongTypes/badString.gltf', 'wrongTypes/badUint.gltf',
]


class Broken(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def run_demo(self, gltf):
        """A tiny run: its exit code, never that of a signal, and the lines on stderr."""
        arguments = [DEMO, '--gltf', gltf, '--frames', '1', '--size', '8x8', '--out',
                     os.path.join(self.folder.name, 'out'), '--samples', '1', '--sample', '4', '--spheres', '0',
                     '--boxes', '0', '--workers', '1', '--quiet']
        done = subprocess.run(arguments, capture_output=True, text=True, errors='replace', timeout=60)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        return done.returncode, done.stderr.splitlines()

    def save(self, name, data):
        path = os.path.join(self.folder.name, name)
        with open(path, 'wb') as file:
            file.write(data)
        return path

    def assert_refused(self, path, fault):
        code, lines = self.run_demo(path)
        self.assertEqual(code, 1)
        self.assertTrue(lines and all(line.startswith('raygrid-demo: note: ') for line in lines[:-1]), lines)
        self.assertTrue(lines[-1].startswith('raygrid-demo: %s: ' % path), lines)
        self.assertIn(fault, lines[-1])

    def test_authored(self):
        for name, (data, fault) in BROKEN.items():
            with self.subTest(name):
                self.assert_refused(self.save(name, data), fault)

    def test_no_file(self):
        self.assert_refused(os.path.join(self.folder.name, 'nowhere.gltf'), 'No such file')
        self.assert_refused(self.folder.name, 'directory')

    def test_assimp(self):
        if not os.path.isdir(ASSIMP):
            self.skipTest(ASSIMP + ' is not there')
        for name in ASSIMP_BROKEN:
            with self.subTest(name):
                self.assert_refused(os.path.join(ASSIMP, name), '')

    def test_whole(self):
        """The files that the others are bent from are good, and so are those that only look odd."""
        chain = cube()
        chain.json['nodes'] += [{'children': [i + 2]} for i in range(20000)] + [{}]
        chain.json['nodes'][0]['children'] = [1]
        odd = cube()
        odd.json['images'] = [{'uri': 'missing.png'}]
        odd.json['nodes'].append({'children': [2]})  # a tree that is not in the scene
        odd.json['nodes'].append({'mesh': 0, 'scale': [0, 0, 0]})
        sceneless = cube()
        del sceneless.json['scene'], sceneless.json['scenes']
        for name, data in {'text': cube().text(), 'binary': cube().binary(), 'chain': chain.text(),
                           'odd': odd.text(), 'sceneless': sceneless.text(),
                           'animated': gltf_files.animated().text()}.items():
            with self.subTest(name):
                code, lines = self.run_demo(self.save(name, data))
                self.assertEqual(code, 0, lines)

    def test_cut_anywhere(self):
        """No prefix of a good file is good, and none crashes."""
        for data in cube().binary(), gltf_files.animated().text():
            for length in range(1, len(data) - 1, 61):
                with self.subTest(length=length):
                    self.assert_refused(self.save('cut', data[:length]), '')

    def test_flipped_bytes(self):
        """Whatever becomes of a file with some bytes changed: it is shown or refused, never a crash."""
        source = random.Random(20260101)
        for round_ in range(150):
            data = bytearray(source.choice([cube().binary(), gltf_files.animated().binary()]))
            for _ in range(source.randrange(1, 6)):
                data[source.randrange(len(data))] = source.randrange(256)
            with self.subTest(round=round_):
                code, lines = self.run_demo(self.save('flipped', bytes(data)))
                self.assertTrue(code == 0 or lines[-1].startswith('raygrid-demo: '), lines)

    def test_swapped_numbers(self):
        """Every number of the JSON replaced in turn by others that are out of place."""
        def places(value, path=()):
            if isinstance(value, (dict, list)):
                for key, item in value.items() if isinstance(value, dict) else enumerate(value):
                    yield from places(item, path + (key,))
            elif isinstance(value, (int, float)):
                yield path

        original = json.loads(gltf_files.animated().text())
        for path in places(original):
            for number in -1, 0, 3, 1 << 31, 0.5:
                document = json.loads(json.dumps(original))
                place = document
                for step in path[:-1]:
                    place = place[step]
                place[path[-1]] = number
                with self.subTest(path=path, number=number):
                    self.run_demo(self.save('swapped', json.dumps(document).encode()))


if __name__ == '__main__':
    unittest.main()
