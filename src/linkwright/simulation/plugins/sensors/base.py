"""Base classes of sensor plugins, with their mounts, rates, frames and topics."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from linkwright.geometry.arrays import Array
from linkwright.graph.qos.profile import QoSProfile
from linkwright.graph.stepped.node import Output
from linkwright.messages import Header, Vector3, get_message
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.sensors.mount import Mount

P = TypeVar("P")
SENSOR_QOS = QoSProfile(depth=5)
"""gazebo_ros's profile: the depth of sensor data, but reliable, so that it is compatible with every subscription."""


@dataclass(frozen=True, kw_only=True)
class FrameNameParameter:
    """The parameter ``frame_name`` of all sensors of Gazebo classic."""

    frame_name: str = parameter("", aliases=("frameName",))


class SensorPlugin(SimulatedPlugin[P], ABC, Generic[P]):
    """A sensor that measures at its update rate while one of its topics has a subscription."""

    def start(self) -> None:
        """Create the sensor model and the publishers, and schedule measurements."""
        self.create_sensor()
        self.create_publishers()
        self.every(self.rate, self._measure)

    def reset(self) -> None:
        """Create the sensor model again, so that its random numbers restart."""
        self.create_sensor()

    @abstractmethod
    def create_sensor(self) -> None:
        """Create the sensor model that `measure` uses."""

    @abstractmethod
    def create_publishers(self) -> None:
        """Create the publishers of the measurements."""

    @abstractmethod
    def is_wanted(self) -> bool:
        """Return whether a topic of the sensor has a subscription."""

    def should_measure(self) -> bool:
        """Return whether to measure.

        By default, the sensor measures while a topic has a subscription.
        """
        return self.is_wanted()

    @abstractmethod
    def measure(self) -> None:
        """Measure, and publish the result."""

    @property
    def rate(self) -> float:
        """The number of measurements per simulated second, or 0 to measure after each step."""
        return self.sensor.sensor.update_rate

    @property
    def mount(self) -> Mount:
        """The link to which the sensor is fixed, and the pose of the sensor on this link."""
        return Mount(self.simulation, self.sensor.link, self.sensor.pose)

    def classic_frame(self) -> str:
        """Return the frame of Gazebo classic's messages.

        The frame is the parameter ``frame_name``, or the link if the parameter is empty.
        """
        frame: str = getattr(self.parameters, "frame_name", "")
        return frame.lstrip("/") or self.sensor.link.rpartition(SEPARATOR)[2]

    def gz_frame(self) -> str:
        """Return the frame of gz's messages: the declared frame, or else ``model/link/sensor``."""
        return self.sensor.sensor.frame_id or self.sensor.name.replace(SEPARATOR, "/")

    def gz_topic(self, leaf: str) -> str:
        """Return the default topic of a sensor in gz, with `leaf` as the last part of its name."""
        model, *nested_names = self.sensor.name.split(SEPARATOR)
        entity_type = "joint" if self.sensor.joint else "link"
        parent_topic = f"/world/{self.context.world.name}/model/{model}/{entity_type}/{'/'.join(nested_names[:-1])}"
        return f"{parent_topic}/sensor/{nested_names[-1]}/{leaf}"

    def create_gz_output(self, message_type: str, leaf: str, conventional_topic: str = "") -> Output:
        """Create the publisher of a gz sensor, on its declared topic or on gz's default topic.

        Args:
            message_type: the message type.
            leaf: the last part of the default name.
            conventional_topic: the usual name of such a topic on robots; if empty, ``/`` followed by `leaf`.
        """
        topic = self.sensor.sensor.topic
        return self.node.publisher(
            message_type,
            topic or self.gz_topic(leaf),
            conventional_topic="" if topic else conventional_topic or f"/{leaf}",
        )

    def message(self, message_type: str, frame: str) -> Any:
        """Create a message of a type, with the current stamp and a frame in its header."""
        return get_message(message_type)(header=Header(stamp=self.stamp(), frame_id=frame))

    def _measure(self) -> None:
        if self.should_measure():
            self.measure()


class SingleTopicSensor(SensorPlugin[P], Generic[P]):
    """A sensor with one topic.

    Attributes:
        output: the publisher of the topic, which `create_publishers` creates.
    """

    output: Output

    def is_wanted(self) -> bool:
        """Return whether the topic has a subscription."""
        return self.output.is_wanted


def vector_to_message(values: Array) -> Vector3:
    """Return three numbers as a ``geometry_msgs/msg/Vector3``."""
    x, y, z = values.tolist()
    return Vector3(x=x, y=y, z=z)
