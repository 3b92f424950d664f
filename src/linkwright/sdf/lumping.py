"""Combines the mass properties of several links."""

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
    """Return the combined mass properties of a body's parts, or None if no part has any.

    The axes of the inertia tensor are the axes of the first part's mass properties, or of the body if the first part
    has none. Source of the axes: libsdformat's parser of URDF.
    """
    bodies = [_mass_properties(part.link.inertial).moved(pose_of(part.pose)) for part in parts if part.link.inertial]
    if not bodies:
        return None
    whole = combine(bodies)
    first = parts[0].link.inertial
    axes = Pose(rpy=first.origin.rpy, quaternion=first.origin.quaternion) if first else Pose()
    turn = np.array(rotation(axes))
    tensor = turn.T @ whole.inertia @ turn
    ixx, iyy, izz, ixy, ixz, iyz = (float(tensor[place]) for place in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)))
    x, y, z = map(float, whole.center)
    return Inertial(
        float(whole.mass), RawPose(Pose((x, y, z), axes.rpy, axes.quaternion)), Inertia(ixx, iyy, izz, ixy, ixz, iyz)
    )


def _mass_properties(inertial: urdf.Inertial) -> MassProperties:
    i = inertial
    tensor = np.array([[i.ixx, i.ixy, i.ixz], [i.ixy, i.iyy, i.iyz], [i.ixz, i.iyz, i.izz]])
    return MassProperties(i.mass, inertia=tensor).moved(i.origin)
