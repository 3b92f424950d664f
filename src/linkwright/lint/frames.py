"""The poses of links with all joints at zero."""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.geometry.shapes import IDENTITY, Placement, placement
from linkwright.urdf import Robot
from linkwright.urdf.tree import walk


def compute_placements(robot: Robot) -> Mapping[str, Placement]:
    """Return each link's placement in the root link's frame with all joints at zero, by name."""
    poses = {robot.root: Placement(IDENTITY, (0.0, 0.0, 0.0))}
    for joint, _depth in walk(robot):
        if joint.child not in poses:
            poses[joint.child] = placement(joint.origin).inside(poses[joint.parent])
    return poses
