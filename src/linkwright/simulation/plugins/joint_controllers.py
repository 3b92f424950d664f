"""Joints that go where, or as fast as, they are told: position and velocity controllers of gz.

Source: gz-sim (parameters, topics, defaults, what velocity commands mean). Commands are ``std_msgs/msg/Float64``, of
which a bridge makes the messages of gz.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.simulation import NANOSECONDS

_GAIN = 20.0
"""Torque of a motor in N m for each rad/s that its joint is too slow."""
_UNBOUNDED = 1000.0
"""The greatest command of gz where none is said."""


@dataclass(frozen=True, kw_only=True)
class PositionParameters:
    """Of the controller of positions."""

    joint_name: tuple[str, ...] = parameter()
    joint_index: int = 0
    topic: str = ""
    sub_topic: str = ""
    initial_position: float = 0.0
    use_velocity_commands: bool = False
    p_gain: float = 1.0
    i_gain: float = 0.1
    d_gain: float = 0.01
    i_max: float = 1.0
    i_min: float = -1.0
    cmd_max: float = _UNBOUNDED
    cmd_min: float = -_UNBOUNDED
    cmd_offset: float = 0.0


@dataclass(frozen=True, kw_only=True)
class VelocityParameters:
    """Of the controller of velocities."""

    joint_name: tuple[str, ...] = parameter()
    topic: str = ""
    sub_topic: str = ""
    initial_velocity: float = 0.0
    use_force_commands: bool = False
    p_gain: float = 1.0
    i_gain: float = 0.0
    d_gain: float = 0.0
    i_max: float = 1.0
    i_min: float = -1.0
    cmd_max: float = _UNBOUNDED
    cmd_min: float = -_UNBOUNDED
    cmd_offset: float = 0.0


class Pid:
    """A force of an error, by its size, its sum and its change; bounded."""

    def __init__(self, parameters: PositionParameters | VelocityParameters) -> None:
        self._given = parameters
        self._sum = 0.0
        self._before: float | None = None

    def force(self, error: float, seconds: float) -> float:
        """The force in N m (N) for what is wanted less what is there, so many seconds after the last one."""
        given = self._given
        self._sum = min(max(self._sum + given.i_gain * error * seconds, given.i_min), given.i_max)
        change = 0.0 if self._before is None else (error - self._before) / seconds
        self._before = error
        force = given.cmd_offset + given.p_gain * error + self._sum + given.d_gain * change
        return min(max(force, given.cmd_min), given.cmd_max)


class GzJointPosition(SimulatedPlugin[PositionParameters]):
    """``gz-sim-joint-position-controller-system``.

    With ``use_velocity_commands`` a joint goes straight to where it shall be, as fast as its limit and ``cmd_max``
    allow, and stays there whatever pulls at it. Without it a PID controller pushes it.
    """

    PARAMETERS = PositionParameters
    IGNORED = ("use_actuator_msg", "actuatorNumber")

    def start(self) -> None:
        """Find the joints, and hold them."""
        said, model, simulation = self.parameters, self.place.path, self.simulation
        if said.joint_index:
            raise self.refused(
                phrase("plugin '{plugin}': only the first axis of a joint is simulated", plugin=self.place.name)
            )
        self._joints = [self.joint(name) for name in said.joint_name]
        for joint in self._joints:
            simulation.keep_awake(simulation.scene.joints[joint].child)
        self._servos = []
        if said.use_velocity_commands:
            greatest = inf if said.cmd_max == _UNBOUNDED else said.cmd_max
            self._servos = [simulation.add_servo(joint, greatest) for joint in self._joints]
        topic = said.topic or f"/model/{model}/{said.sub_topic or f'joint/{said.joint_name[0]}/0/cmd_pos'}"
        self.node.subscribe("std_msgs/msg/Float64", topic, self._commanded)
        self._begin()
        self.every(0.0, self._push)

    def reset(self) -> None:
        """Hold the joints where they are held at the start."""
        self._begin()

    def _begin(self) -> None:
        self._wanted = self.parameters.initial_position
        self._controllers = [Pid(self.parameters) for _ in self._joints]
        for servo in self._servos:
            servo.restart()

    def _commanded(self, message: Any) -> None:
        self._wanted = float(message.data)

    def _push(self) -> None:
        seconds = self.simulation.step / NANOSECONDS
        if self._servos:
            for servo in self._servos:
                servo.move(self._wanted, seconds)
            return
        for joint, controller in zip(self._joints, self._controllers, strict=True):
            error = self._wanted - self.simulation.joint_state(joint)[0]
            self.simulation.push_joint(joint, controller.force(error, seconds))


class GzJointVelocity(SimulatedPlugin[VelocityParameters]):
    """``gz-sim-joint-controller-system``: a motor holds a velocity, or a PID controller pushes the joint."""

    PARAMETERS = VelocityParameters
    IGNORED = ("use_actuator_msg", "actuatorNumber")

    def start(self) -> None:
        """Find the joints, and give them motors."""
        said, model, simulation = self.parameters, self.place.path, self.simulation
        self._joints = [self.joint(name) for name in said.joint_name]
        for joint in self._joints:
            simulation.keep_awake(simulation.scene.joints[joint].child)
        self._motors = []
        if not said.use_force_commands:
            self._motors = [simulation.add_velocity_motor(joint, _GAIN, inf) for joint in self._joints]
        topic = said.topic or f"/model/{model}/{said.sub_topic or f'joint/{said.joint_name[0]}/cmd_vel'}"
        self.node.subscribe("std_msgs/msg/Float64", topic, self._commanded)
        self._begin()
        if said.use_force_commands:
            self.every(0.0, self._push)

    def reset(self) -> None:
        """Turn as at the start."""
        self._begin()

    def _begin(self) -> None:
        self._controllers = [Pid(self.parameters) for _ in self._joints]
        self._turn(self.parameters.initial_velocity)

    def _commanded(self, message: Any) -> None:
        self._turn(float(message.data))

    def _turn(self, velocity: float) -> None:
        self._wanted = velocity
        for motor in self._motors:
            motor.target = velocity

    def _push(self) -> None:
        seconds = self.simulation.step / NANOSECONDS
        for joint, controller in zip(self._joints, self._controllers, strict=True):
            error = self._wanted - self.simulation.joint_state(joint)[1]
            self.simulation.push_joint(joint, controller.force(error, seconds))
