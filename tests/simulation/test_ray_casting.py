"""Rays of MuJoCo."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from linkwright.simulation.ray_casting import GROUP_COUNT, cast_rays
from tests.simulation.worlds import make_simulation


def test_rays_hit_bodies_with_offset_center_of_mass():
    rng = np.random.default_rng(1)
    models = []
    for index in range(6):
        pose = " ".join(map(str, rng.uniform(-3, 3, 6)))
        size = " ".join(map(str, rng.uniform(0.2, 1.2, 3)))
        mass = "<inertial><pose>0.3 -0.2 0.1 0.4 0.5 0.6</pose><mass>1</mass></inertial>"
        shape = f"<geometry><box><size>{size}</size></box></geometry>"
        models.append(
            f'<model name="m{index}"><pose>{pose}</pose><link name="l">{mass}<collision name="c">{shape}</collision>'
            "</link></model>"
        )
    simulation = make_simulation(*models)
    simulation.refresh()
    rays = rng.normal(size=(720, 3))
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    groups, origin = np.ones(GROUP_COUNT, dtype=np.uint8), np.zeros(3)
    normals = np.zeros((720, 3))
    distances, geoms = cast_rays(
        simulation.model, simulation.data, origin, rays, groups, excluded_body=-1, max_distance=3.0, normals=normals
    )
    hit = np.zeros(1, dtype=np.int32)
    single_distances = np.array(
        [mujoco.mj_ray(simulation.model, simulation.data, origin, ray, groups, 1, -1, hit) for ray in rays]
    )
    is_in_range = (single_distances >= 0) & (single_distances <= 3.0)
    assert is_in_range.sum() > 30
    assert distances[is_in_range] == pytest.approx(single_distances[is_in_range])
    assert (geoms[~is_in_range] == -1).all()
    assert np.linalg.norm(normals[is_in_range], axis=1) == pytest.approx(np.ones(is_in_range.sum()))
