"""Frames of links that are bit-identical on every machine.

`linkwright.kinematics` is faster, but the last bit of its sines and matrix products depends on the processor.
"""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.geometry.exact_angles import exact_quaternion, sine_and_cosine
from linkwright.geometry.shapes import IDENTITY, Placement
from linkwright.geometry.single import Pose, length, normalized, rotation_matrix, scaled
from linkwright.kinematics import KinematicTree
from linkwright.kinematics.tree import MOVING_TYPES, resolve_mimics
from linkwright.urdf import Joint, Robot, children_of, parent_joints

_ORIGIN = Placement(IDENTITY, (0.0, 0.0, 0.0))


def placement_from_pose(pose: Pose) -> Placement:
    """Return the rotation and the position for a pose in a description."""
    quaternion = exact_quaternion(pose.rpy) if pose.quaternion is None else normalized(*pose.quaternion)
    return Placement(rotation_matrix(quaternion), pose.xyz)


def compute_link_frames(robot: Robot, positions: Mapping[str, float]) -> dict[str, Placement]:
    """Return the frames of all links in the root link's frame, by link name.

    Args:
        robot: the robot. Links that are not connected to its root are left out.
        positions: joint positions in rad or m by name. A joint that is missing has position 0, or the middle of its
            limits if these exclude 0, as joint_state_publisher starts.

    Raises:
        UnknownNameError: KIN101 or KIN102, a name is not that of a joint that has a position.
    """
    KinematicTree(robot).positions(positions)  # raises an error for unknown names
    moving_joints = [joint.name for joint in robot.joints.values() if joint.type in MOVING_TYPES]
    independent_joints, relations = resolve_mimics(robot, moving_joints)
    leaders = {name: positions.get(name, choose_start_position(robot.joints[name])) for name in independent_joints}
    values = {
        name: relation.factor * leaders[relation.leader] + relation.offset
        for name, relation in relations.items()
        if relation.leader in leaders
    }
    children, joints_by_child = children_of(robot), parent_joints(robot)
    frames = {robot.root: _ORIGIN}
    pending = [robot.root]
    while pending:
        parent = pending.pop()
        for joint in children[parent]:
            if joints_by_child[joint.child] is joint and joint.child not in frames:
                motion = _compute_motion(joint, values.get(joint.name, 0.0))
                frames[joint.child] = motion.inside(placement_from_pose(joint.origin).inside(frames[parent]))
                pending.append(joint.child)
    return frames


def choose_start_position(joint: Joint) -> float:
    """Return 0, or the middle of the limits of a joint whose limits exclude 0."""
    if joint.limit is None or joint.type == "continuous" or joint.limit.lower <= 0.0 <= joint.limit.upper:
        return 0.0
    return (joint.limit.lower + joint.limit.upper) / 2.0


def _compute_motion(joint: Joint, position: float) -> Placement:
    """Return the frame of a joint's child link in the frame of the joint at position 0."""
    norm = length(joint.axis)
    if joint.type not in MOVING_TYPES or not norm > 0.0:
        return _ORIGIN
    axis = scaled(joint.axis, 1.0 / norm)
    if joint.type == "prismatic":
        return Placement(IDENTITY, scaled(axis, position))
    sine, cosine = sine_and_cosine(position / 2.0)
    x, y, z = scaled(axis, sine)
    return Placement(rotation_matrix((x, y, z, cosine)), (0.0, 0.0, 0.0))
