# SPDX-License-Identifier: MIT
"""Random scenes and random changes: after each, every query agrees with brute force in NumPy."""

from __future__ import annotations

import numpy as np
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

import raygrid
from raygrid import Box, GridConfig, GridKind, Mesh, Scene, Shape, Sphere

from brute import Posed, closest

RAYS = 64
SEEDS = st.integers(0, 2**32 - 1)
SPREADS = st.sampled_from([0.1, 3.0, 30.0, 1e4])


def a_shape(random: np.random.Generator, kind: str) -> tuple[Shape, np.ndarray]:
    if kind == "sphere":
        return Sphere(1), np.empty(0)
    if kind == "box":
        corners = np.sort(random.normal(size=(2, 3)), axis=0) + [[-0.1], [0.1]]
        return Box(*corners), corners
    corners = random.normal(size=(4, 3, 3))
    return Mesh(corners.reshape(-1, 3).astype(np.float32)), corners.astype(np.float32).astype(np.float64)


def a_linear(random: np.random.Generator) -> np.ndarray:
    """A turned, stretched and perhaps mirrored frame, well conditioned."""
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return (
        turn @ np.diag(random.uniform(0.5, 2, 3) * random.choice([-1, 1], 3)) if random.random() < 0.6 else np.eye(3)
    )


class Twin(RuleBasedStateMachine):
    """A scene, and what is in it, changed together."""

    @initialize(kind=st.sampled_from(list(GridKind)), workers=st.sampled_from([1, 2]), seed=SEEDS)
    def start(self, kind: GridKind, workers: int, seed: int) -> None:
        self.scene = Scene(workers=workers, grid=GridConfig(kind))
        self.random = np.random.default_rng(seed)
        self.objects: dict[int, Posed] = {}
        self.gone: list[int] = []

    def teardown(self) -> None:
        if hasattr(self, "scene"):
            self.scene.close()

    @rule(kind=st.sampled_from(["sphere", "box", "mesh"]), count=st.integers(1, 12), spread=SPREADS)
    def insert(self, kind: str, count: int, spread: float) -> None:
        shape, points = a_shape(self.random, kind)
        positions = self.random.normal(size=(count, 3)) * spread
        linear = np.array([a_linear(self.random) for _ in range(count)])
        scale = self.random.uniform(0.2, 3, count)
        ids = self.scene.insert(shape, positions, linear=linear, scale=scale)
        for i, one in enumerate(ids.tolist()):
            assert one not in self.objects and one not in self.gone
            self.objects[one] = Posed(kind, points, positions[i], linear[i], scale[i])

    def some(self, share: float) -> np.ndarray:
        ids = np.array(list(self.objects), np.uint64)
        return self.random.choice(ids, max(1, int(share * len(ids))), replace=False)

    @precondition(lambda self: self.objects)
    @rule(share=st.sampled_from([0.01, 0.3, 1.0]), spread=SPREADS, turned=st.booleans(), scaled=st.booleans())
    def move(self, share: float, spread: float, turned: bool, scaled: bool) -> None:
        ids = self.some(share)
        positions = self.random.normal(size=(len(ids), 3)) * spread
        linear = np.array([a_linear(self.random) for _ in ids]) if turned else None
        scale = self.random.uniform(0.2, 3, len(ids)) if scaled else None
        self.scene.move(ids, positions, linear=linear, scale=scale)
        for i, one in enumerate(ids.tolist()):
            posed = self.objects[one]
            posed.position = positions[i]
            posed.linear = posed.linear if linear is None else linear[i]
            posed.scale = posed.scale if scale is None else scale[i]

    @precondition(lambda self: self.objects)
    @rule(share=st.sampled_from([0.01, 0.3, 1.0]))
    def remove(self, share: float) -> None:
        ids = self.some(share)
        self.scene.remove(ids)
        for one in ids.tolist():
            self.gone.append(one)
            del self.objects[one]

    @precondition(lambda self: self.gone)
    @rule()
    def use_what_is_gone(self) -> None:
        ids = np.array([*self.objects, self.gone[-1]], np.uint64)
        for call in (lambda: self.scene.remove(ids), lambda: self.scene.move(ids, (1, 2, 3))):
            try:
                call()
            except raygrid.InvalidId:
                continue
            raise AssertionError("an id that is gone was taken")

    @precondition(lambda self: self.objects)
    @rule()
    def rebuild(self) -> None:
        self.scene.grid.rebuild()

    @invariant()
    def agrees(self) -> None:
        if not hasattr(self, "scene"):
            return
        assert self.scene.stats().objects == len(self.objects)
        targets = np.array([posed.position for posed in self.objects.values()]).reshape(-1, 3)
        origins = self.random.normal(size=(RAYS, 3)) * self.random.choice([0.1, 5, 1e3])
        directions = self.random.normal(size=(RAYS, 3))
        if len(targets):
            aimed = (
                targets[self.random.integers(len(targets), size=RAYS // 2)]
                + self.random.normal(size=(RAYS // 2, 3)) / 2
            )
            directions[: RAYS // 2] = aimed - origins[: RAYS // 2]
        t, owner, sure = closest(self.objects, origins, directions)
        hits = self.scene.trace(origins, directions)
        assert (hits.object[sure] == owner[sure]).all(), "another object, or none"
        hit = sure & np.isfinite(t)
        assert np.allclose(hits.t[hit], t[hit], rtol=1e-6, atol=1e-7), "another t"
        assert (np.isinf(hits.t) == (hits.object == 0)).all()
        assert (self.scene.occluded(origins, directions) == (hits.object != 0)).all()
        assert sure.mean() > 0.5, "brute force judges too few rays"


Twin.TestCase.settings = settings(
    max_examples=60, stateful_step_count=20, deadline=None, database=None, suppress_health_check=list(HealthCheck)
)
TestTwin = Twin.TestCase
