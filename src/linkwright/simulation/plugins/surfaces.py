"""The surfaces of collisions along lines through the world."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from linkwright.simulation.library import load_mujoco
from linkwright.simulation.ray_casting import GROUP_COUNT
from linkwright.simulation.scene.bodies import COLLISION_GROUP
from linkwright.simulation.simulation import Simulation

_SURFACE_GAP = 1e-6
"""The distance in m behind a surface at which a ray continues."""


def find_surfaces(simulation: Simulation, start: Sequence[float], axis: int, length: float) -> Iterator[float]:
    """Yield where a line meets collisions, as coordinates along its axis in m, in order.

    Args:
        simulation: the simulation, whose poses are up to date.
        start: the start of the line in the world, in m.
        axis: the axis of the world along which the line runs: 0, 1 or 2.
        length: the length of the line in m.
    """
    mujoco = load_mujoco()
    groups, geom = np.zeros(GROUP_COUNT, dtype=np.uint8), np.zeros(1, dtype=np.int32)
    groups[COLLISION_GROUP] = 1
    direction = np.zeros(3)
    direction[axis] = 1.0
    origin = np.array(start, dtype=np.float64)
    end = origin[axis] + length
    while origin[axis] < end:
        distance = mujoco.mj_ray(simulation.model, simulation.data, origin, direction, groups, 1, -1, geom)
        if distance < 0.0 or origin[axis] + distance > end:
            return
        origin[axis] += distance
        yield float(origin[axis])
        origin[axis] += _SURFACE_GAP
