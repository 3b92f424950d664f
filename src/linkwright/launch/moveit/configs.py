"""The parameters of a robot in MoveIt (``moveit_configs_utils.MoveItConfigs``)."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

Parameters = dict[str, Any]


@dataclass
class MoveItConfigs:
    """The parameters in groups, each a dictionary for the ``parameters`` of a node.

    Attributes:
        package_path: the share folder of the configuration package.
        robot_description: the URDF.
        robot_description_semantic: the SRDF.
        robot_description_kinematics: the inverse kinematics solvers.
        planning_pipelines: the planning pipelines and their planners.
        trajectory_execution: the controllers that execute trajectories.
        planning_scene_monitor: the parts of the planning scene that are published.
        sensors_3d: the sensors whose data forms the occupancy map.
        move_group_capabilities: additional capabilities of move_group.
        joint_limits: the limits that replace those in the URDF.
        moveit_cpp: the parameters of MoveItCpp.
        pilz_cartesian_limits: the limits for the Pilz planner.
    """

    package_path: Path | None = None
    robot_description: Parameters = field(default_factory=dict)
    robot_description_semantic: Parameters = field(default_factory=dict)
    robot_description_kinematics: Parameters = field(default_factory=dict)
    planning_pipelines: Parameters = field(default_factory=dict)
    trajectory_execution: Parameters = field(default_factory=dict)
    planning_scene_monitor: Parameters = field(default_factory=dict)
    sensors_3d: Parameters = field(default_factory=dict)
    move_group_capabilities: Parameters = field(
        default_factory=lambda: {"capabilities": "", "disable_capabilities": ""}
    )
    joint_limits: Parameters = field(default_factory=dict)
    moveit_cpp: Parameters = field(default_factory=dict)
    pilz_cartesian_limits: Parameters = field(default_factory=dict)

    @property
    def cartesian_limits(self) -> Parameters:
        """The value of `pilz_cartesian_limits`, under its former name."""
        return self.pilz_cartesian_limits

    def to_dict(self) -> Parameters:
        """Return the parameters of all groups except `move_group_capabilities` in one dictionary."""
        parameters: Parameters = {}
        for group in (
            self.robot_description,
            self.robot_description_semantic,
            self.robot_description_kinematics,
            self.planning_pipelines,
            self.trajectory_execution,
            self.planning_scene_monitor,
            self.sensors_3d,
            self.joint_limits,
            self.moveit_cpp,
        ):
            parameters.update(group)
        for name, limits in self.pilz_cartesian_limits.items():
            # The values are merged, because the Cartesian limits and the joint limits have the same parameter name.
            parameters[name] = {**(parameters.get(name) or {}), **(limits or {})}
        return parameters
