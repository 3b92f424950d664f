"""Ray casting by MuJoCo: the geom that a ray hits first, and its distance."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.simulation.library import load_mujoco

GROUPS = 6
"""The number of MuJoCo's groups of geoms."""
_SOUND = 4
"""Before this version, rays that are cast together miss bodies whose centre of mass is not their origin."""


def cast(
    model: Any,
    data: Any,
    origin: Array,
    rays: Array,
    groups: Any,
    *,
    apart_from: int,
    reach: float,
    normals: Any = None,
) -> tuple[Array, Any]:
    """Cast rays from one point, and return the first hit of each ray.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data.
        origin: the common origin of the rays, shape (3,), in m.
        rays: the directions of the rays as unit vectors, shape (rays, 3).
        groups: the groups of geoms that the rays can hit, shape (GROUPS,).
        apart_from: the body whose geoms the rays pass through; -1 for none.
        reach: the maximum length of the rays, in m.
        normals: if given, receives the normals of the hit surfaces, shape (rays, 3).

    Returns:
        Distances in m, negative for no hit, and the geoms, -1 for none; both of shape (rays,).
    """
    mujoco = load_mujoco()
    count = len(rays)
    distances, geoms = np.empty(count), np.empty(count, dtype=np.int32)
    if int(mujoco.__version__.partition(".")[0]) >= _SOUND:
        flat = None if normals is None else normals.reshape(-1)
        mujoco.mj_multiRay(
            model, data, origin, rays.reshape(-1), groups, 1, apart_from, geoms, distances, flat, count, reach
        )
    else:
        for index in range(count):
            normal = None if normals is None else normals[index]
            distances[index] = mujoco.mj_ray(
                model, data, origin, rays[index], groups, 1, apart_from, geoms[index : index + 1], normal
            )
    beyond = distances > reach
    distances[beyond], geoms[beyond] = -1.0, -1
    return distances, geoms
