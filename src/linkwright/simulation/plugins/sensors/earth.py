"""Sensors of geographic position, magnetic field, altitude, air pressure and air speed.

These plugins replace ``gazebo_ros_gps_sensor`` and the corresponding sensors of gz.

Source: gazebo_ros_pkgs for ROS 2 (topics, covariances), gz-sensors (topics), ros_gz (messages).
"""

from __future__ import annotations

from typing import Any, Generic, TypeVar

from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.sensors.base import (
    SENSOR_QOS,
    FrameNameParameter,
    SensorPlugin,
    SingleTopicSensor,
    vector_to_message,
)
from linkwright.simulation.sensors.air_speed import AirSpeedSensor
from linkwright.simulation.sensors.earth import AltimeterSensor, Barometer, Fix, MagnetometerSensor, NavsatSensor

P = TypeVar("P")
_FIX_TYPE = "sensor_msgs/msg/NavSatFix"
_MAGNETIC_FIELD_TYPE = "sensor_msgs/msg/MagneticField"
_ALTIMETER_TYPE = "ros_gz_interfaces/msg/Altimeter"
_PRESSURE_TYPE = "sensor_msgs/msg/FluidPressure"
_COVARIANCE_TYPE_DIAGONAL_KNOWN, _STATUS_FIX, _SERVICE_GPS = 2, 0, 1
"""Constants of ``sensor_msgs/msg/NavSatFix`` and ``NavSatStatus``."""


class _NavsatPlugin(SensorPlugin[P], Generic[P]):
    """A satellite navigation receiver that publishes ``sensor_msgs/msg/NavSatFix``."""

    def create_sensor(self) -> None:
        """Create the receiver for the geographic position of the world's origin."""
        coordinates = self.context.world.spherical_coordinates
        self._sensor = NavsatSensor(self.mount, self.sensor.sensor.navsat, coordinates, self.random)

    def measure_fix(self, frame: str) -> tuple[Fix, Any]:
        """Measure, and return the fix and its NavSatFix message."""
        fix = self._sensor.measure()
        message = self.message(_FIX_TYPE, frame)
        message.latitude, message.longitude, message.altitude = fix.latitude, fix.longitude, fix.altitude
        message.status.status, message.status.service = _STATUS_FIX, _SERVICE_GPS
        message.position_covariance = self._sensor.position_noise.covariance.copy()
        message.position_covariance_type = _COVARIANCE_TYPE_DIAGONAL_KNOWN
        return fix, message


class ClassicGps(_NavsatPlugin[FrameNameParameter]):
    """The substitute for ``libgazebo_ros_gps_sensor.so``.

    The plugin publishes the geographic position, and the velocity in m/s towards east, north and up.
    """

    PARAMETERS = FrameNameParameter

    def create_publishers(self) -> None:
        """Create the publishers of the position and the velocity."""
        self._fix_output = self.node.publisher(_FIX_TYPE, "~/out", SENSOR_QOS)
        self._velocity_output = self.node.publisher("geometry_msgs/msg/Vector3Stamped", "~/vel", SENSOR_QOS)

    def is_wanted(self) -> bool:
        """Return whether a topic has a subscription."""
        return self._fix_output.is_wanted or self._velocity_output.is_wanted

    def measure(self) -> None:
        """Measure, and publish the position and the velocity."""
        fix, message = self.measure_fix(self.classic_frame())
        self._fix_output.publish(message)
        velocity = self.message("geometry_msgs/msg/Vector3Stamped", self.classic_frame())
        velocity.vector = vector_to_message(fix.velocity)
        self._velocity_output.publish(velocity)


class GzNavsat(_NavsatPlugin[NoParameters], SingleTopicSensor[NoParameters]):
    """The sensors ``navsat`` and ``gps`` of gz."""

    def create_publishers(self) -> None:
        """Create the publisher of ``sensor_msgs/msg/NavSatFix``."""
        self.output = self.create_gz_output(_FIX_TYPE, "navsat")

    def measure(self) -> None:
        """Measure, and publish the position."""
        self.output.publish(self.measure_fix(self.gz_frame())[1])


class GzMagnetometer(SingleTopicSensor[NoParameters]):
    """The sensor ``magnetometer`` of gz.

    The sensor publishes the magnetic field in tesla, as ros_gz_bridge does.
    """

    def create_sensor(self) -> None:
        """Create the magnetometer for the magnetic field of the world."""
        noise, field = self.sensor.sensor.magnetometer, self.context.world.magnetic_field
        self._sensor = MagnetometerSensor(self.mount, noise, self.random, field)

    def create_publishers(self) -> None:
        """Create the publisher of ``sensor_msgs/msg/MagneticField``."""
        self.output = self.create_gz_output(_MAGNETIC_FIELD_TYPE, "magnetometer")

    def measure(self) -> None:
        """Measure, and publish the magnetic field."""
        message = self.message(_MAGNETIC_FIELD_TYPE, self.gz_frame())
        message.magnetic_field = vector_to_message(self._sensor.measure())
        message.magnetic_field_covariance = self._sensor.noise.covariance.copy()
        self.output.publish(message)


class GzAltimeter(SingleTopicSensor[NoParameters]):
    """The sensor ``altimeter`` of gz."""

    def create_sensor(self) -> None:
        """Create the altimeter."""
        self._sensor = AltimeterSensor(self.mount, self.sensor.sensor.altimeter, self.random)

    def create_publishers(self) -> None:
        """Create the publisher of ``ros_gz_interfaces/msg/Altimeter``."""
        self.output = self.create_gz_output(_ALTIMETER_TYPE, "altimeter")

    def measure(self) -> None:
        """Measure, and publish the height and the vertical velocity."""
        message = self.message(_ALTIMETER_TYPE, self.gz_frame())
        message.vertical_position, message.vertical_velocity = self._sensor.measure()
        message.vertical_reference = self._sensor.reference
        self.output.publish(message)


class GzAirPressure(SingleTopicSensor[NoParameters]):
    """The sensor ``air_pressure`` of gz."""

    def create_sensor(self) -> None:
        """Create the barometer."""
        self._sensor = Barometer(self.mount, self.sensor.sensor.air_pressure, self.random)

    def create_publishers(self) -> None:
        """Create the publisher of ``sensor_msgs/msg/FluidPressure``."""
        self.output = self.create_gz_output(_PRESSURE_TYPE, "air_pressure")

    def measure(self) -> None:
        """Measure, and publish the air pressure."""
        message = self.message(_PRESSURE_TYPE, self.gz_frame())
        message.fluid_pressure, message.variance = self._sensor.measure(), self._sensor.noise.variance
        self.output.publish(message)


class GzAirSpeed(SingleTopicSensor[NoParameters]):
    """The sensor ``air_speed`` of gz: the dynamic pressure of the air along the x axis of the sensor.

    ros_gz_bridge has no message for it; the pressure in Pa is a ``sensor_msgs/msg/FluidPressure`` here.
    """

    def create_sensor(self) -> None:
        """Create the pitot tube."""
        settings, with_mistakes = self.sensor.sensor.air_speed, self.gazebo_mistakes
        self._sensor = AirSpeedSensor(self.mount, settings, self.random, with_mistakes=with_mistakes)

    def create_publishers(self) -> None:
        """Create the publisher of ``sensor_msgs/msg/FluidPressure``."""
        self.output = self.create_gz_output(_PRESSURE_TYPE, "air_speed")

    def measure(self) -> None:
        """Measure, and publish the dynamic pressure."""
        message = self.message(_PRESSURE_TYPE, self.gz_frame())
        message.fluid_pressure, message.variance = self._sensor.measure(), self._sensor.noise.variance
        self.output.publish(message)
