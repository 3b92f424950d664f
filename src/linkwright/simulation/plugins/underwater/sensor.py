"""The base class of uuv_simulator's sensors: topics, noise, switching, and axes forward, right, down.

Source: uuv_simulator (parameters, defaults, topics, service, noise).
"""

from __future__ import annotations

from abc import ABC
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np

from linkwright.control.odometry import TRANSFORMS_DEPTH, TRANSFORMS_TYPE, transform_message
from linkwright.geometry.arrays import Array, quaternion_inverse, rotate
from linkwright.geometry.single import IDENTITY, Transform
from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile
from linkwright.graph.stepped.node import Output
from linkwright.messages import Header, get_message
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, SensorPlugin
from linkwright.simulation.sensors.mount import Mount

_WORLD = "world"
HALF_TURN: Transform = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
"""The rotation by half a turn about x, from axes forward, left, up to axes forward, right, down."""
_STATIC_TRANSFORMS_QOS = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@dataclass(frozen=True, kw_only=True)
class SensorParameters:
    """Parameters that all sensors of uuv_simulator have in common."""

    sensor_topic: str = parameter()
    update_rate: float = 30.0
    is_on: bool = True
    noise_sigma: float = 0.0
    noise_amplitude: float = 0.0
    static_reference_frame: str = _WORLD
    reference_link_name: str = ""


@dataclass(frozen=True, kw_only=True)
class LinkSensorParameters(SensorParameters):
    """Parameters of the sensors that are plugins of the model."""

    link_name: str = parameter()
    enable_local_ned_frame: bool = True


S = TypeVar("S", bound=SensorParameters)
L = TypeVar("L", bound=LinkSensorParameters)


class UnderwaterSensor(SensorPlugin[S], ABC, Generic[S]):
    """A sensor that a service switches on and off.

    Attributes:
        MESSAGE_TYPE: the type of the messages on the sensor's topic.
    """

    MESSAGE_TYPE: ClassVar[str]
    IGNORED: ClassVar[Collection[str]] = ("enable_gazebo_messages",)
    CARRIED = ("_is_on", "_static_frame")

    output: Output

    def start(self) -> None:
        """Find the reference frame, create the topics and the service, and schedule measurements."""
        parameters = self.parameters
        self._is_on, self._generator = parameters.is_on, self.random
        self._reference_link = self.link(parameters.reference_link_name) if parameters.reference_link_name else ""
        frame = parameters.static_reference_frame
        self.reference_frame = parameters.reference_link_name or frame
        self._static_frame: Transform | None = IDENTITY if self._reference_link or frame == _WORLD else None
        if self._static_frame is None:
            self.node.subscribe(TRANSFORMS_TYPE, "/tf_static", self._on_static_transforms, _STATIC_TRANSFORMS_QOS)
        super().start()

    def reset(self) -> None:
        """Restore the initial state, so that random numbers restart."""
        self._is_on, self._generator = self.parameters.is_on, self.random
        super().reset()

    def create_sensor(self) -> None:
        """Create the sensor model that `measure` uses; most sensors have none."""

    def create_publishers(self) -> None:
        """Create the publishers of the measurements and of the state, and the service."""
        topic = self.parameters.sensor_topic
        self.output = self.node.publisher(self.MESSAGE_TYPE, topic, SENSOR_QOS)
        self._state_output = self.node.publisher("std_msgs/msg/Bool", f"{topic}/state", 1)
        service_type = "uuv_sensor_ros_plugins_msgs/srv/ChangeSensorState"
        self.node.service(service_type, f"{topic}/change_state", self._change_state)

    def is_wanted(self) -> bool:
        """Return whether the topic of the measurements has a subscription."""
        return self.output.is_wanted

    def should_measure(self) -> bool:
        """Publish the state, and return whether to measure: switched on, wanted, with a known reference frame."""
        if self._state_output.is_wanted:
            self._state_output.publish(get_message("std_msgs/msg/Bool")(data=self._is_on))
        return self._is_on and self._static_frame is not None and self.is_wanted()

    @property
    def rate(self) -> float:
        """The number of measurements per simulated second."""
        return max(self.parameters.update_rate, 0.0)

    @property
    def variance(self) -> float:
        """The variance in the messages."""
        return self.parameters.noise_sigma**2

    @property
    def reference(self) -> Transform:
        """The pose of the reference frame in the world."""
        if self._reference_link:
            return self.simulation.link_pose(self._reference_link)
        assert self._static_frame is not None
        return self._static_frame

    def draw_noise(self, count: int = 3, sigma: float | None = None) -> Array:
        """Return noise of the sensor's amplitude, shape (count,).

        Args:
            count: the number of values.
            sigma: the standard deviation before the amplitude; None for ``<noise_sigma>``.
        """
        deviation = self.parameters.noise_sigma if sigma is None else sigma
        noise: Array = self.parameters.noise_amplitude * deviation * self._generator.standard_normal(count)
        return noise

    def _on_static_transforms(self, message: Any) -> None:
        for transform in message.transforms:
            if (transform.header.frame_id, transform.child_frame_id) == (_WORLD, self.reference_frame):
                position, rotation = transform.transform.translation, transform.transform.rotation
                xyz = (position.x, position.y, position.z)
                self._static_frame = (*xyz, rotation.x, rotation.y, rotation.z, rotation.w)

    def _change_state(self, request: Any, response: Any) -> Any:
        self._is_on = bool(request.on)
        response.success = True
        response.message = f"{self.parameters.sensor_topic}:: {'ON' if self._is_on else 'OFF'}"
        return response


class LinkSensor(UnderwaterSensor[L], Generic[L]):
    """A sensor on a link, by default with axes forward, right, down in a frame ``LINK_ned``."""

    def create_publishers(self) -> None:
        """Create the publishers of the measurements, the state and the transform, and the service."""
        super().create_publishers()
        self._transforms_output = self.node.publisher(TRANSFORMS_TYPE, "/tf", TRANSFORMS_DEPTH)

    @property
    def mount(self) -> Mount:
        """The mount at the origin of the link."""
        return Mount(self.simulation, self.link(self.parameters.link_name))

    @property
    def link_frame(self) -> str:
        """The frame of the link."""
        return self.mount.link.rpartition(SEPARATOR)[2]

    @property
    def frame(self) -> str:
        """The frame of the measurements: that of the link, or the one with axes forward, right, down."""
        return f"{self.link_frame}_ned" if self.parameters.enable_local_ned_frame else self.link_frame

    def to_frame(self, vector: Array) -> Array:
        """Return a vector in the axes of the world in those of the measurements, shape (3,)."""
        local = rotate(quaternion_inverse(np.array(self.mount.pose()[3:])), vector)
        return local * (1.0, -1.0, -1.0) if self.parameters.enable_local_ned_frame else local

    def publish_frame(self) -> None:
        """Publish the transform of the frame with axes forward, right, down, if the sensor uses it."""
        if self.parameters.enable_local_ned_frame:
            header = Header(stamp=self.stamp(), frame_id=self.link_frame)
            self._transforms_output.publish(transform_message(header, self.frame, HALF_TURN))
