"""Contacts: ``gazebo_ros_bumper``.

Source: gazebo_ros_pkgs for ROS 2 and ROS 1 (parameters, topics, the frame that forces are told in).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.geometry.arrays import Array
from linkwright.messages import get_message
from linkwright.sdf.poses import WORLD
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, OneTopic, vector
from linkwright.simulation.sensors.contact import Contact, ContactSensor

_TYPE = "gazebo_msgs/msg/ContactsState"


@dataclass(frozen=True, kw_only=True)
class BumperParameters:
    """Of ``gazebo_ros_bumper``."""

    frame_name: str = parameter(WORLD, aliases=("frameName",))
    topic_name: str = parameter("bumper_states", aliases=("bumperTopicName", "bumper_topic_name"))


class ClassicBumper(OneTopic[BumperParameters]):
    """``libgazebo_ros_bumper.so``: positions and forces are those in the world, whatever frame the message names."""

    PARAMETERS = BumperParameters

    def make_sensor(self) -> None:
        """Make what listens to the collision that the sensor names."""
        said = self.sensor.sensor.contact
        named = [] if said is None or said.collision == "__default__" else [said.collision]
        self._sensor = ContactSensor(self.mount, named)

    def make_topics(self) -> None:
        """Make the topic."""
        self.output = self.node.publisher(_TYPE, self.parameters.topic_name, SENSOR_QOS)

    def measure(self) -> None:
        """Measure and publish, also where nothing touches."""
        message = self.message(_TYPE, self.parameters.frame_name)
        message.states = [_state(contact) for contact in self._sensor.measure()]
        self.output.publish(message)


def _state(contact: Contact) -> Any:
    state = get_message("gazebo_msgs/msg/ContactState")()
    state.collision1_name, state.collision2_name = contact.collision1, contact.collision2
    state.wrenches = [wrench(*pair) for pair in zip(contact.forces, contact.torques, strict=True)]
    state.total_wrench = wrench(contact.forces.sum(axis=0), contact.torques.sum(axis=0))
    state.contact_positions = [vector(each) for each in contact.positions]
    state.contact_normals = [vector(each) for each in contact.normals]
    state.depths = [float(each) for each in contact.depths]
    return state


def wrench(force: Array, torque: Array) -> Any:
    """A force in N and a torque in N m as a message."""
    return get_message("geometry_msgs/msg/Wrench")(force=vector(force), torque=vector(torque))
