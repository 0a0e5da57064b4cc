# SPDX-License-Identifier: MIT
"""A city of moving cars, and a lidar on the roof of one more. Lengths in metres, times in seconds.

Where a car is follows from the time alone, so that every process which makes the same traffic sees the same.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from raygrid import Box, GridConfig, GridKind, Scene

Floats = NDArray[np.float64]

LANE = 4.0  # wide
ROADS_APART = 100.0
SENSOR_HEIGHT = 1.8
BEAMS = 128
RANGE = 120.0
TURNS_A_SECOND = 10.0
SECTORS = 10  # the cars move between two sectors of a turn


class Traffic:
    """Cars on a grid of roads, half of which run along x and half along y; houses between; the ground."""

    def __init__(self, cars: int, seed: int = 1) -> None:
        random = np.random.default_rng(seed)
        self.roads = max(2, int(np.sqrt(cars / 20)))
        self.size = self.roads * ROADS_APART
        self.along_x = np.arange(cars) % 2 == 0
        self.start = random.uniform(0, self.size, cars)
        self.speed = random.uniform(5, 20, cars) * random.choice([-1, 1], cars)
        lanes = random.integers(1, 3, cars) * np.sign(self.speed)
        self.across = random.integers(self.roads, size=cars) * ROADS_APART + (lanes - 0.5 * np.sign(lanes)) * LANE
        self.scale = random.uniform(0.8, 1.3, cars)

        self.scene = Scene()
        car = Box((-2.2, -0.9, 0), (2.2, 0.9, 1.5))
        self.cars = self.scene.insert(car, self.positions(0), linear=self.headings(), scale=self.scale)
        # What never moves has a grid of its own.
        still = self.scene.create_grid(GridConfig(GridKind.DEFAULT))
        self.scene.insert(Box((-np.inf, -np.inf, -1), (np.inf, np.inf, 0)), grid=still)
        corner = np.arange(self.roads) * ROADS_APART + ROADS_APART / 2
        places = np.stack([*np.meshgrid(corner, corner), np.zeros((self.roads, self.roads))], axis=-1).reshape(-1, 3)
        wide = np.zeros((len(places), 3, 3))
        wide[:, [0, 1], [0, 1]] = random.uniform(10, 35, (len(places), 2))
        wide[:, 2, 2] = random.uniform(6, 40, len(places))
        self.scene.insert(Box((-1, -1, 0), (1, 1, 1)), places, linear=wide, grid=still)

    def positions(self, time: float) -> Floats:
        along = (self.start + self.speed * time) % self.size
        x, y = np.where(self.along_x, (along, self.across), (self.across, along))
        return np.stack([x, y, np.zeros_like(x)], axis=1)

    def headings(self) -> Floats:
        """Cars along x as they are made, cars along y turned by a quarter."""
        turned = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
        return np.where(self.along_x[:, None, None], np.eye(3), turned)

    def move(self, time: float) -> None:
        self.scene.move(self.cars, self.positions(time))


class Lidar:
    """Beams one above another that turn; it drives along the middle of a road."""

    def __init__(self, traffic: Traffic, rays: int) -> None:
        self.road = traffic.roads // 2 * ROADS_APART
        self.length = traffic.size
        self.columns = max(SECTORS, rays // BEAMS) // SECTORS  # of a sector
        elevations = np.radians(np.linspace(-25, 15, BEAMS))
        self.cos, self.sin = np.cos(elevations), np.sin(elevations)

    @property
    def rays(self) -> int:
        """Rays of a sector."""
        return self.columns * BEAMS

    def origin(self, time: float) -> Floats:
        return np.array([(self.length / 2 + 10 * time) % self.length, self.road, SENSOR_HEIGHT])

    def directions(self, sector: int) -> Floats:
        """Unit vectors of a sector's rays, (rays, 3)."""
        turn = np.linspace(sector, sector + 1, self.columns, endpoint=False) * (2 * np.pi / SECTORS)
        directions = np.empty((self.columns, BEAMS, 3))
        directions[:, :, 0] = np.cos(turn)[:, None] * self.cos
        directions[:, :, 1] = np.sin(turn)[:, None] * self.cos
        directions[:, :, 2] = self.sin
        return directions.reshape(-1, 3)


def sector_time(frame: int, sector: int) -> float:
    """When a sector of a turn is looked at."""
    return (frame + sector / SECTORS) / TURNS_A_SECOND
