"""Sensors of RotorS: ``librotors_gazebo_imu_plugin.so`` and ``librotors_gazebo_odometry_plugin.so``.

Source: rotors_simulator (parameters, defaults, topics, noise). The default noise is that of an ADIS16448. An image with
the places without odometry is left out.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.single import (
    Pose,
    Transform,
    Vector3,
    pose_quaternion,
    quaternion_multiply,
)
from linkwright.messages import Header, Quaternion, from_values, get_message
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.px4.sensors import Px4Imu, Px4ImuParameters
from linkwright.simulation.plugins.rotors.motors import name_topic
from linkwright.simulation.plugins.sensors.base import vector_to_message

_DEGREE_PER_HOUR = pi / 180.0 / 3600.0
_ZERO = (0.0, 0.0, 0.0)
_POSE, _COVARIANCE_POSE, _POSITION, _TRANSFORM, _ODOMETRY = (
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    "geometry_msgs/msg/PointStamped",
    "geometry_msgs/msg/TransformStamped",
    "nav_msgs/msg/Odometry",
)


@dataclass(frozen=True, kw_only=True)
class RotorsImuParameters(Px4ImuParameters):
    """Parameters of ``librotors_gazebo_imu_plugin.so``."""

    gyroscope_noise_density: float = parameter(70.0 * _DEGREE_PER_HOUR, aliases=("gyroscopeNoiseDensity",))
    gyroscope_random_walk: float = parameter(8.0 * _DEGREE_PER_HOUR, aliases=("gyroscopeRandomWalk",))
    gyroscope_turn_on_bias_sigma: float = parameter(0.5 / 180.0 * pi, aliases=("gyroscopeTurnOnBiasSigma",))
    accelerometer_noise_density: float = parameter(4e-3, aliases=("accelerometerNoiseDensity",))
    accelerometer_random_walk: float = parameter(6e-3, aliases=("accelerometerRandomWalk",))
    accelerometer_turn_on_bias_sigma: float = parameter(0.196, aliases=("accelerometerTurnOnBiasSigma",))


class RotorsImu(Px4Imu):
    """The substitute for ``librotors_gazebo_imu_plugin.so``."""

    PARAMETERS = RotorsImuParameters


@dataclass(frozen=True, kw_only=True)
class RotorsOdometryParameters:
    """Parameters of ``librotors_gazebo_odometry_plugin.so``: noise as standard deviations or half ranges."""

    link_name: str = parameter("odometry_sensor_link", aliases=("linkName",))
    pose_topic: str = parameter("pose", aliases=("poseTopic",))
    pose_with_covariance_topic: str = parameter("pose_with_covariance", aliases=("poseWithCovarianceTopic",))
    position_topic: str = parameter("position", aliases=("positionTopic",))
    transform_topic: str = parameter("transform", aliases=("transformTopic",))
    odometry_topic: str = parameter("odometry", aliases=("odometryTopic",))
    parent_frame_id: str = parameter("world", aliases=("parentFrameId",))
    child_frame_id: str = parameter("odometry_sensor", aliases=("childFrameId",))
    noise_normal_position: Vector3 = parameter(_ZERO, aliases=("noiseNormalPosition",))
    noise_normal_quaternion: Vector3 = parameter(_ZERO, aliases=("noiseNormalQuaternion",))
    noise_normal_linear_velocity: Vector3 = parameter(_ZERO, aliases=("noiseNormalLinearVelocity",))
    noise_normal_angular_velocity: Vector3 = parameter(_ZERO, aliases=("noiseNormalAngularVelocity",))
    noise_uniform_position: Vector3 = parameter(_ZERO, aliases=("noiseUniformPosition",))
    noise_uniform_quaternion: Vector3 = parameter(_ZERO, aliases=("noiseUniformQuaternion",))
    noise_uniform_linear_velocity: Vector3 = parameter(_ZERO, aliases=("noiseUniformLinearVelocity",))
    noise_uniform_angular_velocity: Vector3 = parameter(_ZERO, aliases=("noiseUniformAngularVelocity",))
    measurement_delay: int = parameter(0, aliases=("measurementDelay",))
    measurement_divisor: int = parameter(1, aliases=("measurementDivisor",))


class RotorsOdometry(SimulatedPlugin[RotorsOdometryParameters]):
    """The substitute for ``librotors_gazebo_odometry_plugin.so``.

    The pose of the center of mass is in the world. Each measurement is published after a delay, in steps.
    """

    PARAMETERS = RotorsOdometryParameters
    IGNORED = ("covarianceImage", "covarianceImageScale", "randomEngineSeed", "unknownDelay")

    def start(self) -> None:
        """Find the link, and create the topics.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        parameters = self.parameters
        self._link = self.link(parameters.link_name)
        topics = {
            _POSE: parameters.pose_topic,
            _COVARIANCE_POSE: parameters.pose_with_covariance_topic,
            _POSITION: parameters.position_topic,
            _TRANSFORM: parameters.transform_topic,
            _ODOMETRY: parameters.odometry_topic,
        }
        self._outputs = {kind: self.node.publisher(kind, name_topic(self, topic)) for kind, topic in topics.items()}
        self.reset()
        self.every(0.0, self._update)

    def reset(self) -> None:
        """Forget the measurements, and restart the noise."""
        self._random = self.random
        self._queue: deque[tuple[int, Any]] = deque()
        self._step = 0

    def _update(self) -> None:
        """Measure, and publish the measurement that is due."""
        parameters = self.parameters
        if self._step % max(parameters.measurement_divisor, 1) == 0 and self._is_wanted:
            self._queue.append((self._step + parameters.measurement_delay, self._measure()))
        if self._queue and self._queue[0][0] <= self._step:
            self._publish(self._queue.popleft()[1])
        self._step += 1

    @property
    def _is_wanted(self) -> bool:
        return any(output.is_wanted for output in self._outputs.values())

    def _measure(self) -> Any:
        parameters, simulation = self.parameters, self.simulation
        body, data = simulation.body(self._link), simulation.data
        pose = simulation.link_pose(self._link)
        axes = rotation_matrix(np.array(pose[3:]))
        linear, angular = (velocity @ axes for velocity in simulation.link_velocity(self._link))
        position = data.xipos[body] + self._draw("position")
        roll, pitch, yaw = self._draw("quaternion").tolist()
        turned: Transform = (*pose[:3], *quaternion_multiply(pose[3:], pose_quaternion(Pose(rpy=(roll, pitch, yaw)))))
        message = get_message(_ODOMETRY)(
            header=Header(stamp=self.stamp(), frame_id=parameters.parent_frame_id),
            child_frame_id=parameters.child_frame_id,
        )
        message.pose.pose.position = _to_point(position)
        message.pose.pose.orientation = from_values(Quaternion, turned[3:])
        message.twist.twist.linear = vector_to_message(linear + self._draw("linear_velocity"))
        message.twist.twist.angular = vector_to_message(angular + self._draw("angular_velocity"))
        for field, names in (
            (message.pose, ("position", "quaternion")),
            (message.twist, ("linear_velocity", "angular_velocity")),
        ):
            deviations = np.concatenate([self._get_deviations("normal", name) for name in names])
            field.covariance = np.diag(deviations**2).ravel()
        return message

    def _get_deviations(self, kind: str, name: str) -> Array:
        return np.array(getattr(self.parameters, f"noise_{kind}_{name}"))

    def _draw(self, name: str) -> Array:
        """Return the noise of a quantity, shape (3,)."""
        half_range = self._get_deviations("uniform", name)
        noise: Array = self._random.normal(0.0, self._get_deviations("normal", name))
        return noise + self._random.uniform(-half_range, half_range)

    def _publish(self, odometry: Any) -> None:
        header, pose = odometry.header, odometry.pose.pose
        transform = get_message("geometry_msgs/msg/Transform")(
            translation=get_message("geometry_msgs/msg/Vector3")(
                x=pose.position.x, y=pose.position.y, z=pose.position.z
            ),
            rotation=pose.orientation,
        )
        messages = {
            _POSE: {"pose": pose},
            _COVARIANCE_POSE: {"pose": odometry.pose},
            _POSITION: {"point": pose.position},
            _TRANSFORM: {"child_frame_id": odometry.child_frame_id, "transform": transform},
        }
        for kind, values in messages.items():
            self._outputs[kind].publish(get_message(kind)(header=header, **values))
        self._outputs[_ODOMETRY].publish(odometry)


def _to_point(position: Array) -> Any:
    x, y, z = position.tolist()
    return get_message("geometry_msgs/msg/Point")(x=x, y=y, z=z)
