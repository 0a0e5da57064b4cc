# SPDX-License-Identifier: MIT
"""Turns a mesh in Draco's format into binary glTF, its triangles and vertices in their order: models.py FROM TO."""
import pathlib
import sys

import DracoPy
import trimesh


def main():
    source, target = map(pathlib.Path, sys.argv[1:])
    mesh = DracoPy.decode(source.read_bytes())
    glb = trimesh.Trimesh(mesh.points, mesh.faces, process=False).export(file_type='glb')
    part = target.with_suffix('.part')
    part.write_bytes(glb)
    part.replace(target)


if __name__ == '__main__':
    main()
