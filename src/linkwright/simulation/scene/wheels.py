"""Contact properties of driven wheels and casters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.single import rotation_from_z
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.bodies import COLLISION_GROUP
from linkwright.simulation.scene.surfaces import FRICTIONLESS, make_frictionless, make_slippery, make_soft, make_wheel

_ROUNDNESS_TOLERANCE = 0.05
"""The relative tolerance with which a mesh must extend equally far from its axis to count as round."""


SKIDDING_GRIP = 0.5
"""The maximum friction of wheels that slip in every turn.

The wheels of a robot with more than two driven wheels slip. With higher friction, MuJoCo's contacts lift the wheels. A
robot that is as long as it is wide then turns at 0.31 times the rate that its wheels would give it without slip. With
this value it turns at 0.43 times that rate; Coulomb friction gives 0.50 times, regardless of the coefficient.
"""


def make_rolling(spec: Any, body: Any, joint: Any, step: float, grips: Mapping[str, float], max_grip: float) -> None:
    """Make the collisions of a body roll about a joint without slipping.

    Each collision then touches the ground in one point, like a tire. Cylinders, and meshes that are round about the
    axis of the joint, become ellipsoids: the two edges of a cylinder would scrub in turns, and the corners of a mesh
    would bump.

    Args:
        spec: the specification.
        body: the body of the wheel.
        joint: the joint of the specification that turns the body.
        step: the time step of the simulation in s.
        grips: the coefficients of friction of the geoms that roll, by name; other geoms do not change.
        max_grip: the maximum coefficient of friction.
    """
    kinds = load_mujoco().mjtGeom
    for geom in body.geoms:
        grip = grips.get(geom.name, 0.0)
        if geom.group != COLLISION_GROUP or grip < FRICTIONLESS:
            continue
        if geom.type == kinds.mjGEOM_CYLINDER:
            radius, half_length, _ = geom.size
            geom.type = kinds.mjGEOM_ELLIPSOID
            geom.size = [radius, radius, half_length]
        elif geom.type == kinds.mjGEOM_MESH:
            _replace_round_mesh(spec, geom, np.array(joint.pos), np.array(joint.axis))
        if geom.type in (kinds.mjGEOM_ELLIPSOID, kinds.mjGEOM_SPHERE):
            make_wheel(geom, step, min(grip, max_grip))


def make_sliding(body: Any, unspecified: set[str]) -> None:
    """Make the spheres of a body without a motor soft, so that the wheels bear the load.

    Args:
        body: a body of the specification.
        unspecified: the names of the geoms without a specified friction; these geoms also become frictionless.
    """
    for geom in body.geoms:
        if geom.group == COLLISION_GROUP and geom.type == load_mujoco().mjtGeom.mjGEOM_SPHERE:
            if geom.name in unspecified:
                make_slippery(geom)
            else:
                make_soft(geom)


def make_omnidirectional(body: Any, step: float) -> None:
    """Make the collisions of a body frictionless but hard, as for a wheel with rollers.

    Args:
        body: a body of the specification.
        step: the time step of the simulation in s.
    """
    for geom in body.geoms:
        if geom.group == COLLISION_GROUP:
            make_frictionless(geom, step)


def _replace_round_mesh(spec: Any, geom: Any, origin: Array, axis: Array) -> None:
    """Turn a mesh geom into an ellipsoid if the mesh is round about an axis of its body."""
    w, x, y, z = geom.quat
    corners = np.array(spec.mesh(geom.meshname).uservert).reshape(-1, 3)
    corners = corners @ rotation_matrix((x, y, z, w)).T + np.array(geom.pos) - origin
    axis = axis / np.linalg.norm(axis)
    axial_positions = corners @ axis
    first_radial = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    first_radial /= np.linalg.norm(first_radial)
    second_radial = np.cross(axis, first_radial)
    extents = np.concatenate(
        [[coordinates.max(), -coordinates.min()] for coordinates in (corners @ first_radial, corners @ second_radial)]
    )
    radius = float(np.linalg.norm(corners - axial_positions[:, None] * axis, axis=1).max())
    if not np.allclose(extents, radius, atol=_ROUNDNESS_TOLERANCE * radius):
        return
    geom.type = load_mujoco().mjtGeom.mjGEOM_ELLIPSOID
    geom.meshname = ""
    geom.size = [radius, radius, max(float(np.ptp(axial_positions)) / 2, 1e-3)]
    geom.pos = list(origin + axis * (axial_positions.max() + axial_positions.min()) / 2)
    qx, qy, qz, qw = rotation_from_z((float(axis[0]), float(axis[1]), float(axis[2])))
    geom.quat = [qw, qx, qy, qz]
