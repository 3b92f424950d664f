"""Sensors of hector_gazebo_plugins and hector_quadrotor, which are plugins of the model.

They are ``libhector_gazebo_ros_imu.so``, ``..._gps.so``, ``..._magnetic.so`` and ``..._baro.so``, and the sensor plugin
``libhector_gazebo_ros_sonar.so``.

Source: hector_gazebo_plugins for ROS 1 (parameters, defaults, topics, the model of the errors, the conversion to
latitude and longitude). Types of messages that only these packages have, and dynamic_reconfigure, are left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, radians, sin, sqrt
from typing import Any, Generic, TypeVar

import numpy as np

from linkwright.geometry.arrays import Array, quaternion_inverse, rotate
from linkwright.geometry.single import Transform, compose, normalized, quaternion_from_rpy
from linkwright.messages import Quaternion, from_values
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.sensors import Imu
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, SensorPlugin, SingleTopicSensor, vector_to_message
from linkwright.simulation.plugins.sensors.hector_errors import ErrorModel, error_names
from linkwright.simulation.plugins.sensors.lidar import LaserParameters, OldLaser
from linkwright.simulation.sensors.imu import ImuSensor
from linkwright.simulation.sensors.lidar import Scan
from linkwright.simulation.sensors.mount import Mount

_VECTOR_TYPE, _FIX_TYPE, _IMU_TYPE = (
    "geometry_msgs/msg/Vector3Stamped",
    "sensor_msgs/msg/NavSatFix",
    "sensor_msgs/msg/Imu",
)
_EQUATORIAL_RADIUS_M = 6378137.0
_SQUARED_ECCENTRICITY = (2.0 - 1.0 / 298.257223563) / 298.257223563
_COVARIANCE_TYPE_DIAGONAL_KNOWN = 2


@dataclass(frozen=True, kw_only=True)
class HectorParameters:
    """Parameters that all these plugins of the model have in common."""

    body_name: str = parameter("", aliases=("bodyName",))
    frame_id: str = parameter("", aliases=("frameId",))
    update_rate: float = parameter(0.0, aliases=("updateRate",))


P = TypeVar("P", bound=HectorParameters)


class _HectorSensor(SensorPlugin[P], Generic[P]):
    """A sensor on a link that a parameter names, by default the first link."""

    @property
    def rate(self) -> float:
        """The number of measurements per simulated second, or 0 to measure after each step."""
        return max(self.parameters.update_rate, 0.0)

    @property
    def mount(self) -> Mount:
        """The mount at the origin of the link."""
        name = self.parameters.body_name
        return Mount(self.simulation, self.link(name) if name else self.first_link)

    @property
    def frame(self) -> str:
        """The frame of the messages, by default the link."""
        return self.parameters.frame_id.lstrip("/") or self.mount.link.rpartition(SEPARATOR)[2]

    @property
    def period(self) -> float:
        """The time between two measurements, in s."""
        return 1.0 / self.rate if self.rate > 0.0 else self.simulation.step / NANOSECONDS_PER_SECOND

    def create_error_model(self, prefix: str = "") -> ErrorModel:
        """Return the model of the errors whose parameters have a prefix."""
        return ErrorModel(self.context.element, prefix, self._generator)

    def start(self) -> None:
        """Create the sensor model and the publishers, and schedule measurements."""
        self._generator = self.random
        super().start()

    def reset(self) -> None:
        """Create the sensor model again, so that its random numbers restart."""
        self._generator = self.random
        super().reset()


# --- IMU --------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class HectorImuParameters(HectorParameters):
    """Parameters of ``libhector_gazebo_ros_imu.so``."""

    topic_name: str = parameter("imu", aliases=("topicName",))
    bias_topic_name: str = parameter("", aliases=("biasTopicName",))
    service_name: str = parameter("", aliases=("serviceName",))
    gaussian_noise: float = parameter(0.0, aliases=("gaussianNoise",))
    rpy_offset: tuple[float, float, float] = parameter((0.0, 0.0, 0.0), aliases=("rpyOffset",))


class HectorImu(_HectorSensor[HectorImuParameters]):
    """The substitute for ``libhector_gazebo_ros_imu.so``.

    The biases are published, too. A service ``std_srvs/srv/Empty`` sets the bias of the angular velocity to zero.
    """

    PARAMETERS = HectorImuParameters
    IGNORED = ("xyzOffset", *error_names("accel"), *error_names("rate"), *error_names("yaw"))

    def create_sensor(self) -> None:
        """Create the IMU, and the models of its errors."""
        mount = self.mount
        offset: Transform = (0.0, 0.0, 0.0, *quaternion_from_rpy(self.parameters.rpy_offset))
        self._imu = ImuSensor(Mount(mount.simulation, mount.link, offset), Imu(), generator=self._generator)
        self._acceleration, self._rates, self._yaw = (
            self.create_error_model(prefix) for prefix in ("accel", "rate", "yaw")
        )
        noise = self.parameters.gaussian_noise
        if noise:
            self._acceleration.gaussian_noise = self._rates.gaussian_noise = np.full(3, noise)

    def create_publishers(self) -> None:
        """Create the publishers of the measurements and the biases, and the service."""
        parameters, node = self.parameters, self.node
        topic = parameters.topic_name
        self._output = node.publisher(_IMU_TYPE, topic, SENSOR_QOS)
        self._bias_output = node.publisher(_IMU_TYPE, parameters.bias_topic_name or f"{topic}/bias", SENSOR_QOS)
        node.service("std_srvs/srv/Empty", parameters.service_name or f"{topic}/calibrate", self._calibrate)

    def is_wanted(self) -> bool:
        """Return whether a topic has a subscription."""
        return self._output.is_wanted or self._bias_output.is_wanted

    def _calibrate(self, _: Any, response: Any) -> Any:
        self._rates.drift = np.zeros(3)
        return response

    def measure(self) -> None:
        """Measure, and publish the measurements and the biases."""
        measurement, period = self._imu.measure(), self.period
        acceleration = self._acceleration.apply(np.array(measurement.linear_acceleration), period)
        rates = self._rates.apply(np.array(measurement.angular_velocity), period)
        self._yaw.advance(period)
        message = self.message(_IMU_TYPE, self.frame)
        gravity = float(np.linalg.norm(self.simulation.model.opt.gravity))
        orientation = measurement.orientation
        if gravity > 0.0:
            tilt = rotate(np.array(orientation), self._acceleration.bias) / gravity
            half_yaw = 0.5 * float(self._yaw.bias[0])
            yaw_error: Transform = (0.0, 0.0, 0.0, 0.0, 0.0, sin(half_yaw), cos(half_yaw))
            tilt_error = normalized(0.5 * float(tilt[1]), -0.5 * float(tilt[0]), 0.0, 1.0)
            error = compose(yaw_error, (0.0, 0.0, 0.0, *tilt_error))
            orientation = compose(error, (0.0, 0.0, 0.0, *orientation))[3:]
        message.orientation = from_values(Quaternion, orientation)
        message.angular_velocity, message.linear_acceleration = (
            vector_to_message(rates),
            vector_to_message(acceleration),
        )
        message.angular_velocity_covariance = self._rates.covariance
        message.linear_acceleration_covariance = self._acceleration.covariance
        message.orientation_covariance = self._compute_orientation_covariance(gravity)
        self._output.publish(message)
        biases = self.message(_IMU_TYPE, self.frame)
        biases.orientation.w = 1.0
        biases.angular_velocity = vector_to_message(self._rates.bias)
        biases.linear_acceleration = vector_to_message(self._acceleration.bias)
        self._bias_output.publish(biases)

    def _compute_orientation_covariance(self, gravity: float) -> Array:
        """Return the covariance of the orientation, of which gravity gives roll and pitch."""
        if gravity <= 0.0:
            return np.diag((-1.0, -1.0, self._yaw.covariance[0])).ravel()
        tilt = self._acceleration.covariance[[0, 4]] / gravity**2
        return np.diag((*tilt, self._yaw.covariance[0])).ravel()


# --- GPS --------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class HectorGpsParameters(HectorParameters):
    """Parameters of ``libhector_gazebo_ros_gps.so``."""

    frame_id: str = parameter("world", aliases=("frameId",))
    update_rate: float = parameter(4.0, aliases=("updateRate",))
    topic_name: str = parameter("fix", aliases=("topicName",))
    velocity_topic_name: str = parameter("fix_velocity", aliases=("velocityTopicName",))
    use_world_spherical_coordinates: bool = parameter(False, aliases=("useWorldSphericalCoordinates",))
    reference_latitude: float | None = parameter(None, aliases=("referenceLatitude",))
    reference_longitude: float | None = parameter(None, aliases=("referenceLongitude",))
    reference_heading: float | None = parameter(None, aliases=("referenceHeading",))
    reference_altitude: float | None = parameter(None, aliases=("referenceAltitude",))
    status: int = 0
    service: int = 0


class HectorGps(_HectorSensor[HectorGpsParameters]):
    """The substitute for ``libhector_gazebo_ros_gps.so``.

    The velocity points north, west and up.
    """

    PARAMETERS = HectorGpsParameters
    IGNORED = (*error_names(""), *error_names("velocity"))

    def create_sensor(self) -> None:
        """Compute the reference position, and create the models of the errors."""
        parameters, coordinates = self.parameters, self.context.world.spherical_coordinates
        latitude, longitude, heading, altitude = 49.9, 8.9, 0.0, 0.0
        if parameters.use_world_spherical_coordinates and coordinates is not None:
            latitude, longitude = coordinates.latitude_deg, coordinates.longitude_deg
            heading, altitude = 90.0 - coordinates.heading_deg, coordinates.elevation
        requested = (
            parameters.reference_latitude,
            parameters.reference_longitude,
            parameters.reference_heading,
            parameters.reference_altitude,
        )
        defaults = (latitude, longitude, heading, altitude)
        self._latitude, self._longitude, degrees, self._altitude = (
            default if value is None else value for value, default in zip(requested, defaults, strict=True)
        )
        self._heading = radians(degrees)
        curvature = 1.0 / (1.0 - _SQUARED_ECCENTRICITY * sin(radians(self._latitude)) ** 2)
        radius = _EQUATORIAL_RADIUS_M * sqrt(curvature)
        self._radius_north = radius * (1.0 - _SQUARED_ECCENTRICITY) * curvature
        self._radius_east = radius * cos(radians(self._latitude))
        self._position, self._velocity = self.create_error_model(), self.create_error_model("velocity")

    def create_publishers(self) -> None:
        """Create the publishers of the position and the velocity."""
        self._fix_output = self.node.publisher(_FIX_TYPE, self.parameters.topic_name, SENSOR_QOS)
        self._velocity_output = self.node.publisher(_VECTOR_TYPE, self.parameters.velocity_topic_name, SENSOR_QOS)

    def is_wanted(self) -> bool:
        """Return whether a topic has a subscription."""
        return self._fix_output.is_wanted or self._velocity_output.is_wanted

    def measure(self) -> None:
        """Measure, and publish the position and the velocity."""
        simulation, link, period = self.simulation, self.mount.link, self.period
        velocity = self._to_north_west_up(self._velocity.apply(simulation.link_velocity(link)[0], period))
        position = self._to_north_west_up(self._position.apply(np.array(simulation.link_pose(link)[:3]), period))
        self._position.drift = self._position.drift + period * self._velocity.drift
        fix = self.message(_FIX_TYPE, self.frame)
        fix.status.status, fix.status.service = self.parameters.status, self.parameters.service
        fix.latitude = self._latitude + float(position[0]) / self._radius_north * 180.0 / pi
        fix.longitude = self._longitude - float(position[1]) / self._radius_east * 180.0 / pi
        fix.altitude = self._altitude + float(position[2])
        fix.position_covariance = self._position.total_covariance
        fix.position_covariance_type = _COVARIANCE_TYPE_DIAGONAL_KNOWN
        self._fix_output.publish(fix)
        message = self.message(_VECTOR_TYPE, self.frame)
        message.vector = vector_to_message(velocity)
        self._velocity_output.publish(message)

    def _to_north_west_up(self, vector: Array) -> Array:
        """Return a vector in the axes of the world in the axes north, west and up."""
        x, y, z = vector
        cosine, sine = cos(self._heading), sin(self._heading)
        return np.array((cosine * x + sine * y, -sine * x + cosine * y, z))


# --- magnetometer -----------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class HectorMagneticParameters(HectorParameters):
    """Parameters of ``libhector_gazebo_ros_magnetic.so``."""

    topic_name: str = parameter("magnetic", aliases=("topicName",))
    use_world_spherical_coordinates: bool = parameter(False, aliases=("useWorldSphericalCoordinates",))
    use_magnetic_field_msgs: bool = parameter(False, aliases=("useMagneticFieldMsgs",))
    magnitude: float = 1.0
    reference_heading: float | None = parameter(None, aliases=("referenceHeading",))
    declination: float = 0.0
    inclination: float = 60.0


class HectorMagnetic(_HectorSensor[HectorMagneticParameters], SingleTopicSensor[HectorMagneticParameters]):
    """The substitute for ``libhector_gazebo_ros_magnetic.so``."""

    PARAMETERS = HectorMagneticParameters
    IGNORED = error_names("")

    def create_sensor(self) -> None:
        """Compute the magnetic field, and create the model of the errors."""
        parameters, coordinates = self.parameters, self.context.world.spherical_coordinates
        heading = 0.0
        if parameters.use_world_spherical_coordinates and coordinates is not None:
            heading = 90.0 - coordinates.heading_deg
        if parameters.reference_heading is not None:
            heading = parameters.reference_heading
        azimuth, inclination = radians(heading - parameters.declination), radians(parameters.inclination)
        horizontal = cos(inclination)
        self._field = parameters.magnitude * np.array(
            (horizontal * cos(azimuth), horizontal * sin(azimuth), -sin(inclination))
        )
        self._errors = self.create_error_model()

    def create_publishers(self) -> None:
        """Create the publisher of a MagneticField or a Vector3Stamped."""
        self._message_type = (
            "sensor_msgs/msg/MagneticField" if self.parameters.use_magnetic_field_msgs else _VECTOR_TYPE
        )
        self.output = self.node.publisher(self._message_type, self.parameters.topic_name, SENSOR_QOS)

    def measure(self) -> None:
        """Measure, and publish the magnetic field in the frame of the link."""
        rotation = np.array(self.simulation.link_pose(self.mount.link)[3:])
        field = self._errors.apply(rotate(quaternion_inverse(rotation), self._field), self.period)
        message = self.message(self._message_type, self.frame)
        setattr(
            message, "magnetic_field" if self.parameters.use_magnetic_field_msgs else "vector", vector_to_message(field)
        )
        self.output.publish(message)


# --- barometer --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class HectorBaroParameters(HectorParameters):
    """Parameters of ``libhector_gazebo_ros_baro.so``."""

    topic_name: str = parameter("pressure_height", aliases=("topicName",))
    update_rate: float = parameter(10.0, aliases=("updateRate",))


class HectorBaro(_HectorSensor[HectorBaroParameters], SingleTopicSensor[HectorBaroParameters]):
    """The substitute for ``libhector_gazebo_ros_baro.so``.

    It publishes the height as a ``geometry_msgs/msg/PointStamped``, without the altimeter's own type of message.
    """

    PARAMETERS = HectorBaroParameters
    IGNORED = ("altimeterTopicName", "elevation", "qnh", *error_names(""))

    def create_sensor(self) -> None:
        """Create the model of the errors."""
        self._errors = self.create_error_model()

    def create_publishers(self) -> None:
        """Create the publisher of the height."""
        self.output = self.node.publisher("geometry_msgs/msg/PointStamped", self.parameters.topic_name, SENSOR_QOS)

    def measure(self) -> None:
        """Measure, and publish the height."""
        height = np.array((0.0, 0.0, self.simulation.link_pose(self.mount.link)[2]))
        message = self.message("geometry_msgs/msg/PointStamped", self.frame)
        message.point.z = float(self._errors.apply(height, self.period)[2])
        self.output.publish(message)


# --- sonar ------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class HectorSonarParameters(LaserParameters):
    """Parameters of ``libhector_gazebo_ros_sonar.so``."""

    frame_name: str = parameter("sonar_link", aliases=("frameId",))
    topic_name: str = parameter("sonar", aliases=("topicName",))
    update_rate: float = parameter(10.0, aliases=("updateRate",))


class HectorSonar(OldLaser):
    """The substitute for ``libhector_gazebo_ros_sonar.so``: the least distance, with errors."""

    PARAMETERS = HectorSonarParameters
    IGNORED = error_names("")
    MESSAGE_TYPE = "sensor_msgs/msg/Range"

    def create_sensor(self) -> None:
        """Create the lidar, and the model of the errors."""
        super().create_sensor()
        self._errors = ErrorModel(self.context.element, "", self.random)

    @property
    def rate(self) -> float:
        """The number of measurements per simulated second, from the plugin's parameters."""
        return self.parameters.update_rate

    def create_output_message(self, frame: str, scan: Scan) -> Any:
        """Return the minimum distance of a scan as a Range, with errors and the sensor's limits."""
        message = self.create_range_message(frame, scan, "ultrasound")
        if message.range < message.max_range:
            period = 1.0 / self.rate if self.rate > 0.0 else self.simulation.step / NANOSECONDS_PER_SECOND
            distance = float(self._errors.apply(np.full(3, message.range), period)[0])
            message.range = min(max(distance, message.min_range), message.max_range)
        return message
