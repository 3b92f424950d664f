"""Trajectory controllers with their type names of ROS 1, which name the command interface.

Source: position_controllers, velocity_controllers and effort_controllers of ros_controllers.
"""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.control.controllers.joint_trajectory_controller import JointTrajectoryController
from linkwright.control.controllers.joint_trajectory_parameters import Parameters
from linkwright.control.hardware.interfaces import EFFORT, POSITION, VELOCITY
from linkwright.nodes.parameter_tables import parameter

_STATES = (POSITION, VELOCITY)


@dataclass(frozen=True, kw_only=True)
class PositionParameters(Parameters):
    """Parameters of ``position_controllers/JointTrajectoryController``."""

    command_interfaces: tuple[str, ...] = parameter((POSITION,), read_only=True, description="the command interface")
    state_interfaces: tuple[str, ...] = parameter(_STATES, read_only=True, description="the state interfaces")


@dataclass(frozen=True, kw_only=True)
class VelocityParameters(PositionParameters):
    """Parameters of ``velocity_controllers/JointTrajectoryController``."""

    command_interfaces: tuple[str, ...] = parameter((VELOCITY,), read_only=True, description="the command interface")


@dataclass(frozen=True, kw_only=True)
class EffortParameters(PositionParameters):
    """Parameters of ``effort_controllers/JointTrajectoryController``."""

    command_interfaces: tuple[str, ...] = parameter((EFFORT,), read_only=True, description="the command interface")


class _ClassicTrajectoryController(JointTrajectoryController):
    """A trajectory controller that also receives ``~/command``, the topic of ROS 1."""

    def on_configure(self) -> None:
        """Create the topics, the service and the action."""
        super().on_configure()
        self.node.subscribe("trajectory_msgs/msg/JointTrajectory", "~/command", self._on_trajectory)


class PositionTrajectoryController(_ClassicTrajectoryController):
    """``position_controllers/JointTrajectoryController``."""

    PARAMETERS = PositionParameters


class VelocityTrajectoryController(_ClassicTrajectoryController):
    """``velocity_controllers/JointTrajectoryController``."""

    PARAMETERS = VelocityParameters


class EffortTrajectoryController(_ClassicTrajectoryController):
    """``effort_controllers/JointTrajectoryController``."""

    PARAMETERS = EffortParameters
