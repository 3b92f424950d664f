"""Controllers that reach the positions of several joints by efforts or velocities, each joint with a PID controller.

Source: effort_controllers and velocity_controllers of ros_controllers (parameters ``JOINT.pid``, topic ``~/command``,
the command at the start, the shortest way of continuous joints), and their port to ROS 2 (``gains.JOINT``,
``~/commands``).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from linkwright.control.controllers.controller import Controller, InterfaceNames
from linkwright.control.controllers.single_joint_controllers import ClassicPid
from linkwright.control.hardware.interfaces import EFFORT, POSITION, VELOCITY
from linkwright.control.motion.pid import Pid
from linkwright.control.motion.trajectory import shortest_turn
from linkwright.diagnostics import phrase
from linkwright.nodes.parameter_tables import for_each, not_empty, parameter

_NO_GAINS = ClassicPid()


@dataclass(frozen=True, kw_only=True)
class JointPid:
    """The gains of a joint under the name of ROS 1."""

    pid: ClassicPid = _NO_GAINS


@dataclass(frozen=True, kw_only=True)
class JointGroupParameters:
    """Parameters of the controller."""

    joints: tuple[str, ...] = parameter((), read_only=True, description="the commanded joints", check=not_empty)
    gains: Mapping[str, ClassicPid] = for_each("joints", ClassicPid)
    classic_gains: Mapping[str, JointPid] = for_each("joints", JointPid, prefix="")

    def gains_of(self, joint: str) -> ClassicPid:
        """Return the gains of a joint, under the name of ROS 2 or else of ROS 1."""
        gains = self.gains[joint]
        return gains if gains.p or gains.i or gains.d else self.classic_gains[joint].pid


class _JointGroupPidController(Controller[JointGroupParameters]):
    """The base class of the controllers, which follow the positions on ``~/commands`` or ``~/command``."""

    PARAMETERS = JointGroupParameters
    COMMAND_INTERFACE: str
    """The interface of the joints that is commanded."""

    def command_interfaces(self) -> InterfaceNames:
        """Return the commanded interface of each joint."""
        return [f"{joint}/{self.COMMAND_INTERFACE}" for joint in self.parameters.joints]

    def state_interfaces(self) -> InterfaceNames:
        """Return the position of each joint."""
        return [f"{joint}/{POSITION}" for joint in self.parameters.joints]

    def on_configure(self) -> None:
        """Subscribe to the commands."""
        self._targets: list[float] = []
        for topic in ("~/commands", "~/command"):
            self.node.subscribe("std_msgs/msg/Float64MultiArray", topic, self._on_command)

    def on_activate(self) -> None:
        """Hold the joints at their positions."""
        parameters = self.parameters
        self._targets = [state.value for state in self.states]
        self._pids = [Pid(parameters.gains_of(joint).pid) for joint in parameters.joints]
        joints = self.robot.joints if self.robot is not None else {}
        self._are_continuous = [name in joints and joints[name].type == "continuous" for name in parameters.joints]

    def on_deactivate(self) -> None:
        """Command zero."""
        for command in self.commands:
            command.value = 0.0

    def update(self, time_ns: int, period_s: float) -> None:
        """Command each joint by its error."""
        parameters = self.parameters
        for index, (joint, pid) in enumerate(zip(parameters.joints, self._pids, strict=True)):
            measured, target = self.states[index].value, self._targets[index]
            error = shortest_turn(measured, target) if self._are_continuous[index] else target - measured
            pid.gains = parameters.gains_of(joint).pid
            self.commands[index].value = pid.command(error, period_s)

    def _on_command(self, message: Any) -> None:
        values, count = [float(value) for value in message.data], len(self.commands)
        if not count:
            return  # Commands are ignored while the controller is not active.
        if len(values) != count:
            self.node.logger.error(
                f"command size ({len(values)}) does not match number of interfaces ({count})",
                throttle_duration_sec=1.0,
            )
        elif any(value != value for value in values):
            self.node.logger.error(phrase("a command with NaN is not forwarded"), throttle_duration_sec=1.0)
        else:
            self._targets = values


class EffortJointGroupPositionController(_JointGroupPidController):
    """``effort_controllers/JointGroupPositionController``."""

    COMMAND_INTERFACE = EFFORT


class VelocityJointGroupPositionController(_JointGroupPidController):
    """``velocity_controllers/JointGroupPositionController``."""

    COMMAND_INTERFACE = VELOCITY
