"""IMUs: ``gazebo_ros_imu_sensor``, ``gazebo_ros_imu`` of ROS 1, and ``imu`` of gz.

Source: gazebo_ros_pkgs for ROS 2 (parameters, covariances) and ROS 1 (names), gz-sensors.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, Generic, TypeVar

from linkwright.geometry import single
from linkwright.geometry.single import compose, quaternion_from_rpy
from linkwright.messages import Header, Quaternion, Vector3, from_values, get_message
from linkwright.sdf.noise import Noise, NoiseXyz
from linkwright.sdf.sensors import Imu
from linkwright.simulation.plugins.parameters import NoParameters, parameter
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, FrameNameParameter, SingleTopicSensor
from linkwright.simulation.sensors.imu import ImuMeasurement, ImuSensor
from linkwright.simulation.sensors.mount import Mount

P = TypeVar("P")
_MESSAGE_TYPE = "sensor_msgs/msg/Imu"


@cache
def _get_message_class() -> Any:
    return get_message(_MESSAGE_TYPE)


class _ImuPlugin(SingleTopicSensor[P], Generic[P]):
    """An IMU that publishes ``sensor_msgs/msg/Imu``."""

    frame: str

    def create_sensor(self) -> None:
        """Create the IMU that the sensor's element describes."""
        self.imu = ImuSensor(self.mount, self.sensor.sensor.imu, generator=self.random)

    def measure(self) -> None:
        """Measure, and publish orientation, angular velocity and linear acceleration."""
        measurement = self.imu.measure()
        message = _get_message_class()(
            header=Header(stamp=self.stamp(), frame_id=self.frame),
            orientation=from_values(Quaternion, measurement.orientation),
            angular_velocity=from_values(Vector3, measurement.angular_velocity),
            angular_velocity_covariance=self.imu.angular_velocity_noise.covariance,
            linear_acceleration=from_values(Vector3, self.acceleration(measurement)),
            linear_acceleration_covariance=self.imu.acceleration_noise.covariance,
        )
        self.output.publish(message)

    def acceleration(self, measurement: ImuMeasurement) -> single.Vector3:
        """Return the acceleration to publish in m/s2, in the axes of the sensor; by default, it contains gravity."""
        return measurement.linear_acceleration


@dataclass(frozen=True, kw_only=True)
class ImuParameters(FrameNameParameter):
    """Parameters of ``gazebo_ros_imu_sensor``."""

    initial_orientation_as_reference: bool = parameter(False, aliases=("initialOrientationAsReference",))
    topic_name: str = parameter("", aliases=("topicName",))


class ClassicImu(_ImuPlugin[ImuParameters]):
    """The substitute for ``libgazebo_ros_imu_sensor.so``."""

    PARAMETERS = ImuParameters
    IGNORED = ("body_name", "bodyName", "updateRateHZ", "update_rate", "gaussianNoise", "xyzOffset", "rpyOffset")

    def create_sensor(self) -> None:
        """Create the IMU.

        If the parameters request it, orientations are relative to the initial orientation.
        """
        initial = self.parameters.initial_orientation_as_reference
        imu = self.sensor.sensor.imu
        self.imu = ImuSensor(self.mount, imu, generator=self.random, initial_reference=initial)

    def create_publishers(self) -> None:
        """Create the publisher on the topic that the parameters name, or ``~/out``."""
        self.frame = self.classic_frame()
        self.output = self.node.publisher(_MESSAGE_TYPE, self.parameters.topic_name or "~/out", SENSOR_QOS)


@dataclass(frozen=True, kw_only=True)
class Ros1ImuParameters(FrameNameParameter):
    """Parameters of ``gazebo_ros_imu`` of ROS 1."""

    body_name: str = parameter(aliases=("bodyName",))
    topic_name: str = parameter("imu", aliases=("topicName",))
    update_rate: float = parameter(0.0, aliases=("updateRate", "updateRateHZ"))
    gaussian_noise: float = parameter(0.0, aliases=("gaussianNoise",))
    xyz_offset: single.Vector3 = parameter((0.0, 0.0, 0.0), aliases=("xyzOffset", "xyzOffsets"))
    rpy_offset: single.Vector3 = parameter((0.0, 0.0, 0.0), aliases=("rpyOffset", "rpyOffsets"))


class OldImu(_ImuPlugin[Ros1ImuParameters]):
    """The substitute for the model plugin ``libgazebo_ros_imu.so`` of ROS 1.

    A parameter names the link.
    """

    PARAMETERS = Ros1ImuParameters
    IGNORED = ("serviceName",)

    @property
    def rate(self) -> float:
        """The number of measurements per simulated second, from the plugin's parameters."""
        return self.parameters.update_rate

    @property
    def mount(self) -> Mount:
        """The mount on the link that the parameters name, with the configured offset."""
        parameters = self.parameters
        rotation = (0.0, 0.0, 0.0, *quaternion_from_rpy(parameters.rpy_offset))
        offset = compose((*parameters.xyz_offset, 0.0, 0.0, 0.0, 1.0), rotation)
        return Mount(self.simulation, self.link(parameters.body_name), offset)

    def create_sensor(self) -> None:
        """Create an IMU with the same noise on all measured values."""
        axis_noise = (
            Noise("gaussian", stddev=self.parameters.gaussian_noise) if self.parameters.gaussian_noise else Noise()
        )
        noise = NoiseXyz(axis_noise, axis_noise, axis_noise)
        self.imu = ImuSensor(self.mount, Imu(noise, noise), generator=self.random)

    def create_publishers(self) -> None:
        """Create the publisher on the topic that the parameters name."""
        self.frame = self.parameters.frame_name.lstrip("/") or self.parameters.body_name
        self.output = self.node.publisher(_MESSAGE_TYPE, self.parameters.topic_name, SENSOR_QOS)


class GzImu(_ImuPlugin[NoParameters]):
    """The sensor ``imu`` of gz."""

    def create_publishers(self) -> None:
        """Create the publisher on the sensor's topic, or on gz's default topic."""
        self.frame = self.gz_frame()
        self.output = self.create_gz_output(_MESSAGE_TYPE, "imu")
