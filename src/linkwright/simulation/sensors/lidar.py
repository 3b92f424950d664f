"""Lidars: ranges and intensities by ray casting.

Sources other than SDF: REP 117 for ranges that are too small or too large; `RaySensor` and `GpuRaySensor` of Gazebo for
the start of rays at the minimum range, so that the housing of a sensor does not occlude the world.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import rotation_matrix
from linkwright.sdf.sensors import Lidar, Sweep
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.ray_casting import GROUP_COUNT, cast_rays
from linkwright.simulation.scene.bodies import COLLISION_GROUP, VISUAL_GROUP
from linkwright.simulation.sensors.mount import GeomTable, Mount, find_visuals_and_collisions, get_part_name
from linkwright.simulation.sensors.noise import NoiseSource

_SURFACE_GAP = 1e-9
"""The distance in m behind a surface at which a ray continues, so that it does not hit the surface again."""
_MAX_OWN_SURFACES = 64
"""The maximum number of surfaces of its robot that a ray passes before the minimum range."""


@dataclass(frozen=True, slots=True)
class Scan:
    """A measurement of a lidar.

    Attributes:
        ranges: the distances in m, shape (vertical, horizontal); -inf below the range of the lidar, and inf above it.
        intensities: `laser_retro` of the hit surfaces, 0 without a hit, shape (vertical, horizontal).
    """

    ranges: Array
    intensities: Array


def sweep_angles(sweep: Sweep) -> Array:
    """Return the angles of the rays of a sweep, in rad, shape (count,)."""
    angles: Array = sweep.min_angle + sweep.step * np.arange(sweep.count, dtype=np.float64)
    return angles


class LidarSensor:
    """A lidar that looks along x.

    Horizontal angles are about z, and vertical angles are positive upwards.

    Ranges are exact except for noise: as in Gazebo, the range resolution does not round them. The lidar's own link does
    not occlude anything, nor do other parts of its robot that are nearer than the minimum range.

    Args:
        mount: the mount of the sensor.
        lidar: the parsed lidar.
        sees_visuals: whether the lidar detects visuals, as a GPU lidar does, instead of collisions.
        generator: the source of the noise.
    """

    def __init__(self, mount: Mount, lidar: Lidar, *, sees_visuals: bool, generator: np.random.Generator) -> None:
        self.horizontal = lidar.horizontal
        self.vertical = lidar.vertical
        self.range_min = max(lidar.range.min, 0.0)
        self.range_max = lidar.range.max if lidar.range.max > self.range_min else float("inf")
        self._mount = mount
        self._simulation = mount.simulation
        self._mujoco = load_mujoco()
        self._noise = NoiseSource(lidar.noise, generator)
        self._groups = np.zeros(GROUP_COUNT, dtype=np.uint8)
        self._groups[VISUAL_GROUP if sees_visuals else COLLISION_GROUP] = 1
        self._retro = GeomTable(self._simulation, self._list_retro_values)
        self._own_geoms = GeomTable(self._simulation, self._mark_own_geoms)

    @property
    def shape(self) -> tuple[int, int]:
        """The numbers of vertical and of horizontal rays."""
        return self.vertical.count, self.horizontal.count

    @cached_property
    def directions(self) -> Array:
        """The unit vectors of the rays in the lidar's frame, shape (vertical * horizontal, 3)."""
        elevation, azimuth = np.meshgrid(sweep_angles(self.vertical), sweep_angles(self.horizontal), indexing="ij")
        x, y, z = np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)
        rays: Array = np.stack([x, y, z], axis=-1).reshape(-1, 3)
        return rays

    def measure(self) -> Scan:
        """Return the current ranges and intensities, with noise.

        Raises:
            KeyError: the link no longer exists.
        """
        ranges, hit_geoms = self._cast_rays()
        intensities = self._retro.array()[hit_geoms]
        is_too_far = (ranges >= self.range_max) | (hit_geoms < 0)
        is_too_near = (ranges <= self.range_min) & ~is_too_far
        if not self._noise.is_silent:
            ranges = np.clip(self._noise.apply(ranges), self.range_min, self.range_max)
        ranges[is_too_far], ranges[is_too_near] = np.inf, -np.inf
        intensities[is_too_far] = 0.0
        return Scan(ranges.reshape(self.shape), intensities.reshape(self.shape))

    def _cast_rays(self) -> tuple[Array, Any]:
        simulation, pose = self._simulation, self._mount.pose()
        rays = self.directions @ np.array(rotation_matrix(pose[3:])).T
        max_distance = self.range_max if isfinite(self.range_max) else self._mujoco.mjMAXVAL
        origin, body = np.array(pose[:3]), self._mount.body
        ranges, geoms = cast_rays(
            simulation.model, simulation.data, origin, rays, self._groups, excluded_body=body, max_distance=max_distance
        )
        own_mask = self._own_geoms.array()
        for ray in np.nonzero((geoms >= 0) & (ranges < self.range_min) & (own_mask[geoms] > 0))[0]:
            ranges[ray], geoms[ray] = self._hit_beyond_robot(origin, rays[ray], body, float(ranges[ray]), own_mask)
        return ranges, geoms

    def _hit_beyond_robot(
        self, origin: Array, ray: Array, body: int, distance: float, own_mask: Array
    ) -> tuple[float, int]:
        """Return a ray's first hit that is not on a part of the robot within the minimum range.

        The result is the distance in m and the index of the geom; inf and -1 if there is no such hit.
        """
        simulation, geom = self._simulation, np.zeros(1, dtype=np.int32)
        for _ in range(_MAX_OWN_SURFACES):
            start = distance + _SURFACE_GAP
            gap = self._mujoco.mj_ray(
                simulation.model, simulation.data, origin + start * ray, ray, self._groups, 1, body, geom
            )
            if gap < 0:
                return float("inf"), -1
            distance = start + gap
            if distance >= self.range_min or not own_mask[geom[0]]:
                break
        return distance, int(geom[0])

    def _mark_own_geoms(self, names: list[str]) -> list[float]:
        prefix = self._mount.link.partition("::")[0] + "::"
        return [float(name.startswith(prefix)) for name in names]

    def _list_retro_values(self, names: list[str]) -> list[float]:
        retros = {
            name: part.laser_retro for name, part in find_visuals_and_collisions(self._simulation) if part.laser_retro
        }
        return [retros.get(get_part_name(name), 0.0) for name in names]
