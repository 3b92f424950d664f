"""Joint controllers of gz, for positions and for velocities.

The systems are ``gz-sim-joint-position-controller-system`` and ``gz-sim-joint-controller-system``.

Source: gz-sim (parameters, topics, defaults, meaning of velocity commands). Commands are ``std_msgs/msg/Float64``,
which a bridge converts to messages of gz.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any, Generic, TypeVar

from linkwright.diagnostics import phrase
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.actuators import EXACT_VELOCITY_GAIN
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.pid import Gains, Pid
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_DEFAULT_MAX_COMMAND = 1000.0
"""The default of ``cmd_max`` in gz: no limit."""


@dataclass(frozen=True, kw_only=True)
class ControllerParameters:
    """Parameters of both controllers."""

    joint_name: tuple[str, ...] = parameter()
    topic: str = ""
    sub_topic: str = ""
    p_gain: float = 1.0
    i_gain: float = 0.0
    d_gain: float = 0.0
    i_max: float = 1.0
    i_min: float = -1.0
    cmd_max: float = _DEFAULT_MAX_COMMAND
    cmd_min: float = -_DEFAULT_MAX_COMMAND
    cmd_offset: float = 0.0

    @property
    def gains(self) -> Gains:
        """The gains of the PID controller."""
        return Gains(
            p=self.p_gain,
            i=self.i_gain,
            d=self.d_gain,
            i_min=self.i_min,
            i_max=self.i_max,
            cmd_min=self.cmd_min,
            cmd_max=self.cmd_max,
            cmd_offset=self.cmd_offset,
        )


@dataclass(frozen=True, kw_only=True)
class PositionParameters(ControllerParameters):
    """Parameters of ``gz-sim-joint-position-controller-system``."""

    joint_index: int = 0
    initial_position: float = 0.0
    use_velocity_commands: bool = False
    i_gain: float = 0.1
    d_gain: float = 0.01


@dataclass(frozen=True, kw_only=True)
class VelocityParameters(ControllerParameters):
    """Parameters of ``gz-sim-joint-controller-system``."""

    initial_velocity: float = 0.0
    use_force_commands: bool = False


P = TypeVar("P", bound=ControllerParameters)


class _JointController(SimulatedPlugin[P], Generic[P]):
    """A plugin that keeps joints at the commanded value `_command`: a position, or a velocity."""

    IGNORED = ("use_actuator_msg", "actuatorNumber")

    _command: float

    def _reset_motion(self) -> None:
        """Create a PID controller for each joint."""
        self._controllers = [Pid(self.parameters.gains) for _ in self._joints]

    def reset(self) -> None:
        """Restore the initial command, with new PID controllers."""
        self._reset_motion()

    def _find_joints(self) -> None:
        """Find the joints, and prevent the bodies that they move from sleeping."""
        simulation = self.simulation
        self._joints = [self.joint(name) for name in self.parameters.joint_name]
        for joint in self._joints:
            simulation.keep_awake(simulation.scene.joints[joint].child)

    def _subscribe_to_commands(self, topic_suffix: str) -> None:
        """Subscribe to the commands, on the configured topic or the first joint's default topic.

        `topic_suffix` is the end of the default topic's name.
        """
        parameters = self.parameters
        sub_topic = parameters.sub_topic or f"joint/{parameters.joint_name[0]}/{topic_suffix}"
        topic = parameters.topic or f"/model/{self.context.path}/{sub_topic}"
        command_guard = self.node.command_guard(self._stop_motion)
        self.node.subscribe(
            "std_msgs/msg/Float64", topic, self._on_command, command_guard=command_guard, stop_motion=self._stop_motion
        )
        self._reset_motion()

    def _on_command(self, message: Any) -> None:
        self._command = float(message.data)

    def _stop_motion(self) -> bool:
        """Stop a commanded motion, and return whether there was one.

        By default nothing stops, because a commanded position is held.
        """
        return False

    def _apply_forces(self, state_index: int) -> None:
        """Apply the PID forces of one step to the joints.

        `state_index` selects the controlled value: 0 for the position, 1 for the velocity.
        """
        seconds = self.simulation.step / NANOSECONDS_PER_SECOND
        for joint, controller in zip(self._joints, self._controllers, strict=True):
            error = self._command - self.simulation.joint_state(joint)[state_index]
            self.simulation.push_joint(joint, controller.force(error, seconds))


class GzJointPosition(_JointController[PositionParameters]):
    """The substitute for ``gz-sim-joint-position-controller-system``.

    With ``use_velocity_commands``, a joint moves directly to the commanded position and stays there under any load. Its
    speed is limited by the joint and ``cmd_max``. Without this parameter, a PID controller applies forces to the joint.
    """

    PARAMETERS = PositionParameters
    CARRIED = ("_command",)

    def start(self) -> None:
        """Find the joints, create any servos, and subscribe to the position commands."""
        parameters, simulation = self.parameters, self.simulation
        if parameters.joint_index:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': only the first axis of a joint is simulated; remove <joint_index>",
                    plugin=self.context.name,
                )
            )
        self._find_joints()
        self._servos = []
        if parameters.use_velocity_commands:
            max_speed = inf if parameters.cmd_max == _DEFAULT_MAX_COMMAND else parameters.cmd_max
            self._servos = [simulation.add_servo(joint, max_speed) for joint in self._joints]
        self._subscribe_to_commands("0/cmd_pos")
        self.every(0.0, self._move)

    def _reset_motion(self) -> None:
        super()._reset_motion()
        self._command = self.parameters.initial_position
        for servo in self._servos:
            servo.restart()

    def _move(self) -> None:
        if not self._servos:
            self._apply_forces(0)
        for servo in self._servos:
            servo.move(self._command, self.simulation.step / NANOSECONDS_PER_SECOND)


class GzJointVelocity(_JointController[VelocityParameters]):
    """The substitute for ``gz-sim-joint-controller-system``: velocity control of joints.

    A motor holds the velocity, or with ``use_force_commands`` a PID controller applies forces to the joint.
    """

    PARAMETERS = VelocityParameters

    def start(self) -> None:
        """Find the joints, create their motors, and subscribe to the commands."""
        self._find_joints()
        self._motors = []
        if not self.parameters.use_force_commands:
            self._motors = [
                self.simulation.add_velocity_motor(joint, EXACT_VELOCITY_GAIN, inf) for joint in self._joints
            ]
        self._subscribe_to_commands("cmd_vel")
        if self.parameters.use_force_commands:
            self.every(0.0, lambda: self._apply_forces(1))

    def _reset_motion(self) -> None:
        super()._reset_motion()
        self._set_velocity(self.parameters.initial_velocity)

    def resume(self, previous: SimulatedPlugin[VelocityParameters]) -> None:
        """Take over the velocity of the previous instance."""
        assert isinstance(previous, GzJointVelocity)
        self._set_velocity(previous._command)

    def _on_command(self, message: Any) -> None:
        self._set_velocity(float(message.data))

    def _stop_motion(self) -> bool:
        was_moving = self._command != 0.0
        self._set_velocity(0.0)
        return was_moving

    def _set_velocity(self, velocity: float) -> None:
        self._command = velocity
        for joint, motor in zip(self._joints, self._motors, strict=False):
            max_speed = self.simulation.scene.speed_limit(joint)
            motor.target = min(max(velocity, -max_speed), max_speed)
