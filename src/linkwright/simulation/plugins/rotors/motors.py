"""Rotors of RotorS: ``librotors_gazebo_motor_model.so``, and the plugins that carry their commands and speeds.

They are ``librotors_gazebo_controller_interface.so`` and ``librotors_gazebo_multirotor_base_plugin.so``.

Source: rotors_simulator (parameters, defaults, topics). ``actuator_msgs/msg/Actuators`` replaces
``mav_msgs/Actuators``, whose angular velocities are its ``velocity``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.messages import Header, get_message
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.multicopter import GzMulticopterMotor, MotorParameters
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.px4.motor import MultirotorBase, MultirotorBaseParameters

_ACTUATORS_TYPE = "actuator_msgs/msg/Actuators"
_COMMAND_TOPIC = "gazebo/command/motor_speed"


@dataclass(frozen=True, kw_only=True)
class RotorsMotorParameters(MotorParameters):
    """Parameters of ``librotors_gazebo_motor_model.so``."""

    command_topic: str = parameter(_COMMAND_TOPIC, aliases=("commandSubTopic",))


class RotorsMotor(GzMulticopterMotor):
    """The substitute for ``librotors_gazebo_motor_model.so``, on which the wind of the world acts."""

    PARAMETERS = RotorsMotorParameters
    IGNORED = (*GzMulticopterMotor.IGNORED, "windSpeedSubTopic")

    @property
    def wind(self) -> Array:
        """The velocity of the air in m/s in the axes of the world."""
        return np.array(self.simulation.wind)


@dataclass(frozen=True, kw_only=True)
class ControllerInterfaceParameters:
    """Parameters of ``librotors_gazebo_controller_interface.so``."""

    command_topic: str = parameter("command/motor_speed", aliases=("commandMotorSpeedSubTopic",))
    motor_topic: str = parameter(_COMMAND_TOPIC, aliases=("motorSpeedCommandPubTopic",))


class ControllerInterface(SimulatedPlugin[ControllerInterfaceParameters]):
    """The substitute for ``librotors_gazebo_controller_interface.so``: passes commands on to the motors."""

    PARAMETERS = ControllerInterfaceParameters
    IGNORED = ("commandAttitudeThrustSubTopic", "commandRateThrustSubTopic", "imuSubTopic")

    def start(self) -> None:
        """Create the topics."""
        parameters = self.parameters
        self._output = self.node.publisher(_ACTUATORS_TYPE, name_topic(self, parameters.motor_topic))
        self.node.subscribe(_ACTUATORS_TYPE, name_topic(self, parameters.command_topic), self._on_command)

    def _on_command(self, message: Any) -> None:
        command = get_message(_ACTUATORS_TYPE)(header=Header(stamp=self.stamp()), velocity=list(message.velocity))
        self._output.publish(command)


@dataclass(frozen=True, kw_only=True)
class RotorsBaseParameters(MultirotorBaseParameters):
    """Parameters of ``librotors_gazebo_multirotor_base_plugin.so``."""

    topic: str = parameter("motor_speed", aliases=("motorPubTopic",))


class RotorsBase(MultirotorBase):
    """The substitute for ``librotors_gazebo_multirotor_base_plugin.so``, which publishes joint states, too."""

    PARAMETERS = RotorsBaseParameters

    def start(self) -> None:
        """Find the rotors, and create the topics.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        self._states = self.node.publisher("sensor_msgs/msg/JointState", name_topic(self, "joint_states"))
        super().start()

    def publish(self) -> None:
        """Publish the speeds and the positions of the rotors."""
        super().publish()
        if self._states.is_wanted:
            names = [joint.rpartition(SEPARATOR)[2] for joint in self.joints]
            positions = [self.simulation.joint_state(joint)[0] for joint in self.joints]
            header = Header(stamp=self.stamp(), frame_id=self.parameters.link_name)
            self._states.publish(
                get_message("sensor_msgs/msg/JointState")(header=header, name=names, position=positions)
            )


def name_topic(plugin: SimulatedPlugin[Any], name: str) -> str:
    """Return a topic in the namespace of a plugin, by default that of its model."""
    namespace = plugin.text_in(plugin.context.element, "robotNamespace").strip("/")
    return f"/{namespace or plugin.context.path.partition(SEPARATOR)[0]}/{name.lstrip('/')}"
