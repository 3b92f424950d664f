"""Ray casting by MuJoCo: the geom that a ray hits first, and its distance."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.simulation.library import load_mujoco

GROUP_COUNT = 6
"""The number of geom groups in MuJoCo."""
_FIRST_RELIABLE_VERSION = 4
"""The first major version in which `mj_multiRay` hits bodies whose center of mass is not their origin."""


def cast_rays(
    model: Any,
    data: Any,
    origin: Array,
    rays: Array,
    groups: Any,
    *,
    excluded_body: int,
    max_distance: float,
    normals: Any = None,
) -> tuple[Array, Any]:
    """Cast rays from one point, and return the first hit of each ray.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data.
        origin: the common origin of the rays in the world, shape (3,), in m.
        rays: the directions of the rays in the world as unit vectors, shape (rays, 3).
        groups: for each geom group, 1 if the rays can hit its geoms and 0 otherwise, shape (GROUPS,).
        excluded_body: the index of a body that the rays pass through; -1 for none.
        max_distance: the maximum length of the rays, in m.
        normals: an array that receives the normals of the hit surfaces, shape (rays, 3); None if they are not needed.

    Returns:
        The distances in m and the geom indices, both of shape (rays,) and negative for a ray without a hit.
    """
    mujoco = load_mujoco()
    count = len(rays)
    distances, geoms = np.empty(count), np.empty(count, dtype=np.int32)
    if int(mujoco.__version__.partition(".")[0]) >= _FIRST_RELIABLE_VERSION:
        flat_normals = None if normals is None else normals.reshape(-1)
        mujoco.mj_multiRay(
            model,
            data,
            origin,
            rays.reshape(-1),
            groups,
            1,
            excluded_body,
            geoms,
            distances,
            flat_normals,
            count,
            max_distance,
        )
    else:
        for index in range(count):
            normal = None if normals is None else normals[index]
            distances[index] = mujoco.mj_ray(
                model, data, origin, rays[index], groups, 1, excluded_body, geoms[index : index + 1], normal
            )
    is_too_far = distances > max_distance
    distances[is_too_far], geoms[is_too_far] = -1.0, -1
    return distances, geoms
