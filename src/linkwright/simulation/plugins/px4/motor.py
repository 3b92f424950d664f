"""Rotors of PX4's models: ``libgazebo_motor_model.so`` and ``libgazebo_multirotor_base_plugin.so``.

A rotor differs from that of gz: the thrust decreases with the speed of the rotor along its axis, wind acts on it, it
may be reversible, and it can fail.

Source: PX4-SITL_gazebo-classic (parameters, defaults, formulas). Topics of Gazebo's transport are topics of ROS in the
namespace of the model. The speeds of the rotors are published, which PX4's plugin no longer does.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import copysign
from typing import Any, ClassVar

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.messages import Header, get_message
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.multicopter import GzMulticopterMotor, MotorParameters
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_ACTUATORS_TYPE = "actuator_msgs/msg/Actuators"
_FAILURE_TOPIC = "/gazebo/motor_failure_num"
_ROTOR_PATTERN = re.compile(r"rotor_(\d+)")
_SPEEDS_RATE_HZ = 100.0


@dataclass(frozen=True, kw_only=True)
class Px4MotorParameters(MotorParameters):
    """Parameters of ``libgazebo_motor_model.so``."""

    turning_direction: str = parameter("cw", aliases=("turningDirection",))
    command_topic: str = parameter("/gazebo/command/motor_speed", aliases=("commandSubTopic",))
    max_relative_airspeed: float = parameter(25.0, aliases=("maxRelativeAirspeed",))
    reversible: bool = False


class Px4Motor(GzMulticopterMotor):
    """The substitute for ``libgazebo_motor_model.so``.

    ``std_msgs/msg/Int32`` with the number of the motor plus 1 lets it fail, and 0 repairs it.
    """

    PARAMETERS = Px4MotorParameters
    IGNORED = ("motorSpeedPubTopic", "joint_control_pid", "robotNamespace")
    CARRIED = (*GzMulticopterMotor.CARRIED, "_has_failed")

    parameters: Px4MotorParameters

    def start(self) -> None:
        """Find the rotor, and subscribe to its speed commands and to failures.

        Raises:
            LinkwrightError: SIM133, SIM134, there is no such link or joint.
        """
        super().start()
        self.node.subscribe("std_msgs/msg/Int32", _FAILURE_TOPIC, self._on_failure)

    def reset(self) -> None:
        """Stop the rotor, and repair it."""
        super().reset()
        self._has_failed = False

    def limit_target(self, speed: float) -> float:
        """Return a commanded speed within the limits of the motor, in rad/s."""
        if self._has_failed:
            return 0.0
        return min(speed, self.parameters.max_rot_velocity)

    def compute_thrust(self, axial_velocity: float) -> float:
        """Return the thrust in N, which becomes 0 at the maximum airspeed."""
        parameters = self.parameters
        loss = min(abs(axial_velocity) / parameters.max_relative_airspeed, 1.0)
        thrust = parameters.motor_constant * self.speed**2 * (1.0 - loss)
        return copysign(thrust, self.speed) if parameters.reversible else thrust

    @property
    def wind(self) -> Array:
        """The velocity of the air in m/s in the axes of the world."""
        return np.array(self.simulation.wind)

    @property
    def rolling_sign(self) -> float:
        """The sign of the rolling moment, which follows the direction of rotation."""
        return -1.0 if self.parameters.turning_direction.strip().lower() == "cw" else 1.0

    def _on_failure(self, message: Any) -> None:
        self._has_failed = int(message.data) == self.parameters.actuator_number + 1


@dataclass(frozen=True, kw_only=True)
class MultirotorBaseParameters:
    """Parameters of ``libgazebo_multirotor_base_plugin.so``."""

    link_name: str = parameter("base_link", aliases=("linkName",))
    topic: str = parameter("/motors", aliases=("motorPubTopic",))
    slowdown: float = parameter(10.0, aliases=("rotorVelocitySlowdownSim",))


class MultirotorBase(SimulatedPlugin[MultirotorBaseParameters]):
    """The substitute for ``libgazebo_multirotor_base_plugin.so``: publishes the speeds of the rotors in rad/s.

    The rotors are the links ``rotor_0``, ``rotor_1``, ... below the link of the plugin.

    Attributes:
        joints: the joints of the rotors, in the order of their numbers.
    """

    PARAMETERS: ClassVar[type[Any]] = MultirotorBaseParameters

    def start(self) -> None:
        """Find the rotors, and create the topic of their speeds.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        base, numbers = self.link(self.parameters.link_name), {}
        for name, joint in self.simulation.scene.joints.items():
            match = _ROTOR_PATTERN.search(joint.child.rpartition(SEPARATOR)[2])
            if joint.parent == base and match is not None:
                numbers[int(match[1])] = name
        self.joints = [joint for _, joint in sorted(numbers.items())]
        namespace = self.text_in(self.context.element, "robotNamespace").strip("/") or self.context.path
        self._output = self.node.publisher(_ACTUATORS_TYPE, f"/{namespace}/{self.parameters.topic.lstrip('/')}")
        self.every(_SPEEDS_RATE_HZ, self.publish)

    def publish(self) -> None:
        """Publish the speeds of the rotors."""
        if not self._output.is_wanted:
            return
        speeds = [self.simulation.joint_state(joint)[1] * self.parameters.slowdown for joint in self.joints]
        message = get_message(_ACTUATORS_TYPE)(header=Header(stamp=self.stamp()), velocity=speeds)
        self._output.publish(message)
