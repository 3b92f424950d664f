"""The YAML files of a MoveIt configuration package."""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.planning.groups import joint_limits
from linkwright.planning.setup.groups import PlanningGroup, RobotGroups
from linkwright.planning.setup.yaml_text import quote_yaml, yaml_list, yaml_number
from linkwright.urdf import Robot

DISTRIBUTIONS = ("humble", "jazzy")
_TRAJECTORY_CONTROLLER = "joint_trajectory_controller/JointTrajectoryController"
_GRIPPER_CONTROLLER = "position_controllers/GripperActionController"
_PLANNERS = {
    "RRTConnectkConfigDefault": "geometric::RRTConnect",
    "RRTkConfigDefault": "geometric::RRT",
    "RRTstarkConfigDefault": "geometric::RRTstar",
    "PRMkConfigDefault": "geometric::PRM",
    "PRMstarkConfigDefault": "geometric::PRMstar",
    "BITstarkConfigDefault": "geometric::BITstar",
    "KPIECEkConfigDefault": "geometric::KPIECE",
}

CARTESIAN_LIMITS = """\
# The limits of the tip for the motions LIN and CIRC of the Pilz planner, in m/s, m/s2 and rad/s
cartesian_limits:
  max_trans_vel: 1.0
  max_trans_acc: 2.25
  max_trans_dec: -5.0
  max_rot_vel: 1.57
"""
_OMPL_HUMBLE = """\
planning_plugin: ompl_interface/OMPLPlanner
request_adapters: >-
  default_planner_request_adapters/AddTimeOptimalParameterization
  default_planner_request_adapters/ResolveConstraintFrames
  default_planner_request_adapters/FixWorkspaceBounds
  default_planner_request_adapters/FixStartStateBounds
  default_planner_request_adapters/FixStartStateCollision
  default_planner_request_adapters/FixStartStatePathConstraints
start_state_max_bounds_error: 0.1
"""
_REQUEST_ADAPTERS_JAZZY = """\
request_adapters:
  - default_planning_request_adapters/ResolveConstraintFrames
  - default_planning_request_adapters/ValidateWorkspaceBounds
  - default_planning_request_adapters/CheckStartStateBounds
  - default_planning_request_adapters/CheckStartStateCollision
"""
_OMPL_JAZZY = f"""\
planning_plugins:
  - ompl_interface/OMPLPlanner
{_REQUEST_ADAPTERS_JAZZY}response_adapters:
  - default_planning_response_adapters/AddTimeOptimalParameterization
  - default_planning_response_adapters/ValidateSolution
  - default_planning_response_adapters/DisplayMotionPath
"""
_PILZ_HUMBLE = """\
planning_plugin: pilz_industrial_motion_planner/CommandPlanner
request_adapters: ""
"""
_PILZ_JAZZY = f"""\
planning_plugins:
  - pilz_industrial_motion_planner/CommandPlanner
{_REQUEST_ADAPTERS_JAZZY}response_adapters:
  - default_planning_response_adapters/ValidateSolution
  - default_planning_response_adapters/DisplayMotionPath
"""
_PILZ_REST = """\
default_planner_config: PTP
capabilities: >-
  pilz_industrial_motion_planner/MoveGroupSequenceAction
  pilz_industrial_motion_planner/MoveGroupSequenceService
"""


def initial_positions(positions: Mapping[str, float]) -> str:
    """Return ``initial_positions.yaml``: where the simulated hardware starts, in rad or m."""
    lines = [f"  {quote_yaml(name)}: {yaml_number(value)}" for name, value in positions.items()]
    return "\n".join(["# Where the simulated joints start, in rad or m", "initial_positions:", *lines, ""])


def limits(robot: Robot, groups: RobotGroups) -> str:
    """Return ``joint_limits.yaml``, with the velocities of the description."""
    lines = [
        "# Limits that replace those of the robot description. Limits of acceleration, which it does not have, take",
        "# effect with has_acceleration_limits: true.",
        "default_velocity_scaling_factor: 0.1",
        "default_acceleration_scaling_factor: 0.1",
        "",
        "joint_limits:",
    ]
    for name in dict.fromkeys(name for group in groups.groups for name in group.joints):
        velocity = joint_limits(robot.joints[name]).max_velocity
        lines += [
            f"  {quote_yaml(name)}:",
            "    has_velocity_limits: true",
            f"    max_velocity: {yaml_number(velocity)}",
            "    has_acceleration_limits: false",
            "    max_acceleration: 0.0",
        ]
    return "\n".join([*lines, ""])


def kinematics(groups: RobotGroups) -> str:
    """Return ``kinematics.yaml``: a solver for each chain."""
    entries = [
        f"{quote_yaml(group.name)}:\n"
        "  kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin\n"
        "  kinematics_solver_search_resolution: 0.005\n"
        "  kinematics_solver_timeout: 0.05\n"
        for group in groups.groups
        if group.is_chain
    ]
    return "".join(entries) or "{}\n"


def moveit_controllers(groups: RobotGroups) -> str:
    """Return ``moveit_controllers.yaml``: the controllers that execute trajectories."""
    controlled = _controlled_groups(groups)
    lines = [
        "# The controllers with which MoveIt executes trajectories",
        "moveit_controller_manager: moveit_simple_controller_manager/MoveItSimpleControllerManager",
        "",
        "moveit_simple_controller_manager:",
        "  controller_names:",
        yaml_list(map(_controller_name, controlled), 4),
    ]
    for group in controlled:
        is_gripper = _has_gripper_controller(group)
        lines += [
            "",
            f"  {quote_yaml(_controller_name(group))}:",
            f"    type: {'GripperCommand' if is_gripper else 'FollowJointTrajectory'}",
            f"    action_ns: {'gripper_cmd' if is_gripper else 'follow_joint_trajectory'}",
            "    default: true",
            "    joints:",
            yaml_list(group.active_joints, 6),
        ]
    return "\n".join([*lines, ""])


def ros2_controllers(groups: RobotGroups) -> str:
    """Return ``ros2_controllers.yaml``: the controllers of ros2_control and their parameters."""
    controlled = _controlled_groups(groups)
    lines = [
        "# The controllers of ros2_control",
        "controller_manager:",
        "  ros__parameters:",
        "    update_rate: 100  # Hz",
        "",
    ]
    for group in controlled:
        kind = _GRIPPER_CONTROLLER if _has_gripper_controller(group) else _TRAJECTORY_CONTROLLER
        lines += [f"    {quote_yaml(_controller_name(group))}:", f"      type: {kind}", ""]
    lines += ["    joint_state_broadcaster:", "      type: joint_state_broadcaster/JointStateBroadcaster"]
    for group in controlled:
        lines += ["", f"{quote_yaml(_controller_name(group))}:", "  ros__parameters:"]
        if _has_gripper_controller(group):
            lines.append(f"    joint: {quote_yaml(group.active_joints[0])}")
            continue
        lines += [
            "    joints:",
            yaml_list(group.active_joints, 6),
            "    command_interfaces:",
            "      - position",
            "    state_interfaces:",
            "      - position",
            "      - velocity",
            "    allow_nonzero_velocity_at_trajectory_end: true",
        ]
    return "\n".join([*lines, ""])


def planning_pipelines(groups: RobotGroups, distribution: str) -> dict[str, str]:
    """Return the files of the planning pipelines, by path.

    Args:
        groups: the groups.
        distribution: the distribution of ROS 2, whose format the files have.
    """
    is_humble = distribution == "humble"
    return {
        "config/ompl_planning.yaml": (_OMPL_HUMBLE if is_humble else _OMPL_JAZZY) + _planner_configs(groups),
        "config/pilz_industrial_motion_planner_planning.yaml": (_PILZ_HUMBLE if is_humble else _PILZ_JAZZY)
        + _PILZ_REST,
    }


def _planner_configs(groups: RobotGroups) -> str:
    lines = ["planner_configs:"]
    for name, kind in _PLANNERS.items():
        lines += [f"  {name}:", f"    type: {kind}"]
    for group in groups.groups:
        if group.active_joints:
            lines += [f"{quote_yaml(group.name)}:", "  default_planner_config: RRTConnectkConfigDefault"]
            lines += ["  planner_configs:", yaml_list(_PLANNERS, 4)]
    return "\n".join([*lines, ""])


def _controlled_groups(groups: RobotGroups) -> list[PlanningGroup]:
    """Return the groups that get a controller: those whose joints no group before them has."""
    controlled: list[PlanningGroup] = []
    taken: set[str] = set()
    for group in groups.groups:
        if group.active_joints and not taken.intersection(group.active_joints):
            controlled.append(group)
            taken.update(group.active_joints)
    return controlled


def _controller_name(group: PlanningGroup) -> str:
    return f"{group.name}_controller"


def _has_gripper_controller(group: PlanningGroup) -> bool:
    return group.is_end_effector and len(group.active_joints) == 1
