# SPDX-License-Identifier: MIT
"""Brute force in NumPy: the closest hit of rays among posed spheres, boxes and triangles, and how sure it is.

All is done in the shape's own frame, where a posed object is its plain shape and t stays what it is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

# Rays that pass a silhouette or an edge of the answer by less than this, relative to the shape, are not judged.
MARGIN = 1e-9


@dataclass
class Posed:
    """An object: what it is, and world = position + scale * linear @ local."""

    kind: str  # "sphere", "box" or "mesh"
    points: np.ndarray  # sphere: none; box: lo and hi; mesh: (T, 3, 3) corners
    position: np.ndarray
    linear: np.ndarray
    scale: float

    def local(self, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        inverse = np.linalg.inv(self.scale * self.linear.astype(np.float32).astype(np.float64))
        return (origins - self.position) @ inverse.T, directions @ inverse.T


def sphere(o: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The unit sphere's least t >= 0 (inf: none), and whether that is sure."""
    dd = (d * d).sum(1)
    foot = o - d * ((o * d).sum(1) / dd)[:, None]
    below = 1 - (foot * foot).sum(1)
    half = np.sqrt(np.maximum(below, 0) / dd)
    middle = -(o * d).sum(1) / dd
    near, far = middle - half, middle + half
    t = np.where(near >= 0, near, far)
    sure = (np.abs(below) > MARGIN) & ((below < 0) | (np.minimum(np.abs(near), np.abs(far)) > MARGIN))
    return np.where((below >= 0) & (t >= 0), t, np.inf), sure


def box(o: np.ndarray, d: np.ndarray, lo: np.ndarray, hi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = (lo - o) / d, (hi - o) / d
    near, far = np.minimum(a, b).max(1), np.maximum(a, b).min(1)
    t = np.where(near >= 0, near, far)
    gap = np.abs(far - near) > MARGIN * (1 + np.abs(near) + np.abs(far))
    sure = gap & (np.minimum(np.abs(near), np.abs(far)) > MARGIN) & np.isfinite(near) & np.isfinite(far)
    return np.where((near <= far) & (t >= 0), t, np.inf), sure


def triangle(o: np.ndarray, d: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Möller and Trumbore's test."""
    a, e, f = corners[0], corners[1] - corners[0], corners[2] - corners[0]
    p = np.cross(d, f)
    determinant = p @ e
    size = np.linalg.norm(d, axis=1) * np.linalg.norm(e) * np.linalg.norm(f)
    with np.errstate(divide="ignore", invalid="ignore"):
        u = ((o - a) * p).sum(1) / determinant
        q = np.cross(o - a, e)
        v = (d * q).sum(1) / determinant
        t = (q @ f) / determinant
    least = np.minimum(np.minimum(u, v), 1 - u - v)
    flat = ~(np.abs(determinant) > 1e-6 * size)
    sure = ~flat & ((least < -1e-6) | ((least > 1e-6) & (np.abs(t) > MARGIN)))
    return np.where(~flat & (least >= 0) & (t >= 0), t, np.inf), sure


def closest(
    objects: dict[int, Posed], origins: np.ndarray, directions: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """t (inf: none) and id of each ray's closest hit, and whether these are sure."""
    best = np.full(len(origins), np.inf)
    owner = np.zeros(len(origins), np.uint64)
    sure = np.ones(len(origins), bool)
    for one, posed in objects.items():
        o, d = posed.local(origins, directions)
        if posed.kind == "sphere":
            found = [sphere(o, d)]
        elif posed.kind == "box":
            found = [box(o, d, *posed.points)]
        else:
            found = [triangle(o, d, corners) for corners in posed.points]
        for t, certain in found:
            sure &= certain | (t > best)
            owner = np.where(t < best, np.uint64(one), owner)
            best = np.minimum(best, t)
    return best, owner, sure
