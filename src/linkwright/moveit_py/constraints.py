"""Messages of goals and path constraints (``moveit.core.kinematic_constraints``)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from linkwright.messages import get_message
from linkwright.moveit_py.robot_model import JointModelGroup
from linkwright.moveit_py.robot_state import RobotState

_SPHERE = 2


def construct_joint_constraint(
    robot_state: RobotState, joint_model_group: JointModelGroup, tolerance: float = 0.01
) -> Any:
    """Return a moveit_msgs/msg/Constraints with the positions of a group's joints.

    Args:
        robot_state: the state with the positions.
        joint_model_group: the group.
        tolerance: the tolerance in both directions, in rad or m.
    """
    message = get_message("moveit_msgs/msg/Constraints")()
    joint_class = get_message("moveit_msgs/msg/JointConstraint")
    positions = robot_state.joint_positions
    for name in joint_model_group.joint_model_names:
        joint = joint_class()
        joint.joint_name, joint.position, joint.weight = name, positions[name], 1.0
        joint.tolerance_above = joint.tolerance_below = tolerance
        message.joint_constraints.append(joint)
    return message


def construct_link_constraint(
    link_name: str,
    source_frame: str,
    cartesian_position: Sequence[float] | None = None,
    cartesian_position_tolerance: float | None = None,
    orientation: Sequence[float] | None = None,
    orientation_tolerance: float | None = None,
) -> Any:
    """Return a moveit_msgs/msg/Constraints for the position or orientation of a link, or for both.

    Args:
        link_name: the link.
        source_frame: the frame of the position and of the orientation.
        cartesian_position: x, y and z in m.
        cartesian_position_tolerance: the radius in m of the sphere around the position.
        orientation: the quaternion x, y, z, w.
        orientation_tolerance: the maximum rotation about each axis in rad.

    Raises:
        ValueError: neither the position nor the orientation has a value and a tolerance.
    """
    message = get_message("moveit_msgs/msg/Constraints")()
    if cartesian_position is not None and cartesian_position_tolerance is not None:
        message.position_constraints.append(
            _position_constraint(link_name, source_frame, cartesian_position, cartesian_position_tolerance)
        )
    if orientation is not None and orientation_tolerance is not None:
        constraint = get_message("moveit_msgs/msg/OrientationConstraint")()
        constraint.header.frame_id, constraint.link_name, constraint.weight = source_frame, link_name, 1.0
        target = constraint.orientation
        target.x, target.y, target.z, target.w = map(float, orientation)
        constraint.absolute_x_axis_tolerance = orientation_tolerance
        constraint.absolute_y_axis_tolerance = orientation_tolerance
        constraint.absolute_z_axis_tolerance = orientation_tolerance
        message.orientation_constraints.append(constraint)
    if not message.position_constraints and not message.orientation_constraints:
        raise ValueError("give a position or an orientation, each with its tolerance")
    return message


def _position_constraint(link: str, frame: str, position: Sequence[float], radius: float) -> Any:
    constraint = get_message("moveit_msgs/msg/PositionConstraint")()
    constraint.header.frame_id, constraint.link_name, constraint.weight = frame, link, 1.0
    sphere = get_message("shape_msgs/msg/SolidPrimitive")()
    sphere.type, sphere.dimensions = _SPHERE, [float(radius)]
    pose = get_message("geometry_msgs/msg/Pose")()
    pose.position.x, pose.position.y, pose.position.z = map(float, position)
    constraint.constraint_region.primitives = [sphere]
    constraint.constraint_region.primitive_poses = [pose]
    return constraint
