"""Sensors of the base Create 3, which TurtleBot 4 has too, in Gazebo Classic.

They are ``libgazebo_ros_create_bumper.so``, ``..._cliff_sensor.so``, ``..._imu.so``, ``..._ir_intensity_sensor.so``,
``..._optical_mouse.so`` and ``..._wheel_drop.so``.

Source: irobot_create_gazebo_plugins for ROS 2 Humble (parameters, topics, defaults, zones, the formula of the
intensity). The messages are those of ``irobot_create_msgs``.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, e, exp, pi
from typing import Any, Generic, TypeVar

from linkwright.geometry.single import Vector3, add_vectors, compose, invert, quaternion_inverse, rotate
from linkwright.messages import Header, get_message
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.parameters import NoParameters, parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, FrameNameParameter
from linkwright.simulation.plugins.sensors.contact import ContactPlugin
from linkwright.simulation.plugins.sensors.imu import ClassicImu
from linkwright.simulation.plugins.sensors.lidar import SingleTopicLidar
from linkwright.simulation.sensors.imu import ImuMeasurement
from linkwright.simulation.sensors.lidar import Scan

P = TypeVar("P")
_HAZARD_TYPE, _INTENSITY_TYPE, _MOUSE_TYPE = (
    f"irobot_create_msgs/msg/{name}" for name in ("HazardDetection", "IrIntensity", "Mouse")
)
_TOPIC = "~/out"
_ZONES = (
    (-pi / 2, -3 * pi / 10, "bump_right"),
    (-3 * pi / 10, -pi / 10, "bump_front_right"),
    (-pi / 10, pi / 10, "bump_front_center"),
    (pi / 10, 3 * pi / 10, "bump_front_left"),
    (3 * pi / 10, pi / 2, "bump_left"),
)
"""The smallest and the largest direction of each zone of the bumper, in rad from the front, and its frame."""
_MAX_INTENSITY = 3500.0
"""The intensity of a white surface at the sensor."""
_DROP_SHARE, _RETURN_SHARE = 0.95, 0.75
"""The shares of the threshold at which a wheel counts as dropped, and as back on the floor."""
_RATE_HZ = 62.0
_SURFACE_QUALITY = 90


@dataclass(frozen=True, kw_only=True)
class CliffParameters:
    """Parameters of ``libgazebo_ros_create_cliff_sensor.so``."""

    detection_threshold: float = 0.01
    frame_id: str = ""


@dataclass(frozen=True, kw_only=True)
class WheelDropParameters:
    """Parameters of ``libgazebo_ros_create_wheel_drop.so``."""

    joint_name: str = parameter()
    detection_threshold: float = 0.7
    frame_id: str = ""
    update_rate: float = _RATE_HZ


@dataclass(frozen=True, kw_only=True)
class MouseParameters:
    """Parameters of ``libgazebo_ros_create_optical_mouse.so``."""

    link_name: str = parameter()
    update_rate: float = _RATE_HZ


class _DistanceSensor(SingleTopicLidar[P], Generic[P]):
    """An infrared sensor, of which only the shortest distance counts."""

    def distance(self, scan: Scan) -> float:
        """Return the shortest distance in m, at most the range."""
        return min(float(scan.ranges.min()), self.lidar.range_max)


class CliffSensor(_DistanceSensor[CliffParameters]):
    """The substitute for ``libgazebo_ros_create_cliff_sensor.so``: a message while there is no floor."""

    PARAMETERS = CliffParameters

    def create_publishers(self) -> None:
        """Create the publisher of ``irobot_create_msgs/msg/HazardDetection``."""
        self.output = self.node.publisher(_HAZARD_TYPE, _TOPIC, SENSOR_QOS)

    def publish(self, scan: Scan) -> None:
        """Publish a hazard if the floor is as far away as the threshold or farther."""
        if self.distance(scan) >= self.parameters.detection_threshold:
            message = self.message(_HAZARD_TYPE, self.parameters.frame_id)
            message.type = message.CLIFF
            self.output.publish(message)


class IntensitySensor(_DistanceSensor[FrameNameParameter]):
    """The substitute for ``libgazebo_ros_create_ir_intensity_sensor.so``."""

    PARAMETERS = FrameNameParameter

    def create_publishers(self) -> None:
        """Create the publisher of ``irobot_create_msgs/msg/IrIntensity``."""
        self.output = self.node.publisher(_INTENSITY_TYPE, _TOPIC, SENSOR_QOS)

    def publish(self, scan: Scan) -> None:
        """Publish the intensity, which falls exponentially with the distance."""
        message = self.message(_INTENSITY_TYPE, self.classic_frame())
        message.value = int(_MAX_INTENSITY * exp(-2.0 * e * max(self.distance(scan), 0.0) / self.lidar.range_max))
        self.output.publish(message)


class Bumper(ContactPlugin[NoParameters]):
    """The substitute for ``libgazebo_ros_create_bumper.so``: a message for the zone that is hit, while it is hit.

    The zones are those of the model with the sensor; in Gazebo, the model must be called ``create3``.
    """

    def create_publishers(self) -> None:
        """Create the publisher of ``irobot_create_msgs/msg/HazardDetection``."""
        self.output = self.node.publisher(_HAZARD_TYPE, _TOPIC, SENSOR_QOS)

    def measure(self) -> None:
        """Measure, and publish the first zone that is hit."""
        to_model = invert(self.simulation.model_pose(self.context.path))
        for contact in self.contacts.measure():
            for point in contact.positions:
                x, y, z = point.tolist()
                forward, left, *_ = compose(to_model, (x, y, z, 0.0, 0.0, 0.0, 1.0))
                zone = _find_zone(atan2(left, forward))
                if zone is not None:
                    message = self.message(_HAZARD_TYPE, zone)
                    message.type = message.BUMP
                    self.output.publish(message)
                    return


class Create3Imu(ClassicImu):
    """The substitute for ``libgazebo_ros_create_imu.so``, whose acceleration does not contain gravity."""

    def acceleration(self, measurement: ImuMeasurement) -> Vector3:
        """Return the acceleration in m/s2 without gravity, in the axes of the sensor."""
        to_sensor = quaternion_inverse(measurement.orientation)
        gravity = rotate(to_sensor, tuple(self.simulation.model.opt.gravity.tolist()))
        return add_vectors(measurement.linear_acceleration, gravity)


class OpticalMouse(SimulatedPlugin[MouseParameters]):
    """The substitute for ``libgazebo_ros_create_optical_mouse.so``: the distances in the directions of a link."""

    PARAMETERS = MouseParameters
    CARRIED = ("_pose", "_x", "_y")

    def start(self) -> None:
        """Find the link, and create the publisher of ``irobot_create_msgs/msg/Mouse``.

        Raises:
            LinkwrightError: SIM135, there is no such link.
        """
        self._link, self._x, self._y = self.link(self.parameters.link_name), 0.0, 0.0
        self._pose = self.simulation.link_pose(self._link)
        self._output = self.node.publisher(_MOUSE_TYPE, _TOPIC, SENSOR_QOS)
        self.every(self.parameters.update_rate, self._measure)

    def reset(self) -> None:
        """Measure from the pose to which the link has returned; the distances are kept."""
        self._pose = self.simulation.link_pose(self._link)

    def _measure(self) -> None:
        previous, self._pose = self._pose, self.simulation.link_pose(self._link)
        x, y, *_ = compose(invert(previous), self._pose)
        self._x, self._y = self._x + x, self._y + y
        if self._output.is_wanted:
            message = get_message(_MOUSE_TYPE)(
                header=Header(stamp=self.stamp(), frame_id=self._link.rpartition(SEPARATOR)[2]),
                integrated_x=self._x,
                integrated_y=self._y,
                last_squal=_SURFACE_QUALITY,
            )
            self._output.publish(message)


class WheelDrop(SimulatedPlugin[WheelDropParameters]):
    """The substitute for ``libgazebo_ros_create_wheel_drop.so``: a message while a wheel hangs down."""

    PARAMETERS = WheelDropParameters
    CARRIED = ("_is_dropped",)

    def start(self) -> None:
        """Find the joint, and create the publisher of ``irobot_create_msgs/msg/HazardDetection``.

        Raises:
            LinkwrightError: SIM134, there is no such joint.
        """
        self._joint, self._is_dropped = self.joint(self.parameters.joint_name), False
        self._output = self.node.publisher(_HAZARD_TYPE, _TOPIC, SENSOR_QOS)
        self.every(self.parameters.update_rate, self._measure)

    def reset(self) -> None:
        """Forget that the wheel hung down."""
        self._is_dropped = False

    def _measure(self) -> None:
        threshold, position = self.parameters.detection_threshold, self.simulation.joint_state(self._joint)[0]
        self._is_dropped = position >= threshold * (_RETURN_SHARE if self._is_dropped else _DROP_SHARE)
        if self._is_dropped and self._output.is_wanted:
            message: Any = get_message(_HAZARD_TYPE)(
                header=Header(stamp=self.stamp(), frame_id=self.parameters.frame_id)
            )
            message.type = message.WHEEL_DROP
            self._output.publish(message)


def _find_zone(direction: float) -> str | None:
    """Return the frame of the zone of the bumper in a direction in rad from the front; None for the rear."""
    return next((name for smallest, largest, name in _ZONES if smallest <= direction <= largest), None)
