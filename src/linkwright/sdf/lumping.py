"""Combine the mass properties of several links."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from linkwright.geometry.mass import MassProperties, combine
from linkwright.geometry.shapes import rotation
from linkwright.geometry.single import Pose
from linkwright.sdf.bodies import Part
from linkwright.sdf.frames import pose_of
from linkwright.sdf.links import Inertia, Inertial
from linkwright.sdf.poses import RawPose
from linkwright.urdf import model as urdf


def lump_inertials(parts: Sequence[Part]) -> Inertial | None:
    """Return the combined mass properties of a body's parts, or None if no part has a mass.

    The axes of the inertia tensor are those of the first part's inertial frame, or of the body if the first part has no
    mass. Source of these axes: libsdformat's URDF parser.
    """
    part_properties = [
        _compute_mass_properties(part.link.inertial).moved(pose_of(part.pose)) for part in parts if part.link.inertial
    ]
    if not part_properties:
        return None
    combined = combine(part_properties)
    first_inertial = parts[0].link.inertial
    axes = (
        Pose(rpy=first_inertial.origin.rpy, quaternion=first_inertial.origin.quaternion) if first_inertial else Pose()
    )
    rotation_matrix = np.array(rotation(axes))
    tensor = rotation_matrix.T @ combined.inertia @ rotation_matrix
    ixx, iyy, izz, ixy, ixz, iyz = (float(tensor[index]) for index in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)))
    x, y, z = map(float, combined.center)
    return Inertial(
        float(combined.mass), RawPose(Pose((x, y, z), axes.rpy, axes.quaternion)), Inertia(ixx, iyy, izz, ixy, ixz, iyz)
    )


def _compute_mass_properties(inertial: urdf.Inertial) -> MassProperties:
    i = inertial
    tensor = np.array([[i.ixx, i.ixy, i.ixz], [i.ixy, i.iyy, i.iyz], [i.ixz, i.iyz, i.izz]])
    return MassProperties(i.mass, inertia=tensor).moved(i.origin)
