# SPDX-License-Identifier: MIT
"""A walk through raygrid: insert, move, remove, trace, each with a picture of what the rays see.

Run it as a script, or cell by cell.
"""

# %% What the pictures are made with: a camera is nothing but arrays of rays.

from __future__ import annotations

import argparse
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from raygrid import NO_OBJECT, Box, Capsule, Mesh, Scene, Sphere

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/python"))
parser.add_argument("--width", type=int, default=480, help="of the pictures, in pixels")
options = parser.parse_args()
options.out.mkdir(parents=True, exist_ok=True)

WIDTH, HEIGHT = options.width, options.width * 3 // 4
EYE = np.array([0.0, -14, 6])
LIGHT = np.array([-4.0, -6, 12])


def camera_rays(target=(0.0, 0.0, 1.0)) -> np.ndarray:
    """A direction for each pixel, (HEIGHT * WIDTH, 3)."""
    forward = target - EYE
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    x = np.linspace(-0.6, 0.6, WIDTH)
    y = np.linspace(0.45, -0.45, HEIGHT)
    return (forward + x[None, :, None] * right + y[:, None, None] * up).reshape(-1, 3)


def picture(scene: Scene, name: str) -> None:
    """Traces the camera's rays, and from each hit one more to the light."""
    directions = camera_rays()
    hits = scene.trace(EYE, directions, fields=("t", "object", "normal", "position", "offset"))
    hit = hits.object != NO_OBJECT
    start = hits.position[hit] + hits.offset[hit, None] * hits.normal[hit]
    to_light = LIGHT - start
    dark = scene.occluded(start, to_light, t_max=1)
    lambert = np.einsum("ij,ij->i", hits.normal[hit], to_light) / np.linalg.norm(to_light, axis=1)
    slots = (hits.object[hit] & 0xFFFFFFFF).astype(int)  # a small number for each object: good for a table of colours
    image = np.full((HEIGHT * WIDTH, 3), 0.93)
    image[hit] = plt.cm.tab20(slots % 20)[:, :3] * (0.25 + 0.75 * np.clip(lambert, 0, 1) * ~dark)[:, None]
    path = options.out / f"walkthrough-{name}.png"
    plt.imsave(path, np.clip(image, 0, 1).reshape(HEIGHT, WIDTH, 3))
    print(f"{name}: {hit.sum()} of {len(hit)} rays hit, {dark.sum()} points in shadow; {path}")


# %% Insert: a shape, and where its objects are. There is no step between this and the first ray.

scene = Scene()
ground = scene.insert(Box((-np.inf, -np.inf, -1), (np.inf, np.inf, 0)))
balls = scene.insert(Sphere(1), [[-4, 0, 1], [0, 0, 1.5], [4, 0, 0.6]], scale=[1, 1.5, 0.6])
picture(scene, "1-inserted")

# %% One shape, many objects: each with a position, a scale, and a linear part for all else.

angles = np.linspace(0, 2 * np.pi, 12, endpoint=False)
ring = np.stack([6 * np.cos(angles), 6 * np.sin(angles), np.full(12, 0.8)], axis=1)
turns = np.zeros((12, 3, 3))
turns[:, 0, 0] = turns[:, 1, 1] = np.cos(angles)
turns[:, 1, 0], turns[:, 0, 1] = np.sin(angles), -np.sin(angles)
turns[:, 2, 2] = 1
posts = scene.insert(Capsule((0, 0, -0.5), (0, 0, 0.5), 0.3), ring)
tent = Mesh([[-0.8, -0.5, 0], [0.8, -0.5, 0], [0, 0.8, 0], [0, 0, 1.6]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
tents = scene.insert(tent, ring * [0.6, 0.6, 0], linear=turns)
print(scene)
picture(scene, "2-many")

# %% Move: all at once or a few. What is not given, here size and turn, stays.

scene.move(posts, ring + [0, 0, 1.2] * (1 + np.sin(3 * angles))[:, None])
scene.move(balls[1], (0, -3, 4))
picture(scene, "3-moved")

# %% Remove. An id never comes back: who still holds one is told.

scene.remove(tents[::2])
try:
    scene.move(tents, (0, 0, 0))
except LookupError as error:
    print(f"refused: {error}")
picture(scene, "4-removed")

# %% Trace: not only for pictures. Who sees the ball in the air from the ring?

eyes = ring + [0, 0, 4]
to_ball = scene.lookup(balls[1]).position - eyes
hits = scene.trace(eyes, to_ball)
print(
    "seen from", np.flatnonzero(hits.object == balls[1]).tolist(), "at", np.round(hits.t[hits.object == balls[1]], 2)
)
scene.close()
