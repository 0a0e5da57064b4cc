# SPDX-License-Identifier: MIT
"""Writes small glTF files: good ones, to be bent by the tests into whatever they want to see refused or played."""
import base64
import copy
import json
import struct

BYTE, UBYTE, SHORT, USHORT, UINT, FLOAT = 5120, 5121, 5122, 5123, 5125, 5126
_CODE = {BYTE: 'b', UBYTE: 'B', SHORT: 'h', USHORT: 'H', UINT: 'I', FLOAT: 'f'}
_WIDTH = {'SCALAR': 1, 'VEC3': 3, 'VEC4': 4}

# A cube of half width 1: corner i has its bits as signs, two triangles a face, counter-clockwise from outside.
CUBE_CORNERS = [(-1.0 if i & 1 == 0 else 1.0, -1.0 if i & 2 == 0 else 1.0, -1.0 if i & 4 == 0 else 1.0)
                for i in range(8)]
CUBE_TRIANGLES = [0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7,
                  4, 7, 6]


class Document:
    """A glTF document as a dict that may be changed at will, and the bytes of its one buffer."""

    def __init__(self):
        self.bytes = b''
        self.json = {'asset': {'version': '2.0'}, 'buffers': [{}], 'bufferViews': [], 'accessors': [], 'meshes': [],
                     'nodes': [], 'scenes': [{'nodes': []}], 'scene': 0}

    def view(self, data):
        self.bytes += b'\0' * (-len(self.bytes) % 4)
        self.json['bufferViews'].append({'buffer': 0, 'byteOffset': len(self.bytes), 'byteLength': len(data)})
        self.bytes += data
        return len(self.json['bufferViews']) - 1

    def accessor(self, numbers, kind='SCALAR', component=FLOAT):
        data = struct.pack('<%d%s' % (len(numbers), _CODE[component]), *numbers)
        self.json['accessors'].append({'bufferView': self.view(data), 'componentType': component, 'type': kind,
                                       'count': len(numbers) // _WIDTH[kind]})
        return len(self.json['accessors']) - 1

    def mesh(self, corners, indices=None, component=USHORT, mode=4):
        primitive = {'attributes': {'POSITION': self.accessor([x for c in corners for x in c], 'VEC3')}, 'mode': mode}
        if indices is not None:
            primitive['indices'] = self.accessor(indices, component=component)
        self.json['meshes'].append({'primitives': [primitive]})
        return len(self.json['meshes']) - 1

    def node(self, root=True, **properties):
        self.json['nodes'].append(properties)
        if root:
            self.json['scenes'][0]['nodes'].append(len(self.json['nodes']) - 1)
        return len(self.json['nodes']) - 1

    def animate(self, node, path, times, values, interpolation='LINEAR'):
        kind = 'VEC4' if path == 'rotation' else 'VEC3'
        sampler = {'input': self.accessor(times), 'interpolation': interpolation,
                   'output': self.accessor([x for value in values for x in value], kind)}
        self.json.setdefault('animations', []).append(
            {'channels': [{'sampler': 0, 'target': {'node': node, 'path': path}}], 'samplers': [sampler]})

    def text(self):
        """The .gltf file, its buffer inside."""
        document = copy.deepcopy(self.json)
        for buffer in document.get('buffers', []):
            if isinstance(buffer, dict):
                buffer.setdefault('byteLength', len(self.bytes))
                buffer.setdefault('uri', 'data:application/octet-stream;base64,' +
                                  base64.b64encode(self.bytes).decode())
        return json.dumps(document).encode()

    def binary(self):
        """The .glb file."""
        document = copy.deepcopy(self.json)
        body = self.bytes + b'\0' * (-len(self.bytes) % 4)
        document['buffers'][0]['byteLength'] = len(body)
        text = json.dumps(document).encode()
        text += b' ' * (-len(text) % 4)
        chunks = struct.pack('<I4s', len(text), b'JSON') + text + struct.pack('<I4s', len(body), b'BIN\0') + body
        return struct.pack('<4sII', b'glTF', 2, 12 + len(chunks)) + chunks


def cube(component=USHORT):
    """One cube on one node."""
    document = Document()
    document.node(mesh=document.mesh(CUBE_CORNERS, CUBE_TRIANGLES, component))
    return document


def animated():
    """Two cubes, one on the arm of a turning, stretching node; every kind of channel and interpolation."""
    document = Document()
    mesh = document.mesh(CUBE_CORNERS, CUBE_TRIANGLES)
    half = 0.5 ** 0.5
    arm = document.node(mesh=mesh, translation=[3, 0.5, 0], scale=[0.5, 0.5, 0.5], root=False)
    hub = document.node(mesh=mesh, children=[arm], rotation=[0, half, 0, half])
    lone = document.node(mesh=mesh, translation=[0, 0, 4])
    document.animate(hub, 'rotation', [0.5, 1.5, 2.5], [(0, 0, 0, 1), (0, half, 0, half), (0, 0, half, -half)])
    document.animate(hub, 'scale', [0, 2], [(1, 1, 1), (1, 2, 0.5)], 'STEP')
    document.animate(arm, 'translation', [1, 3], [(0, 0, 0), (3, 0.5, 0), (1, 2, 3), (4, 5, 6), (0, 2, 1), (7, 8, 9)],
                     'CUBICSPLINE')
    document.animate(lone, 'translation', [0, 1, 2], [(0, 0, 4), (2, 0, 4), (2, -1, 4)])
    return document
