"""Sensors of uuv_simulator: pressure, magnetic field, position, true pose, inertia and satellites.

They are ``libuuv_gazebo_ros_subsea_pressure_plugin.so``, ``..._magnetometer_plugin.so``, ``..._rpt_plugin.so``,
``..._pose_gt_plugin.so``, ``..._imu_plugin.so``, and the sensor plugin ``..._gps_plugin.so``.

Source: uuv_simulator (parameters, defaults, topics, formulas). Mistakes of uuv_simulator, which are reproduced only on
request: pressures in kPa, that also rise above the water; the orientation noise of an IMU has the square of its
standard deviation; the signs of latitude and longitude.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, radians, sin
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array, quaternion_inverse, rotate
from linkwright.geometry.single import Transform, Vector3, compose, invert, normalized, quaternion_from_rpy
from linkwright.messages import Header, Quaternion, from_values, get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.sensors import Imu
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.px4.noise import BiasedNoise, BiasedNoiseSource
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, vector_to_message
from linkwright.simulation.plugins.underwater.sensor import (
    HALF_TURN,
    LinkSensor,
    LinkSensorParameters,
    SensorParameters,
    UnderwaterSensor,
)
from linkwright.simulation.sensors.earth import NavsatSensor
from linkwright.simulation.sensors.imu import ImuSensor

_PASCAL_PER_KILOPASCAL = 1000.0
_COVARIANCE_TYPE_KNOWN, _STATUS_FIX, _SERVICE_GPS = 3, 0, 1
"""Constants of ``sensor_msgs/msg/NavSatFix`` and ``NavSatStatus``."""


# --- pressure, magnetic field and position ----------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class PressureParameters(LinkSensorParameters):
    """Parameters of ``libuuv_gazebo_ros_subsea_pressure_plugin.so``, in kPa."""

    standard_pressure: float = 101.325
    pressure_per_meter: float = parameter(9.80638, aliases=("kPa_per_meter",))


class UuvPressure(LinkSensor[PressureParameters]):
    """The substitute for ``libuuv_gazebo_ros_subsea_pressure_plugin.so``: the pressure in Pa at a depth."""

    PARAMETERS = PressureParameters
    IGNORED = (*LinkSensor.IGNORED, "saturation", "estimate_depth_on")
    MESSAGE_TYPE = "sensor_msgs/msg/FluidPressure"

    def measure(self) -> None:
        """Measure, and publish the pressure."""
        depth = -self.mount.pose()[2]
        depth = abs(depth) if self.gazebo_mistakes else max(depth, 0.0)
        pressure = self.parameters.standard_pressure + depth * self.parameters.pressure_per_meter
        unit = 1.0 if self.gazebo_mistakes else _PASCAL_PER_KILOPASCAL
        message = self.message(self.MESSAGE_TYPE, self.link_frame)
        message.fluid_pressure = (pressure + float(self.draw_noise(1)[0])) * unit
        message.variance = self.variance * unit**2
        self.output.publish(message)


@dataclass(frozen=True, kw_only=True)
class UuvMagnetometerParameters(LinkSensorParameters):
    """Parameters of ``libuuv_gazebo_ros_magnetometer_plugin.so``: angles in rad."""

    intensity: float = 1.0
    reference_heading: float = pi
    declination: float = 0.0
    inclination: float = radians(60.0)
    noise_xy: float = 1.0
    noise_z: float = 1.4
    turn_on_bias: float = 2.0


class UuvMagnetometer(LinkSensor[UuvMagnetometerParameters]):
    """The substitute for ``libuuv_gazebo_ros_magnetometer_plugin.so``, whose field is that of its parameters."""

    PARAMETERS = UuvMagnetometerParameters
    MESSAGE_TYPE = "sensor_msgs/msg/MagneticField"

    def create_sensor(self) -> None:
        """Compute the magnetic field and the bias."""
        parameters = self.parameters
        azimuth, inclination = parameters.reference_heading - parameters.declination, parameters.inclination
        horizontal = cos(inclination)
        direction = (horizontal * cos(azimuth), horizontal * sin(azimuth), -sin(inclination))
        self._field = parameters.intensity * np.array(direction)
        self._bias = self.draw_noise(sigma=parameters.turn_on_bias)

    def measure(self) -> None:
        """Measure, and publish the magnetic field."""
        self.publish_frame()
        deviations = np.array((self.parameters.noise_xy, self.parameters.noise_xy, self.parameters.noise_z))
        message = self.message(self.MESSAGE_TYPE, self.frame)
        field = self.to_frame(self._field) + self._bias + deviations * self.draw_noise(sigma=1.0)
        message.magnetic_field = vector_to_message(field)
        message.magnetic_field_covariance = np.diag(deviations**2).ravel()
        self.output.publish(message)


class UuvPosition(LinkSensor[LinkSensorParameters]):
    """The substitute for ``libuuv_gazebo_ros_rpt_plugin.so``: the position in the reference frame."""

    PARAMETERS = LinkSensorParameters
    MESSAGE_TYPE = "uuv_sensor_ros_plugins_msgs/msg/PositionWithCovarianceStamped"

    def measure(self) -> None:
        """Measure, and publish the position."""
        position = np.array(compose(invert(self.reference), self.mount.pose())[:3]) + self.draw_noise()
        message = self.message(self.MESSAGE_TYPE, self.reference_frame)
        message.pos.pos.x, message.pos.pos.y, message.pos.pos.z = position.tolist()
        message.pos.covariance = np.diag([self.variance] * 3).ravel()
        self.output.publish(message)


# --- true pose --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class PoseParameters(LinkSensorParameters):
    """Parameters of ``libuuv_gazebo_ros_pose_gt_plugin.so``."""

    position_offset: Vector3 = (0.0, 0.0, 0.0)
    orientation_offset: Vector3 = (0.0, 0.0, 0.0)
    publish_ned_odom: bool = False


class UuvPose(LinkSensor[PoseParameters]):
    """The substitute for ``libuuv_gazebo_ros_pose_gt_plugin.so``: the true pose and velocity.

    With ``<publish_ned_odom>``, the topic with ``_ned`` has the pose of axes forward, right, down in the reference
    frame. Velocities are in the axes of the frame of the pose.
    """

    PARAMETERS = PoseParameters
    MESSAGE_TYPE = "nav_msgs/msg/Odometry"

    def create_sensor(self) -> None:
        """Compute the offset of the pose."""
        parameters = self.parameters
        rotation = quaternion_from_rpy(parameters.orientation_offset)
        self._offset: Transform = (*parameters.position_offset, *rotation)

    def create_publishers(self) -> None:
        """Create the publishers of the poses."""
        super().create_publishers()
        self._ned_output = self.node.publisher(self.MESSAGE_TYPE, f"{self.parameters.sensor_topic}_ned", SENSOR_QOS)

    def is_wanted(self) -> bool:
        """Return whether a topic has a subscription."""
        return self.output.is_wanted or self._ned_output.is_wanted

    def measure(self) -> None:
        """Publish the pose and the velocity."""
        mount, reference = self.mount, self.reference
        pose, (linear, angular) = mount.pose(), (np.array(vector) for vector in mount.velocity())
        if self._reference_link:
            reference_linear, reference_angular = self.simulation.link_velocity(self._reference_link)
            linear, angular = linear - reference_linear, angular - reference_angular
        linear, angular = linear + self.draw_noise(), angular + self.draw_noise()
        message = self._create_odometry("world", self.link_frame, compose(self._offset, pose), linear, angular)
        self.output.publish(message)
        if self.parameters.publish_ned_odom:
            pose = compose(self._offset, compose(compose(invert(reference), pose), HALF_TURN))
            to_reference = quaternion_inverse(np.array(reference[3:]))
            linear, angular = rotate(to_reference, linear), rotate(to_reference, angular)
            frame = f"{self.link_frame}_ned"
            self._ned_output.publish(self._create_odometry(self.reference_frame, frame, pose, linear, angular))

    def _create_odometry(self, frame: str, child_frame: str, pose: Transform, linear: Array, angular: Array) -> Any:
        header = Header(stamp=self.stamp(), frame_id=frame)
        message = get_message(self.MESSAGE_TYPE)(header=header, child_frame_id=child_frame)
        position = message.pose.pose.position
        position.x, position.y, position.z = pose[:3]
        message.pose.pose.orientation = from_values(Quaternion, pose[3:])
        message.twist.twist.linear, message.twist.twist.angular = vector_to_message(linear), vector_to_message(angular)
        for estimate in (message.pose, message.twist):
            estimate.covariance[::7] = [self.variance] * 6
        return message


# --- IMU and satellites -----------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class UuvImuParameters(LinkSensorParameters):
    """Parameters of ``libuuv_gazebo_ros_imu_plugin.so``, by default those of the ADIS16448."""

    gyroscope_noise_density: float = radians(2.0 * 35.0 / 3600.0)
    gyroscope_bias_random_walk: float = radians(2.0 * 4.0 / 3600.0)
    gyroscope_bias_correlation_time: float = 1000.0
    gyroscope_turn_on_bias_sigma: float = radians(0.5)
    accelerometer_noise_density: float = 4e-3
    accelerometer_random_walk: float = 6e-3
    accelerometer_bias_correlation_time: float = 300.0
    accelerometer_turn_on_bias_sigma: float = 0.196
    orientation_noise: float = 0.5


class UuvImu(LinkSensor[UuvImuParameters]):
    """The substitute for ``libuuv_gazebo_ros_imu_plugin.so``.

    The orientation is that of the link in the reference frame, and the noise of rates and accelerations is multiplied
    by ``<noise_amplitude>``.
    """

    PARAMETERS = UuvImuParameters
    IGNORED = (*LinkSensor.IGNORED, "gyroscope_random_walk")
    MESSAGE_TYPE = "sensor_msgs/msg/Imu"

    def create_sensor(self) -> None:
        """Create the IMU and its noise."""
        parameters, amplitude = self.parameters, self.parameters.noise_amplitude
        self._imu = ImuSensor(self.mount, Imu(), generator=self._generator)
        rate_noise = BiasedNoise(
            parameters.gyroscope_noise_density * amplitude,
            parameters.gyroscope_bias_random_walk * amplitude,
            parameters.gyroscope_bias_correlation_time,
        )
        acceleration_noise = BiasedNoise(
            parameters.accelerometer_noise_density * amplitude,
            parameters.accelerometer_random_walk * amplitude,
            parameters.accelerometer_bias_correlation_time,
        )
        self._rate_noise = BiasedNoiseSource(rate_noise, self._generator)
        self._acceleration_noise = BiasedNoiseSource(acceleration_noise, self._generator)
        self._rate_bias = self.draw_noise(sigma=parameters.gyroscope_turn_on_bias_sigma)
        self._acceleration_bias = self.draw_noise(sigma=parameters.accelerometer_turn_on_bias_sigma)

    def measure(self) -> None:
        """Measure, and publish the measurement."""
        self.publish_frame()
        parameters, measurement = self.parameters, self._imu.measure()
        period = 1.0 / self.rate if self.rate > 0.0 else self.simulation.step / NANOSECONDS_PER_SECOND
        axes = (1.0, -1.0, -1.0) if parameters.enable_local_ned_frame else (1.0, 1.0, 1.0)
        rates = self._rate_noise.apply(np.array(measurement.angular_velocity) * axes, period)
        acceleration = self._acceleration_noise.apply(np.array(measurement.linear_acceleration) * axes, period)
        message = self.message(self.MESSAGE_TYPE, self.link_frame)
        message.orientation = from_values(Quaternion, self._measure_orientation())
        message.angular_velocity = vector_to_message(rates + self._rate_bias)
        message.linear_acceleration = vector_to_message(acceleration + self._acceleration_bias)
        for covariance, deviation in (
            ("orientation", parameters.orientation_noise),
            ("angular_velocity", parameters.gyroscope_noise_density),
            ("linear_acceleration", parameters.accelerometer_noise_density),
        ):
            setattr(message, f"{covariance}_covariance", np.diag([deviation**2] * 3).ravel())
        self.output.publish(message)

    def _measure_orientation(self) -> tuple[float, float, float, float]:
        """Return the orientation in the reference frame, with noise."""
        deviation = self.parameters.orientation_noise
        deviation = deviation**2 if self.gazebo_mistakes else deviation
        x, y, z = (0.5 * deviation * self._generator.standard_normal(3)).tolist()
        orientation = compose(invert(self.reference), self.mount.pose())[3:]
        return compose((0.0, 0.0, 0.0, *orientation), (0.0, 0.0, 0.0, *normalized(x, y, z, 1.0)))[3:]


@dataclass(frozen=True, kw_only=True)
class UuvGpsParameters(SensorParameters):
    """Parameters of ``libuuv_gazebo_ros_gps_plugin.so``."""

    horizontal_pos_std_dev: float = 0.0
    vertical_pos_std_dev: float = 0.0


class UuvGps(UnderwaterSensor[UuvGpsParameters]):
    """The substitute for the sensor plugin ``libuuv_gazebo_ros_gps_plugin.so``, with the noise of the sensor."""

    PARAMETERS = UuvGpsParameters
    MESSAGE_TYPE = "sensor_msgs/msg/NavSatFix"

    @property
    def rate(self) -> float:
        """The number of measurements per simulated second, which is that of the sensor."""
        return self.sensor.sensor.update_rate

    def create_sensor(self) -> None:
        """Create the receiver for the geographic position of the world's origin."""
        coordinates = self.context.world.spherical_coordinates
        self._receiver = NavsatSensor(self.mount, self.sensor.sensor.navsat, coordinates, self._generator)

    def measure(self) -> None:
        """Measure, and publish the position."""
        fix, parameters = self._receiver.measure(), self.parameters
        namespace = self.text_in(self.context.element, "robot_namespace").strip("/")
        message = self.message(self.MESSAGE_TYPE, f"{namespace}/gps_link".lstrip("/"))
        sign = -1.0 if self.gazebo_mistakes else 1.0
        message.latitude, message.longitude, message.altitude = sign * fix.latitude, sign * fix.longitude, fix.altitude
        message.status.status, message.status.service = _STATUS_FIX, _SERVICE_GPS
        horizontal, vertical = parameters.horizontal_pos_std_dev**2, parameters.vertical_pos_std_dev**2
        message.position_covariance = np.diag((horizontal, horizontal, vertical)).ravel()
        message.position_covariance_type = _COVARIANCE_TYPE_KNOWN
        self.output.publish(message)
