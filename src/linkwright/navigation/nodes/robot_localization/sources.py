"""The sensors of ekf_node, which convert messages to measurements in the filter's frames."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.single import (
    Quaternion,
    Transform,
    normalized,
    quaternion_from_rpy,
    quaternion_multiply,
)
from linkwright.graph import Node, QoSProfile, ReliabilityPolicy
from linkwright.messages import get_message
from linkwright.navigation.estimation.estimator import Estimator
from linkwright.navigation.estimation.kalman import KalmanFilter, Measurement
from linkwright.navigation.estimation.motion_model import ANGLES, POSE, RATES, TWIST
from linkwright.navigation.estimation.readings import (
    PoseReader,
    Reading,
    read_acceleration,
    read_twist,
    subtract_gravity,
)
from linkwright.navigation.nodes.robot_localization.configuration import Configuration, SensorSettings
from linkwright.nodes.frame_poses import FramePoses

_MESSAGE_TYPES = {
    "odom": "nav_msgs/msg/Odometry",
    "pose": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "twist": "geometry_msgs/msg/TwistWithCovarianceStamped",
    "imu": "sensor_msgs/msg/Imu",
}
_NOT_MEASURED = -1.0
"""The first number of a covariance for a quantity that the IMU does not measure."""


class SourceContext:
    """The node, configuration and estimator that the sensors share.

    Args:
        node: the node of the filter.
        configuration: the parameters of the node.
        estimator: receives the measurements of the sensors.
        on_old_message: called when a message is older than the previous message of its sensor.
    """

    def __init__(
        self,
        node: Node,
        configuration: Configuration,
        estimator: Estimator,
        on_old_message: Callable[[], None],
    ) -> None:
        self.node = node
        self.configuration = configuration
        self.estimator = estimator
        self.on_old_message = on_old_message
        self.poses = FramePoses(node, "Could not obtain transform:")
        self.ignored_until_ns = -1
        """Messages with this stamp or an earlier one are ignored, because they precede a set pose."""

    @property
    def filter(self) -> KalmanFilter:
        """The filter, whose estimate is needed to convert some measurements."""
        return self.estimator.filter


class Source:
    """A sensor with its subscription and its state.

    Args:
        settings: the settings of the sensor.
        context: the objects shared with other sensors.
    """

    def __init__(self, settings: SensorSettings, context: SourceContext) -> None:
        self._settings = settings
        self._context = context
        two_d = context.configuration.two_d
        self._pose = PoseReader(settings.used, settings.differential, settings.relative, two_d)
        self._two_d = two_d
        self._frames = context.configuration.frames
        self._latest_ns = -1
        if any(settings.used):
            readers = {
                "odom": self._read_odometry,
                "pose": self._read_pose_message,
                "twist": self._read_twist_message,
                "imu": self._read_imu,
            }
            context.node.create_subscription(
                get_message(_MESSAGE_TYPES[settings.kind]),
                settings.topic,
                lambda message: self._receive(message, readers[settings.kind]),
                QoSProfile(settings.queue_size, ReliabilityPolicy.BEST_EFFORT),
            )

    def reset(self, *, accept_older: bool) -> None:
        """Treat the next pose as the first pose.

        If `accept_older` is set, also accept messages with older stamps.
        """
        self._pose.reset()
        if accept_older:
            self._latest_ns = -1

    def _receive(self, message: Any, read: Callable[[Any, int], None]) -> None:
        stamp_ns: int = message.header.stamp.nanoseconds
        if stamp_ns <= self._context.ignored_until_ns:
            return
        if stamp_ns < self._latest_ns:
            self._context.on_old_message()
            if stamp_ns < self._latest_ns:
                self._context.node.get_logger().warning(
                    f"The {self._settings.name} message has a timestamp before that of the previous message received, "
                    "this message will be ignored. This may indicate a bad timestamp.",
                    throttle_duration_sec=5.0,
                )
                return
        self._latest_ns = stamp_ns
        read(message, stamp_ns)

    def _read_odometry(self, message: Any, stamp_ns: int) -> None:
        self._read_pose(message.pose, message.header.frame_id, stamp_ns)
        self._read_twist(message.twist, message.child_frame_id, stamp_ns)

    def _read_pose_message(self, message: Any, stamp_ns: int) -> None:
        self._read_pose(message.pose, message.header.frame_id, stamp_ns)

    def _read_twist_message(self, message: Any, stamp_ns: int) -> None:
        self._read_twist(message.twist, message.header.frame_id, stamp_ns)

    def _read_pose(self, message: Any, frame: str, stamp_ns: int) -> None:
        if not any(self._settings.used[POSE]):
            return
        world = self._frames.world
        sensor = self._context.poses.pose(world, world if self._settings.differential or not frame else frame, stamp_ns)
        if sensor is None:
            return
        position = message.pose.position
        pose: Transform = (position.x, position.y, position.z, *_orientation_from_message(message.pose.orientation))
        reading = self._pose.read(pose, _matrix_from_numbers(message.covariance, 6), sensor, stamp_ns)
        self._add(reading, "pose", stamp_ns, self._settings.pose_threshold)

    def _read_twist(self, message: Any, frame: str, stamp_ns: int) -> None:
        if any(self._settings.used[TWIST]):
            linear, angular = message.twist.linear, message.twist.angular
            self._add_twist(
                _array_from_vector(linear),
                _array_from_vector(angular),
                _matrix_from_numbers(message.covariance, 6),
                frame,
                stamp_ns,
            )

    def _add_twist(
        self,
        linear: NDArray[np.float64],
        angular: NDArray[np.float64],
        covariance: NDArray[np.float64],
        frame: str,
        stamp_ns: int,
    ) -> None:
        mounting = self._find_mounting(frame, stamp_ns)
        if mounting is not None:
            rates, used = self._context.filter.state[RATES], self._settings.used
            reading = read_twist(linear, angular, covariance, mounting, rates, used, two_d=self._two_d)
            self._add(reading, "twist", stamp_ns, self._settings.twist_threshold)

    def _read_imu(self, message: Any, stamp_ns: int) -> None:
        used, frame = self._settings.used, message.header.frame_id
        if any(used[ANGLES]) and _is_measured(message.orientation_covariance):
            mounting = self._find_mounting(frame, stamp_ns)
            if mounting is not None:
                covariance = np.zeros((6, 6))
                covariance[3:, 3:] = _matrix_from_numbers(message.orientation_covariance, 3)
                orientation = _orientation_from_message(message.orientation)
                reading = self._pose.read_orientation(orientation, covariance, mounting, stamp_ns)
                self._add(reading, "pose", stamp_ns, self._settings.pose_threshold)
        if any(used[RATES]) and _is_measured(message.angular_velocity_covariance):
            covariance = np.zeros((6, 6))
            covariance[3:, 3:] = _matrix_from_numbers(message.angular_velocity_covariance, 3)
            self._add_twist(np.zeros(3), _array_from_vector(message.angular_velocity), covariance, frame, stamp_ns)
        if any(used[12:]) and _is_measured(message.linear_acceleration_covariance):
            self._read_acceleration(message, stamp_ns)

    def _read_acceleration(self, message: Any, stamp_ns: int) -> None:
        mounting = self._find_mounting(message.header.frame_id, stamp_ns)
        if mounting is None:
            return
        acceleration = _array_from_vector(message.linear_acceleration)
        if self._settings.remove_gravity:
            attitude = self._find_attitude(message, mounting)
            acceleration = subtract_gravity(acceleration, attitude, self._context.configuration.gravity)
        covariance = _matrix_from_numbers(message.linear_acceleration_covariance, 3)
        reading = read_acceleration(acceleration, covariance, mounting, self._settings.used, two_d=self._two_d)
        self._add(reading, "acceleration", stamp_ns, self._settings.acceleration_threshold)

    def _find_attitude(self, message: Any, mounting: Transform) -> Quaternion:
        """Return the orientation from an IMU's message, or the estimate if the IMU measures none."""
        if _is_measured(message.orientation_covariance):
            return _orientation_from_message(message.orientation)
        roll, pitch, yaw = (float(angle) for angle in self._context.filter.state[ANGLES])
        return quaternion_multiply(quaternion_from_rpy((roll, pitch, yaw)), mounting[3:])

    def _find_mounting(self, frame: str, stamp_ns: int) -> Transform | None:
        base = self._frames.base
        return self._context.poses.pose(base, frame or base, stamp_ns)

    def _add(self, reading: Reading | None, quantity: str, stamp_ns: int, threshold: float) -> None:
        if reading is None or not any(reading.used):
            return
        kalman = self._context.filter
        self._context.estimator.add(
            Measurement(
                f"{self._settings.name}_{quantity}",
                stamp_ns,
                reading.values,
                reading.covariance,
                reading.used,
                threshold,
                None if kalman.settings.control is None else kalman.command,
            )
        )


def _is_measured(covariance: Any) -> bool:
    return abs(float(covariance[0]) - _NOT_MEASURED) >= 1e-9


def _orientation_from_message(message: Any) -> Quaternion:
    return normalized(message.x, message.y, message.z, message.w)


def _array_from_vector(message: Any) -> NDArray[np.float64]:
    return np.array((message.x, message.y, message.z))


def _matrix_from_numbers(numbers: Any, size: int) -> NDArray[np.float64]:
    return np.asarray(numbers, dtype=np.float64).reshape(size, size)
