"""Base classes of sensors, which handle mounts, rates, frames and topics."""

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
"""gazebo_ros's profile: the depth of sensor data, and reliable, so that every subscription is compatible."""


@dataclass(frozen=True, kw_only=True)
class FrameName:
    """The parameter ``frame_name``, which all sensors of Gazebo classic have."""

    frame_name: str = parameter("", aliases=("frameName",))


class SensorPlugin(SimulatedPlugin[P], ABC, Generic[P]):
    """A sensor that measures at its rate while one of its topics has a subscription."""

    def start(self) -> None:
        """Create the sensor model and the topics, and schedule measurements."""
        self.make_sensor()
        self.make_topics()
        self.every(self.rate, self._measure)

    def reset(self) -> None:
        """Create the sensor model again, which restarts its random numbers."""
        self.make_sensor()

    @abstractmethod
    def make_sensor(self) -> None:
        """Create the sensor model that measures."""

    @abstractmethod
    def make_topics(self) -> None:
        """Create the topics to which measurements are published."""

    @abstractmethod
    def is_wanted(self) -> bool:
        """Return whether a topic of the sensor has a subscription."""

    def is_needed(self) -> bool:
        """Return whether a measurement has a recipient; by default, whether a topic has a subscription."""
        return self.is_wanted()

    @abstractmethod
    def measure(self) -> None:
        """Measure, and publish the result."""

    @property
    def rate(self) -> float:
        """The number of measurements per simulated second; 0 for one after each step."""
        return self.sensor.sensor.update_rate

    @property
    def mount(self) -> Mount:
        """The link and the pose at which the sensor is fixed."""
        return Mount(self.simulation, self.sensor.link, self.sensor.pose)

    def classic_frame(self) -> str:
        """Return the message frame for Gazebo classic: the parameter ``frame_name``, or else the link."""
        frame: str = getattr(self.parameters, "frame_name", "")
        return frame.lstrip("/") or self.sensor.link.rpartition(SEPARATOR)[2]

    def gz_frame(self) -> str:
        """Return the message frame for gz: from the sensor's element, or else ``model/link/sensor``."""
        return self.sensor.sensor.frame_id or self.sensor.name.replace(SEPARATOR, "/")

    def gz_topic(self, leaf: str) -> str:
        """Return the default topic that gz gives a sensor; `leaf` is the last part of the name."""
        model, *inside = self.sensor.name.split(SEPARATOR)
        holder = "joint" if self.sensor.joint else "link"
        place = f"/world/{self.place.world.name}/model/{model}/{holder}/{'/'.join(inside[:-1])}"
        return f"{place}/sensor/{inside[-1]}/{leaf}"

    def gz_output(self, kind: str, leaf: str, usual: str = "") -> Output:
        """Create the topic of a gz sensor, with the name from its element or the default name of gz.

        Args:
            kind: the message type.
            leaf: the last part of the default name.
            usual: the usual name of the topic on robots; ``/`` and `leaf` if empty.
        """
        topic = self.sensor.sensor.topic
        return self.node.publisher(kind, topic or self.gz_topic(leaf), usual="" if topic else usual or f"/{leaf}")

    def message(self, kind: str, frame: str) -> Any:
        """Return a new message of a type, with its header set."""
        return get_message(kind)(header=Header(stamp=self.stamp(), frame_id=frame))

    def _measure(self) -> None:
        if self.is_needed():
            self.measure()


class OneTopic(SensorPlugin[P], Generic[P]):
    """A sensor with one topic.

    Attributes:
        output: the publisher of the topic, which `make_topics` creates.
    """

    output: Output

    def is_wanted(self) -> bool:
        """Return whether the topic has a subscription."""
        return self.output.is_wanted


def vector(values: Array) -> Vector3:
    """Return three numbers as a ``geometry_msgs/msg/Vector3``."""
    x, y, z = values.tolist()
    return Vector3(x, y, z)
