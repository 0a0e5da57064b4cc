# SPDX-License-Identifier: MIT
"""Scenes and rays of the benchmark, and brute force over them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

FILLED = 0.05
SIZE = 100.0  # of the world; pybullet needs bodies of a size that it takes for metres
CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
# Two triangles for each side of a cube, wound to the outside.
SIDES = np.array(
    [
        [0, 1, 3],
        [0, 3, 2],
        [4, 6, 7],
        [4, 7, 5],
        [0, 4, 5],
        [0, 5, 1],
        [2, 3, 7],
        [2, 7, 6],
        [0, 2, 6],
        [0, 6, 4],
        [1, 5, 7],
        [1, 7, 3],
    ]
)


class Cubes:
    """Cubes of one size in a large one, some of which move in each frame; and rays from anywhere to anywhere."""

    def __init__(self, count: int, rays: int, seed: int = 1) -> None:
        self.random = np.random.default_rng(seed)
        self.side = float(SIZE * np.cbrt(FILLED / count))
        self.centers = self.random.uniform(0, SIZE, (count, 3))
        self.origins = self.random.uniform(0, SIZE, (rays, 3))
        self.directions = self.random.normal(size=(rays, 3))
        self.directions /= np.linalg.norm(self.directions, axis=1)[:, None]

    def move(self, share: float = 0.01) -> NDArray[np.int64]:
        """Moves some by about their size; returns which."""
        moved = self.random.choice(len(self.centers), max(1, int(share * len(self.centers))), replace=False)
        self.centers[moved] += self.random.normal(size=(len(moved), 3)) * self.side
        return moved

    def triangles(self) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
        """Vertices and indices of all; triangle i belongs to cube i // 12."""
        vertices = (self.centers[:, None] + CORNERS * self.side).reshape(-1, 3).astype(np.float32)
        indices = (8 * np.arange(len(self.centers))[:, None, None] + SIDES).reshape(-1, 3).astype(np.uint32)
        return vertices, indices

    def closest(self, ray: int) -> tuple[float, int, bool]:
        """t and cube of a ray's closest hit (inf, -1: none), and whether rounding can't change it."""
        with np.errstate(divide="ignore"):
            a = (self.centers - self.side / 2 - self.origins[ray]) / self.directions[ray]
            b = (self.centers + self.side / 2 - self.origins[ray]) / self.directions[ray]
        near, far = np.minimum(a, b).max(1), np.maximum(a, b).min(1)
        t = np.where(near >= 0, near, far)
        hit = (near <= far) & (t >= 0)
        best = np.where(hit, t, np.inf).min()
        edge = (np.abs(far - near) < 1e-9) | (np.abs(near) < 1e-9) | (np.abs(far) < 1e-9)
        close = np.sort(t[hit & (t < best + 1e-9)])
        sure = not (edge & (np.minimum(near, far) <= best)).any() and (len(close) < 2 or close[1] > best + 1e-12)
        cube = int(np.where(hit, t, np.inf).argmin()) if np.isfinite(best) else -1
        return float(best), cube, sure

    def judge(self, t: Floats, cube: NDArray[np.int64], sample: int) -> tuple[int, int, float]:
        """Rays judged, wrong ones among them, and the largest error of t in sides of a cube."""
        judged = wrong = 0
        worst = 0.0
        for ray in np.linspace(0, len(t) - 1, min(sample, len(t))).astype(int):
            right_t, right_cube, sure = self.closest(ray)
            if not sure:
                continue
            judged += 1
            if cube[ray] != right_cube:
                wrong += 1
            elif right_cube >= 0:
                worst = max(worst, abs(float(t[ray]) - right_t) / self.side)
        return judged, wrong, worst
