"""Doppler velocity logs: ``libuuv_gazebo_ros_dvl_plugin.so``.

Four range sensors on other links are the beams, and their mean is the altitude.

Source: uuv_simulator (parameters, topics, messages).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from linkwright.geometry.single import compose, invert
from linkwright.messages import Header, Quaternion, from_values, get_message
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, vector_to_message
from linkwright.simulation.plugins.underwater.sensor import HALF_TURN, LinkSensor, LinkSensorParameters

_RANGE_TYPE = "sensor_msgs/msg/Range"
_OUT_OF_RANGE = -1.0
_NOT_AVAILABLE = -1.0


@dataclass(frozen=True, kw_only=True)
class DvlParameters(LinkSensorParameters):
    """Parameters of ``libuuv_gazebo_ros_dvl_plugin.so``."""

    beam_link_name_0: str = parameter()
    beam_link_name_1: str = parameter()
    beam_link_name_2: str = parameter()
    beam_link_name_3: str = parameter()
    beam_topic_0: str = parameter()
    beam_topic_1: str = parameter()
    beam_topic_2: str = parameter()
    beam_topic_3: str = parameter()


class UuvDvl(LinkSensor[DvlParameters]):
    """The substitute for ``libuuv_gazebo_ros_dvl_plugin.so``: the velocity over ground and the altitude."""

    PARAMETERS = DvlParameters
    MESSAGE_TYPE = "uuv_sensor_ros_plugins_msgs/msg/DVL"

    def start(self) -> None:
        """Find the links of the beams, and subscribe to their ranges.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        parameters = self.parameters
        self._links = [self.link(getattr(parameters, f"beam_link_name_{number}")) for number in range(4)]
        super().start()
        for number in range(4):
            topic = getattr(parameters, f"beam_topic_{number}")
            self.node.subscribe(_RANGE_TYPE, topic, partial(self._on_range, number), SENSOR_QOS)

    def create_sensor(self) -> None:
        """Forget the ranges."""
        self._latest: dict[int, Any] = {}
        self._ranges, self._altitude = [0.0] * 4, 0.0

    def create_publishers(self) -> None:
        """Create the publishers of the velocity, also as a twist."""
        super().create_publishers()
        topic = f"{self.parameters.sensor_topic}_twist"
        self._twist_output = self.node.publisher("geometry_msgs/msg/TwistWithCovarianceStamped", topic, SENSOR_QOS)

    def is_wanted(self) -> bool:
        """Return whether a topic has a subscription."""
        return self.output.is_wanted or self._twist_output.is_wanted

    def measure(self) -> None:
        """Measure, and publish the velocity and the altitude."""
        self.publish_frame()
        velocity = self.to_frame(np.array(self.mount.velocity()[0])) + self.draw_noise()
        message = self.message(self.MESSAGE_TYPE, self.frame)
        message.velocity, message.altitude = vector_to_message(velocity), self._altitude
        message.velocity_covariance = np.diag([self.variance] * 3).ravel()
        message.beams = [self._create_beam(number) for number in range(4)]
        self.output.publish(message)
        twist = self.message("geometry_msgs/msg/TwistWithCovarianceStamped", self.frame)
        twist.twist.twist.linear = vector_to_message(velocity)
        twist.twist.covariance[::7] = [self.variance] * 3 + [_NOT_AVAILABLE] * 3
        self._twist_output.publish(twist)

    def _create_beam(self, number: int) -> Any:
        """Return a beam with its pose in the frame of the measurements."""
        frame = self.mount.pose()
        if self.parameters.enable_local_ned_frame:
            frame = compose(frame, HALF_TURN)
        pose = compose(invert(frame), self.simulation.link_pose(self._links[number]))
        beam = get_message("uuv_sensor_ros_plugins_msgs/msg/DVLBeam")(range=self._ranges[number])
        beam.pose.header = Header(stamp=self.stamp(), frame_id=self.frame)
        position = beam.pose.pose.position
        position.x, position.y, position.z = pose[:3]
        beam.pose.pose.orientation = from_values(Quaternion, pose[3:])
        return beam

    def _on_range(self, number: int, message: Any) -> None:
        """Update the altitude when all beams have a range of the same time."""
        self._latest[number] = message
        messages = [self._latest.get(beam) for beam in range(4)]
        if any(other is None or other.header.stamp != message.header.stamp for other in messages):
            return
        ranges = [float(np.clip(other.range, other.min_range, other.max_range)) for other in messages if other]
        limits = [(float(other.min_range), float(other.max_range)) for other in messages if other]
        is_too_near = all(distance <= low for distance, (low, _) in zip(ranges, limits, strict=True))
        is_too_far = all(distance >= high for distance, (_, high) in zip(ranges, limits, strict=True))
        if is_too_near or is_too_far:
            self._altitude = _OUT_OF_RANGE
            return
        self._ranges, self._altitude = ranges, float(np.mean(ranges))
