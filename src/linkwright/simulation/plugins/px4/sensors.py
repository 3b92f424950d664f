"""Sensors of PX4's models, which are plugins of the model.

They are ``libgazebo_imu_plugin.so``, ``libgazebo_magnetometer_plugin.so``, ``libgazebo_barometer_plugin.so``,
``libgazebo_groundtruth_plugin.so``, and the sensor plugin ``libgazebo_gps_plugin.so``.

Source: PX4-SITL_gazebo-classic (parameters, defaults, rates, noise, delay of the receiver). Topics of Gazebo's
transport are topics of ROS in the namespace of the model, with messages of ROS in its units and axes. Magnetometers
measure the field of the world, not that of a model of the earth. The home position is that of the world; environment
variables of PX4 have no effect.
"""

from __future__ import annotations

from abc import ABC
from collections import deque
from dataclasses import dataclass, replace
from math import sqrt
from typing import Any, Generic, TypeVar

import numpy as np

from linkwright.geometry.arrays import Array, quaternion_inverse, rotate
from linkwright.messages import Quaternion, from_values, get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.sensors import Imu
from linkwright.sdf.worlds import SphericalCoordinates
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.px4.noise import BiasedNoise, BiasedNoiseSource
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, SensorPlugin, SingleTopicSensor, vector_to_message
from linkwright.simulation.sensors.earth import Globe, standard_pressure
from linkwright.simulation.sensors.imu import ImuSensor
from linkwright.simulation.sensors.mount import Mount

P = TypeVar("P")

_ZURICH = SphericalCoordinates(latitude_deg=47.397742, longitude_deg=8.545594, elevation=488.0)
"""The home position of worlds without coordinates."""
_TESLA_PER_GAUSS = 1e-4
_PRESSURE_DEVIATION_PA = 1.0
_RECEIVER_DELAY_NS = 120_000_000
_POSITION_CORRELATION_TIME_S = 60.0
_COVARIANCE_TYPE_UNKNOWN, _STATUS_FIX, _SERVICE_GPS = 0, 0, 1
"""Constants of ``sensor_msgs/msg/NavSatFix`` and ``NavSatStatus``."""


class ModelSensor(SensorPlugin[P], ABC, Generic[P]):
    """A sensor of a whole model, on its first link."""

    @property
    def rate(self) -> float:
        """The number of measurements per simulated second, or 0 to measure after each step."""
        return max(float(getattr(self.parameters, "pub_rate", 0.0)), 0.0)

    @property
    def mount(self) -> Mount:
        """The mount at the origin of the link."""
        name: str = getattr(self.parameters, "link_name", "")
        return Mount(self.simulation, self.link(name) if name else self.first_link)

    @property
    def frame(self) -> str:
        """The name of the link."""
        return self.mount.link.rpartition(SEPARATOR)[2].lstrip("/")

    @property
    def period(self) -> float:
        """The time between two measurements, in s."""
        return 1.0 / self.rate if self.rate > 0.0 else self.simulation.step / NANOSECONDS_PER_SECOND

    @property
    def home(self) -> SphericalCoordinates:
        """The coordinates of the world, or those of Zurich."""
        return self.context.world.spherical_coordinates or _ZURICH

    def topic(self, name: str) -> str:
        """Return a topic in the namespace of the plugin, by default that of the model."""
        model, _, _ = self.context.path.partition(SEPARATOR)
        return f"/{self.text_in(self.context.element, 'robotNamespace').strip('/') or model}/{name.lstrip('/')}"

    def sensor_topic(self, name: str) -> str:
        """Return the topic of a sensor plugin, with the name of the sensor's model if `name` is empty."""
        *_, parent, _, _ = ("", *self.sensor.name.split(SEPARATOR))
        return self.topic(f"link/{name or parent}")


# --- IMU and magnetometer ---------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Px4ImuParameters:
    """Parameters of ``libgazebo_imu_plugin.so``."""

    link_name: str = parameter(aliases=("linkName",))
    topic_name: str = parameter("imu", aliases=("imuTopic",))
    gyroscope_noise_density: float = parameter(0.0008726646, aliases=("gyroscopeNoiseDensity",))
    gyroscope_random_walk: float = parameter(0.0, aliases=("gyroscopeRandomWalk",))
    gyroscope_bias_correlation_time: float = parameter(1000.0, aliases=("gyroscopeBiasCorrelationTime",))
    gyroscope_turn_on_bias_sigma: float = parameter(0.0, aliases=("gyroscopeTurnOnBiasSigma",))
    accelerometer_noise_density: float = parameter(0.00637, aliases=("accelerometerNoiseDensity",))
    accelerometer_random_walk: float = parameter(0.0, aliases=("accelerometerRandomWalk",))
    accelerometer_bias_correlation_time: float = parameter(300.0, aliases=("accelerometerBiasCorrelationTime",))
    accelerometer_turn_on_bias_sigma: float = parameter(0.0, aliases=("accelerometerTurnOnBiasSigma",))


class Px4Imu(ModelSensor[Px4ImuParameters], SingleTopicSensor[Px4ImuParameters]):
    """The substitute for ``libgazebo_imu_plugin.so``, which measures after each step."""

    PARAMETERS = Px4ImuParameters

    def create_sensor(self) -> None:
        """Create the IMU and its noise."""
        parameters, generator = self.parameters, self.random
        self._imu = ImuSensor(self.mount, Imu(), generator=generator)
        rate_noise = BiasedNoise(
            parameters.gyroscope_noise_density,
            parameters.gyroscope_random_walk,
            parameters.gyroscope_bias_correlation_time,
            parameters.gyroscope_turn_on_bias_sigma,
        )
        acceleration_noise = BiasedNoise(
            parameters.accelerometer_noise_density,
            parameters.accelerometer_random_walk,
            parameters.accelerometer_bias_correlation_time,
            parameters.accelerometer_turn_on_bias_sigma,
        )
        self._rate_noise = BiasedNoiseSource(rate_noise, generator)
        self._acceleration_noise = BiasedNoiseSource(acceleration_noise, generator)

    def create_publishers(self) -> None:
        """Create the publisher of ``sensor_msgs/msg/Imu``."""
        self.output = self.node.publisher("sensor_msgs/msg/Imu", self.topic(self.parameters.topic_name), SENSOR_QOS)

    def measure(self) -> None:
        """Measure, and publish the measurement."""
        message = self.message("sensor_msgs/msg/Imu", self.frame)
        orientation, rates, acceleration = self.measure_motion()
        message.orientation = from_values(Quaternion, orientation)
        message.angular_velocity = vector_to_message(rates)
        message.linear_acceleration = vector_to_message(acceleration)
        message.angular_velocity_covariance = self._rate_noise.covariance
        message.linear_acceleration_covariance = self._acceleration_noise.covariance
        self.output.publish(message)

    def measure_motion(self) -> tuple[tuple[float, ...], Array, Array]:
        """Return the orientation, the angular velocity in rad/s and the proper acceleration in m/s2.

        The angular velocity and the acceleration are in the frame of the link, with noise.
        """
        measurement = self._imu.measure()
        rates = self._rate_noise.apply(np.array(measurement.angular_velocity), self.period)
        acceleration = self._acceleration_noise.apply(np.array(measurement.linear_acceleration), self.period)
        return measurement.orientation, rates, acceleration


@dataclass(frozen=True, kw_only=True)
class Px4MagnetometerParameters:
    """Parameters of ``libgazebo_magnetometer_plugin.so``: noise in gauss."""

    pub_rate: float = parameter(100.0, aliases=("pubRate",))
    topic_name: str = parameter("mag", aliases=("magTopic",))
    noise_density: float = parameter(0.4e-3, aliases=("noiseDensity",))
    random_walk: float = parameter(6.4e-6, aliases=("randomWalk",))
    bias_correlation_time: float = parameter(600.0, aliases=("biasCorrelationTime",))


class Px4Magnetometer(ModelSensor[Px4MagnetometerParameters], SingleTopicSensor[Px4MagnetometerParameters]):
    """The substitute for ``libgazebo_magnetometer_plugin.so``."""

    PARAMETERS = Px4MagnetometerParameters

    def create_sensor(self) -> None:
        """Create the noise."""
        parameters = self.parameters
        density, random_walk = (
            value * _TESLA_PER_GAUSS for value in (parameters.noise_density, parameters.random_walk)
        )
        noise = BiasedNoise(density, random_walk, parameters.bias_correlation_time)
        self._noise = BiasedNoiseSource(noise, self.random)

    def create_publishers(self) -> None:
        """Create the publisher of ``sensor_msgs/msg/MagneticField``."""
        self.output = self.node.publisher(
            "sensor_msgs/msg/MagneticField", self.topic(self.parameters.topic_name), SENSOR_QOS
        )

    def measure(self) -> None:
        """Measure, and publish the magnetic field in the frame of the link."""
        message = self.message("sensor_msgs/msg/MagneticField", self.frame)
        message.magnetic_field = vector_to_message(self.measure_field())
        message.magnetic_field_covariance = self._noise.covariance
        self.output.publish(message)

    def measure_field(self) -> Array:
        """Return the magnetic field in T in the frame of the link, with noise."""
        rotation = np.array(self.mount.pose()[3:])
        field = rotate(quaternion_inverse(rotation), np.array(self.context.world.magnetic_field))
        return self._noise.apply(field, self.period)


# --- barometer --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Px4BarometerParameters:
    """Parameters of ``libgazebo_barometer_plugin.so``."""

    pub_rate: float = parameter(50.0, aliases=("pubRate",))
    topic_name: str = parameter("/baro", aliases=("baroTopic",))
    drift_per_second: float = parameter(0.0, aliases=("baroDriftPaPerSec",))


class Px4Barometer(ModelSensor[Px4BarometerParameters], SingleTopicSensor[Px4BarometerParameters]):
    """The substitute for ``libgazebo_barometer_plugin.so``.

    The initial height of the model is the altitude of home.
    """

    PARAMETERS = Px4BarometerParameters
    CARRIED = ("_initial_height",)

    def create_sensor(self) -> None:
        """Create the noise, and measure the initial height."""
        self._generator = self.random
        self._initial_height = self.mount.pose()[2]

    def create_publishers(self) -> None:
        """Create the publisher of ``sensor_msgs/msg/FluidPressure``."""
        self.output = self.node.publisher(
            "sensor_msgs/msg/FluidPressure", self.topic(self.parameters.topic_name), SENSOR_QOS
        )

    def measure(self) -> None:
        """Measure, and publish the air pressure."""
        message = self.message("sensor_msgs/msg/FluidPressure", self.frame)
        message.fluid_pressure, _ = self.measure_air()
        message.variance = _PRESSURE_DEVIATION_PA**2
        self.output.publish(message)

    def measure_air(self) -> tuple[float, float]:
        """Return the air pressure in Pa, with noise and drift, and the true altitude in m."""
        altitude = self.home.elevation + self.mount.pose()[2] - self._initial_height
        noise = self._generator.normal(0.0, _PRESSURE_DEVIATION_PA)
        drift = self.parameters.drift_per_second * self.simulation.seconds
        return standard_pressure(altitude) + noise + drift, altitude


# --- position ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class HomeParameters:
    """The home position of worlds without coordinates."""

    home_latitude: float = parameter(_ZURICH.latitude_deg, aliases=("homeLatitude",))
    home_longitude: float = parameter(_ZURICH.longitude_deg, aliases=("homeLongitude",))
    home_altitude: float = parameter(_ZURICH.elevation, aliases=("homeAltitude",))

    def place(self, coordinates: SphericalCoordinates | None) -> SphericalCoordinates:
        """Return the coordinates of a world, or home if it has none."""
        if coordinates is not None:
            return coordinates
        return replace(
            _ZURICH,
            latitude_deg=self.home_latitude,
            longitude_deg=self.home_longitude,
            elevation=self.home_altitude,
        )


class Px4Groundtruth(ModelSensor[HomeParameters]):
    """The substitute for ``libgazebo_groundtruth_plugin.so``: the true pose and velocity of a model.

    They are published as ``nav_msgs/msg/Odometry``, and the position as ``sensor_msgs/msg/NavSatFix``.
    """

    PARAMETERS = HomeParameters

    def create_sensor(self) -> None:
        """Place the world on earth."""
        self._globe = Globe(self.parameters.place(self.context.world.spherical_coordinates))

    def create_publishers(self) -> None:
        """Create the publishers of the odometry and of the position."""
        self._odometry_output = self.node.publisher("nav_msgs/msg/Odometry", self.topic("groundtruth"), SENSOR_QOS)
        self._fix_output = self.node.publisher("sensor_msgs/msg/NavSatFix", self.topic("groundtruth/fix"), SENSOR_QOS)

    def is_wanted(self) -> bool:
        """Return whether a topic has a subscription."""
        return self._odometry_output.is_wanted or self._fix_output.is_wanted

    def measure(self) -> None:
        """Publish the pose and the velocity."""
        pose, (linear, angular) = self.mount.pose(), self.mount.velocity()
        to_link = quaternion_inverse(np.array(pose[3:]))
        message = self.message("nav_msgs/msg/Odometry", "world")
        message.child_frame_id = self.frame
        x, y, z = pose[:3]
        message.pose.pose.position = get_message("geometry_msgs/msg/Point")(x=x, y=y, z=z)
        message.pose.pose.orientation = from_values(Quaternion, pose[3:])
        message.twist.twist.linear = vector_to_message(rotate(to_link, np.array(linear)))
        message.twist.twist.angular = vector_to_message(rotate(to_link, np.array(angular)))
        self._odometry_output.publish(message)
        self._fix_output.publish(_create_fix(self, self._globe, np.array(pose[:3])))

    def locate(self) -> tuple[float, float, float]:
        """Return the latitude and longitude in degrees, and the altitude in m."""
        return self._globe.to_geodetic(np.array(self.mount.pose()[:3]))


@dataclass(frozen=True, kw_only=True)
class Px4GpsParameters(HomeParameters):
    """Parameters of ``libgazebo_gps_plugin.so``."""

    topic_name: str = parameter("", aliases=("topic",))
    pub_rate: float = parameter(5.0, aliases=("update_rate",))
    noise: bool = parameter(False, aliases=("gpsNoise",))
    xy_random_walk: float = parameter(2.0, aliases=("gpsXYRandomWalk",))
    z_random_walk: float = parameter(4.0, aliases=("gpsZRandomWalk",))
    xy_noise_density: float = parameter(2.0e-4, aliases=("gpsXYNoiseDensity",))
    z_noise_density: float = parameter(4.0e-4, aliases=("gpsZNoiseDensity",))
    vxy_noise_density: float = parameter(0.2, aliases=("gpsVXYNoiseDensity",))
    vz_noise_density: float = parameter(0.4, aliases=("gpsVZNoiseDensity",))


class Px4Gps(ModelSensor[Px4GpsParameters]):
    """The substitute for ``libgazebo_gps_plugin.so``: a receiver whose measurements are 0.12 s old.

    It publishes the position, and the velocity in m/s towards east, north and up. In a model, as in older models of
    PX4, the topic is ``gps``.
    """

    PARAMETERS = Px4GpsParameters

    def start(self) -> None:
        """Create the publishers, and record the motion after each step."""
        super().start()
        self.every(0.0, self._record)

    def create_sensor(self) -> None:
        """Place the world on earth, and create the noise."""
        self._globe = Globe(self.parameters.place(self.context.world.spherical_coordinates))
        self._generator = self.random
        self._bias: Array = np.zeros(3)
        self._records: deque[tuple[int, Array, Array]] = deque()

    def create_publishers(self) -> None:
        """Create the publishers of the position and the velocity."""
        name = self.parameters.topic_name
        topic = self.topic(name or "gps") if self.context.sensor is None else self.sensor_topic(name)
        self._fix_output = self.node.publisher("sensor_msgs/msg/NavSatFix", topic, SENSOR_QOS)
        self._velocity_output = self.node.publisher("geometry_msgs/msg/Vector3Stamped", f"{topic}/vel", SENSOR_QOS)

    def is_wanted(self) -> bool:
        """Return whether a topic has a subscription."""
        return self._fix_output.is_wanted or self._velocity_output.is_wanted

    def _record(self) -> None:
        """Record the position and the velocity of the model, with noise."""
        parameters, seconds = self.parameters, self.simulation.step / NANOSECONDS_PER_SECOND
        position, velocity = np.array(self.mount.pose()[:3]), np.array(self.mount.velocity()[0])
        if parameters.noise:
            draw = self._generator.standard_normal
            walk, density, speed_density = (
                np.array((horizontal, horizontal, vertical)) * sqrt(seconds)
                for horizontal, vertical in (
                    (parameters.xy_random_walk, parameters.z_random_walk),
                    (parameters.xy_noise_density, parameters.z_noise_density),
                    (parameters.vxy_noise_density, parameters.vz_noise_density),
                )
            )
            self._bias = self._bias + walk * draw(3) * seconds - self._bias / _POSITION_CORRELATION_TIME_S
            position = position + density * draw(3) + self._bias
            velocity = velocity + speed_density * draw(3)
        self._records.append((self.simulation.time, position, velocity))
        while len(self._records) > 1 and self._records[1][0] <= self.simulation.time - _RECEIVER_DELAY_NS:
            self._records.popleft()

    def measure(self) -> None:
        """Publish the position and the velocity of 0.12 s before."""
        if not self._records:
            return
        _, position, velocity = self._records[0]
        self._fix_output.publish(_create_fix(self, self._globe, position))
        message = self.message("geometry_msgs/msg/Vector3Stamped", self.frame)
        message.vector = vector_to_message(self._globe.to_east_north_up(velocity))
        self._velocity_output.publish(message)

    def receive(self) -> tuple[tuple[float, float, float], Array] | None:
        """Return the position and the velocity of 0.12 s before, or None before the first step.

        The position is latitude and longitude in degrees, and the altitude in m. The velocity is in m/s towards east,
        north and up.
        """
        if not self._records:
            return None
        _, position, velocity = self._records[0]
        return self._globe.to_geodetic(position), self._globe.to_east_north_up(velocity)


def _create_fix(sensor: ModelSensor[Any], globe: Globe, position: Array) -> Any:
    """Return a position in the world as a NavSatFix."""
    fix = sensor.message("sensor_msgs/msg/NavSatFix", sensor.frame)
    fix.latitude, fix.longitude, fix.altitude = globe.to_geodetic(position)
    fix.status.status, fix.status.service = _STATUS_FIX, _SERVICE_GPS
    fix.position_covariance_type = _COVARIANCE_TYPE_UNKNOWN
    return fix
