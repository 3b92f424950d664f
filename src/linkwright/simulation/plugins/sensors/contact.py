"""Contact sensors: ``gazebo_ros_bumper``, and ``contact`` of gz.

Source: gazebo_ros_pkgs for ROS 2 and ROS 1 (parameters, topics, the frame of forces), gz-sim (topic, the condition for
a message), ros_gz (messages).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from linkwright.geometry.arrays import Array
from linkwright.messages import get_message
from linkwright.sdf.poses import WORLD
from linkwright.simulation.plugins.parameters import NoParameters, parameter
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, SingleTopicSensor, vector_to_message
from linkwright.simulation.sensors.contact import Contact, ContactSensor

P = TypeVar("P")
_STATE_TYPE, _CONTACTS_TYPE = "gazebo_msgs/msg/ContactsState", "ros_gz_interfaces/msg/Contacts"
_DEFAULT_TOPIC = "__default_topic__"


@dataclass(frozen=True, kw_only=True)
class BumperParameters:
    """Parameters of ``gazebo_ros_bumper``."""

    frame_name: str = parameter(WORLD, aliases=("frameName",))
    topic_name: str = parameter("bumper_states", aliases=("bumperTopicName", "bumper_topic_name"))


class ContactPlugin(SingleTopicSensor[P], Generic[P]):
    """A sensor that measures the contacts of one collision, or of all collisions of its link."""

    def create_sensor(self) -> None:
        """Create the sensor model for the collision that the sensor's element names.

        If the element names no collision, the sensor measures all contacts of the link.
        """
        contact = self.sensor.sensor.contact
        collision_names = [] if contact is None or contact.collision == "__default__" else [contact.collision]
        self.contacts = ContactSensor(self.mount, collision_names)


class ClassicBumper(ContactPlugin[BumperParameters]):
    """The substitute for ``libgazebo_ros_bumper.so``.

    Positions and forces are in the world frame, regardless of the frame in the message's header.
    """

    PARAMETERS = BumperParameters

    def create_publishers(self) -> None:
        """Create the publisher of ``gazebo_msgs/msg/ContactsState``."""
        self.output = self.node.publisher(_STATE_TYPE, self.parameters.topic_name, SENSOR_QOS)

    def measure(self) -> None:
        """Measure and publish, even if there are no contacts."""
        message = self.message(_STATE_TYPE, self.parameters.frame_name)
        message.states = [_to_contact_state(contact) for contact in self.contacts.measure()]
        self.output.publish(message)


class GzContact(ContactPlugin[NoParameters]):
    """The sensor ``contact`` of gz, which publishes nothing while there is no contact."""

    def create_publishers(self) -> None:
        """Create the publisher on the topic in ``<contact>``, or on gz's default topic."""
        contact = self.sensor.sensor.contact
        declared_topic = "" if contact is None or contact.topic == _DEFAULT_TOPIC else contact.topic
        conventional_topic = "" if declared_topic else "/contacts"
        self.output = self.node.publisher(
            _CONTACTS_TYPE, declared_topic or self.gz_topic("contact"), conventional_topic=conventional_topic
        )

    def measure(self) -> None:
        """Measure, and publish if there is a contact."""
        contacts = self.contacts.measure()
        if contacts:
            message = self.message(_CONTACTS_TYPE, "")
            message.contacts = [_to_contact_message(contact) for contact in contacts]
            self.output.publish(message)


def _to_contact_message(contact: Contact) -> Any:
    """Return the ``ros_gz_interfaces/msg/Contact`` of a contact.

    Positions, normals and forces are in world axes.
    """
    message = get_message("ros_gz_interfaces/msg/Contact")()
    for entity, name in ((message.collision1, contact.collision1), (message.collision2, contact.collision2)):
        entity.name, entity.type = name, entity.COLLISION
    message.positions = [vector_to_message(position) for position in contact.positions]
    message.normals = [vector_to_message(normal) for normal in contact.normals]
    message.depths = [float(depth) for depth in contact.depths]
    for force, torque in zip(contact.forces, contact.torques, strict=True):
        joint_wrench = get_message("ros_gz_interfaces/msg/JointWrench")()
        joint_wrench.body_1_name.data, joint_wrench.body_2_name.data = contact.collision1, contact.collision2
        joint_wrench.body_1_wrench, joint_wrench.body_2_wrench = (
            wrench_to_message(force, torque),
            wrench_to_message(-force, -torque),
        )
        message.wrenches.append(joint_wrench)
    return message


def _to_contact_state(contact: Contact) -> Any:
    state = get_message("gazebo_msgs/msg/ContactState")()
    state.collision1_name, state.collision2_name = contact.collision1, contact.collision2
    state.wrenches = [wrench_to_message(*pair) for pair in zip(contact.forces, contact.torques, strict=True)]
    state.total_wrench = wrench_to_message(contact.forces.sum(axis=0), contact.torques.sum(axis=0))
    state.contact_positions = [vector_to_message(position) for position in contact.positions]
    state.contact_normals = [vector_to_message(normal) for normal in contact.normals]
    state.depths = [float(depth) for depth in contact.depths]
    return state


def wrench_to_message(force: Array, torque: Array) -> Any:
    """Return a force in N and a torque in N m as a ``geometry_msgs/msg/Wrench``."""
    return get_message("geometry_msgs/msg/Wrench")(force=vector_to_message(force), torque=vector_to_message(torque))
