"""The base classes of sensors: mount, rate, frames and topics."""

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
    """A sensor that measures when it is due and a topic of its has a subscription."""

    def start(self) -> None:
        """Make the measuring part and the topics."""
        self.make_sensor()
        self.make_topics()
        self.every(self.rate, self._measure)

    def reset(self) -> None:
        """Restart, with the same random numbers."""
        self.make_sensor()

    @abstractmethod
    def make_sensor(self) -> None:
        """Make the measuring part."""

    @abstractmethod
    def make_topics(self) -> None:
        """Make the topics."""

    @abstractmethod
    def is_wanted(self) -> bool:
        """Return whether a subscriber exists."""

    def is_needed(self) -> bool:
        """Return whether it is to measure now."""
        return self.is_wanted()

    @abstractmethod
    def measure(self) -> None:
        """Measure and publish."""

    @property
    def rate(self) -> float:
        """Measurements in a simulated second."""
        return self.sensor.sensor.update_rate

    @property
    def mount(self) -> Mount:
        """The place where it is fixed."""
        return Mount(self.simulation, self.sensor.link, self.sensor.pose)

    def classic_frame(self) -> str:
        """The frame of its messages in Gazebo classic: that of the plugin's parameters, else the link."""
        frame: str = getattr(self.parameters, "frame_name", "")
        return frame.lstrip("/") or self.sensor.link.rpartition(SEPARATOR)[2]

    def gz_frame(self) -> str:
        """The frame of its messages in gz: that of the sensor's element, else ``model/link/sensor``."""
        return self.sensor.sensor.frame_id or self.sensor.name.replace(SEPARATOR, "/")

    def gz_topic(self, leaf: str) -> str:
        """The topic that gz gives a sensor whose element names none."""
        model, *inside = self.sensor.name.split(SEPARATOR)
        holder = "joint" if self.sensor.joint else "link"
        place = f"/world/{self.place.world.name}/model/{model}/{holder}/{'/'.join(inside[:-1])}"
        return f"{place}/sensor/{inside[-1]}/{leaf}"

    def gz_output(self, kind: str, leaf: str, usual: str = "") -> Output:
        """The topic of a sensor of gz: the one that its element names, or the one that gz gives it.

        Args:
            kind: the type of its messages.
            leaf: how the name ends that gz gives it.
            usual: the name that the topic has on robots.
        """
        topic = self.sensor.sensor.topic
        return self.node.publisher(kind, topic or self.gz_topic(leaf), usual="" if topic else usual or f"/{leaf}")

    def message(self, kind: str, frame: str) -> Any:
        """A new message of a type, with its header."""
        return get_message(kind)(header=Header(stamp=self.stamp(), frame_id=frame))

    def _measure(self) -> None:
        if self.is_needed():
            self.measure()


class OneTopic(SensorPlugin[P], Generic[P]):
    """A sensor with one topic.

    Attributes:
        output: the topic, which `make_topics` makes.
    """

    output: Output

    def is_wanted(self) -> bool:
        """Return whether a subscriber exists."""
        return self.output.is_wanted


def vector(values: Array) -> Vector3:
    """Three numbers as a message."""
    x, y, z = values.tolist()
    return Vector3(x, y, z)
