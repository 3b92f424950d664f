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

_ROUND = 0.05
"""A mesh is a wheel where it reaches equally far from its axis on all sides, up to this share."""


SKIDDING_GRIP = 0.5
"""The greatest friction of wheels that slip in every turn, as more than two that are driven do.

With more of it MuJoCo's contacts lift them. A robot as long as wide then turns 0.31 times as fast as its wheels would
have it, with this 0.43 times; friction by Coulomb gives 0.50, however great it is.
"""


def make_rolling(spec: Any, body: Any, joint: Any, step: float, grips: Mapping[str, float], greatest: float) -> None:
    """Let the collisions of a body roll about a joint without slipping.

    They touch the ground in one point, as tyres do. Cylinders, and meshes that are round about the axis of the joint,
    become ellipsoids: the two edges of a cylinder would scrub in turns, and the corners of a mesh would bump.

    Args:
        spec: the specification.
        body: the body of the wheel.
        joint: the joint of the specification that turns the body.
        step: the time step of the simulation in s.
        grips: the friction of the geoms that roll, by name; other geoms remain unchanged.
        greatest: the maximum friction.
    """
    kinds = load_mujoco().mjtGeom
    for geom in body.geoms:
        grip = grips.get(geom.name, 0.0)
        if geom.group != COLLISION_GROUP or grip < FRICTIONLESS:
            continue
        if geom.type == kinds.mjGEOM_CYLINDER:
            radius, half, _ = geom.size
            geom.type = kinds.mjGEOM_ELLIPSOID
            geom.size = [radius, radius, half]
        elif geom.type == kinds.mjGEOM_MESH:
            _round_mesh(spec, geom, np.array(joint.pos), np.array(joint.axis))
        if geom.type in (kinds.mjGEOM_ELLIPSOID, kinds.mjGEOM_SPHERE):
            make_wheel(geom, step, min(grip, greatest))


def make_sliding(body: Any, unspecified: set[str]) -> None:
    """Make the spheres of a body without a motor leave the load to the wheels.

    Args:
        body: a body of the specification.
        unspecified: names of the geoms whose friction is not specified. These geoms become frictionless, while the
            others only become soft.
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


def _round_mesh(spec: Any, geom: Any, origin: Array, axis: Array) -> None:
    """Replace a mesh by an ellipsoid if the mesh is round about an axis in the frame of its body."""
    w, x, y, z = geom.quat
    corners = np.array(spec.mesh(geom.meshname).uservert).reshape(-1, 3)
    corners = corners @ rotation_matrix((x, y, z, w)).T + np.array(geom.pos) - origin
    axis = axis / np.linalg.norm(axis)
    along = corners @ axis
    first = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    first /= np.linalg.norm(first)
    second = np.cross(axis, first)
    reach = np.concatenate([[side.max(), -side.min()] for side in (corners @ first, corners @ second)])
    radius = float(np.linalg.norm(corners - along[:, None] * axis, axis=1).max())
    if not np.allclose(reach, radius, atol=_ROUND * radius):
        return
    geom.type = load_mujoco().mjtGeom.mjGEOM_ELLIPSOID
    geom.meshname = ""
    geom.size = [radius, radius, max(float(np.ptp(along)) / 2, 1e-3)]
    geom.pos = list(origin + axis * (along.max() + along.min()) / 2)
    qx, qy, qz, qw = rotation_from_z((float(axis[0]), float(axis[1]), float(axis[2])))
    geom.quat = [qw, qx, qy, qz]
