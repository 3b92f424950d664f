"""Controllers of ROS 1 that command one joint by a number on ``~/command``.

In ROS 2, `JointGroup...Controller` and `PidController` take their place.

Source: position_controllers, velocity_controllers and effort_controllers of ros_controllers (parameters, topic, the
command at the start, the shortest way of continuous joints, integral terms of 0 without a bound).
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace
from math import isfinite, nan
from typing import Any, Generic, TypeVar

from linkwright.control.controllers.controller import Controller, InterfaceNames
from linkwright.control.controllers.pid_parameters import PidParameters
from linkwright.control.hardware.interfaces import EFFORT, POSITION, VELOCITY
from linkwright.control.motion.pid import Pid, PidGains
from linkwright.control.motion.trajectory import shortest_turn
from linkwright.diagnostics import phrase
from linkwright.nodes.parameter_tables import not_empty, parameter


@dataclass(frozen=True, kw_only=True)
class JointParameters:
    """Parameters of a controller of one joint."""

    joint: str = parameter("", read_only=True, description="the commanded joint", check=not_empty)


@dataclass(frozen=True, kw_only=True)
class ClassicPid(PidParameters):
    """The gains of a PID controller of ROS 1.

    Without a bound, the integral term is 0.
    """

    @property
    def pid(self) -> PidGains:
        """The gains as `PidGains`."""
        clamp = abs(self.i_clamp or 0.0)
        low, high = self.i_clamp_min, self.i_clamp_max
        return replace(
            super().pid,
            i_min=-abs(low) if isfinite(low) else -clamp,
            i_max=abs(high) if isfinite(high) else clamp,
        )


@dataclass(frozen=True, kw_only=True)
class PidJointParameters(JointParameters):
    """Parameters of a controller of one joint with a PID controller."""

    pid: ClassicPid = ClassicPid()


P = TypeVar("P", bound=JointParameters)


class _SingleJointController(Controller[P], Generic[P]):
    """The base class of controllers that follow the number on ``~/command``."""

    COMMAND_INTERFACE: str
    """The interface of the joint that is commanded."""
    CONTROLLED_INTERFACE: str
    """The kind of the number on ``~/command``."""

    def command_interfaces(self) -> InterfaceNames:
        """Return the interface of the joint that is commanded."""
        return [f"{self.parameters.joint}/{self.COMMAND_INTERFACE}"]

    def state_interfaces(self) -> InterfaceNames:
        """Return the measured value that the command refers to."""
        return [f"{self.parameters.joint}/{self.CONTROLLED_INTERFACE}"]

    def on_configure(self) -> None:
        """Subscribe to the commands."""
        self._target = nan
        command_guard = self.node.command_guard(self._stop_motion)
        self.node.subscribe("std_msgs/msg/Float64", "~/command", self._on_command, command_guard=command_guard)

    def on_activate(self) -> None:
        """Start at the current position, or at 0."""
        self._target = self.states[0].value if self.CONTROLLED_INTERFACE == POSITION else 0.0

    def on_deactivate(self) -> None:
        """Command zero, unless positions are commanded."""
        if self.COMMAND_INTERFACE != POSITION:
            self.commands[0].value = 0.0

    def update(self, time_ns: int, period_s: float) -> None:
        """Command the joint."""
        self.commands[0].value = self._compute_command(period_s)

    @abstractmethod
    def _compute_command(self, period_s: float) -> float:
        """Return the command of the joint; NaN for no command."""

    def _on_command(self, message: Any) -> None:
        if not self.commands:
            return  # Commands are ignored while the controller is not active.
        if not isfinite(message.data):
            self.node.logger.error(phrase("a command with NaN is not forwarded"), throttle_duration_sec=1.0)
            return
        self._target = float(message.data)

    def _stop_motion(self) -> bool:
        """Stop a commanded velocity, and return whether there was one."""
        if self.CONTROLLED_INTERFACE != VELOCITY or not abs(self._target) > 0.0:
            return False
        self._target = 0.0
        return True


class _ForwardingController(_SingleJointController[JointParameters]):
    PARAMETERS = JointParameters

    def state_interfaces(self) -> InterfaceNames:
        """Return the position where the controller starts, or none if it starts at 0."""
        return super().state_interfaces() if self.CONTROLLED_INTERFACE == POSITION else ()

    def _compute_command(self, period_s: float) -> float:
        return self._target


class JointPositionController(_ForwardingController):
    """``position_controllers/JointPositionController``."""

    COMMAND_INTERFACE = CONTROLLED_INTERFACE = POSITION


class JointVelocityController(_ForwardingController):
    """``velocity_controllers/JointVelocityController``."""

    COMMAND_INTERFACE = CONTROLLED_INTERFACE = VELOCITY


class JointEffortController(_ForwardingController):
    """``effort_controllers/JointEffortController``."""

    COMMAND_INTERFACE = CONTROLLED_INTERFACE = EFFORT


class _PidController(_SingleJointController[PidJointParameters]):
    PARAMETERS = PidJointParameters

    def on_activate(self) -> None:
        """Start at the current position or at 0, with new errors."""
        super().on_activate()
        self._pid = Pid(self.parameters.pid.pid)
        joint = self.robot.joints.get(self.parameters.joint) if self.robot is not None else None
        self._is_continuous = self.CONTROLLED_INTERFACE == POSITION and joint is not None and joint.type == "continuous"

    def _compute_command(self, period_s: float) -> float:
        self._pid.gains = self.parameters.pid.pid
        measured = self.states[0].value
        error = shortest_turn(measured, self._target) if self._is_continuous else self._target - measured
        return self._pid.command(error, period_s)


class EffortPositionController(_PidController):
    """``effort_controllers/JointPositionController``."""

    COMMAND_INTERFACE, CONTROLLED_INTERFACE = EFFORT, POSITION


class EffortVelocityController(_PidController):
    """``effort_controllers/JointVelocityController``."""

    COMMAND_INTERFACE, CONTROLLED_INTERFACE = EFFORT, VELOCITY


class VelocityPositionController(_PidController):
    """``velocity_controllers/JointPositionController``."""

    COMMAND_INTERFACE, CONTROLLED_INTERFACE = VELOCITY, POSITION
