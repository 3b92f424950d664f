"""Satellite receivers, altimeters, barometers and magnetometers.

Source: the ellipsoid of WGS 84 (NIMA TR8350.2), the placement of the world by the element ``<spherical_coordinates>``,
and the standard atmosphere of ISO 2533 up to 11 km.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, radians, sin, sqrt

import numpy as np

from linkwright.geometry.arrays import Array, quaternion_inverse, rotate
from linkwright.geometry.single import Vector3
from linkwright.sdf.noise import NoiseXyz
from linkwright.sdf.sensors import AirPressure, Altimeter, Navsat
from linkwright.sdf.worlds import SphericalCoordinates
from linkwright.simulation.sensors.mount import Mount
from linkwright.simulation.sensors.noise import NoiseSource, VectorNoise

_EQUATORIAL_RADIUS_M = 6378137.0
_FLATTENING = 1 / 298.257223563
"""The flattening of the ellipsoid of WGS 84."""
_SQUARED_ECCENTRICITY = _FLATTENING * (2 - _FLATTENING)
_ITERATIONS = 5
"""The number of iterations for the latitude. Each iteration reduces the error to less than a hundredth."""
_ATMOSPHERE_RADIUS, _GRAVITY = 6356766.0, 9.80665
"""The standard atmosphere's radius of the earth in m, and gravity in m/s2."""
_SEA_PRESSURE, _SEA_TEMPERATURE, _LAPSE_RATE, _AIR_GAS_CONSTANT = 101325.0, 288.15, 0.0065, 287.05287
"""Pressure in Pa and temperature in K at sea level, lapse rate in K/m, and gas constant of air in J/(kg K)."""
EARTH_FIELD: Vector3 = (5.5645e-6, 22.8758e-6, -42.3884e-6)
"""The magnetic field in tesla of worlds that do not set it: the default of SDFormat."""


class Globe:
    """The position and heading of a world on earth.

    Args:
        coordinates: the coordinates of the world; None for latitude and longitude 0.
    """

    def __init__(self, coordinates: SphericalCoordinates | None) -> None:
        coordinates = coordinates or SphericalCoordinates()
        latitude, longitude = radians(coordinates.latitude_deg), radians(coordinates.longitude_deg)
        heading = radians(coordinates.heading_deg)
        self._origin = _from_geodetic(latitude, longitude, coordinates.elevation)
        east = (-sin(longitude), cos(longitude), 0.0)
        north = (-sin(latitude) * cos(longitude), -sin(latitude) * sin(longitude), cos(latitude))
        up = (cos(latitude) * cos(longitude), cos(latitude) * sin(longitude), sin(latitude))
        self._axes = np.array([east, north, up]).T
        self._heading = np.array(
            [[cos(heading), -sin(heading), 0.0], [sin(heading), cos(heading), 0.0], [0.0, 0.0, 1.0]]
        )

    def to_east_north_up(self, vector: Array) -> Array:
        """Return a vector, given in the axes of the world, in the axes east, north and up."""
        rotated: Array = self._heading @ vector
        return rotated

    def to_geodetic(self, point: Array) -> tuple[float, float, float]:
        """Return the latitude, longitude (degrees) and altitude (m) of a point in the world.

        The point is in m. The altitude is measured from the ellipsoid.
        """
        x, y, z = self._origin + self._axes @ self.to_east_north_up(point)
        axis_distance = hypot(x, y)
        latitude = atan2(z, axis_distance * (1 - _SQUARED_ECCENTRICITY))
        for _ in range(_ITERATIONS):
            normal_radius = _EQUATORIAL_RADIUS_M / sqrt(1 - _SQUARED_ECCENTRICITY * sin(latitude) ** 2)
            latitude = atan2(z + _SQUARED_ECCENTRICITY * normal_radius * sin(latitude), axis_distance)
        normal_radius = _EQUATORIAL_RADIUS_M / sqrt(1 - _SQUARED_ECCENTRICITY * sin(latitude) ** 2)
        altitude = (
            axis_distance * cos(latitude)
            + z * sin(latitude)
            - normal_radius * (1 - _SQUARED_ECCENTRICITY * sin(latitude) ** 2)
        )
        return degrees(latitude), degrees(atan2(y, x)), altitude

    def from_geodetic(self, latitude: float, longitude: float, altitude: float) -> Array:
        """Return the point in the world, in m, at a latitude and longitude (degrees) and an altitude (m).

        The altitude is measured from the ellipsoid.
        """
        position = _from_geodetic(radians(latitude), radians(longitude), altitude)
        point: Array = self._heading.T @ self._axes.T @ (position - self._origin)
        return point


def _from_geodetic(latitude: float, longitude: float, altitude: float) -> Array:
    """Return a position in earth-centered coordinates, in m.

    Latitude and longitude are in rad.
    """
    normal_radius = _EQUATORIAL_RADIUS_M / sqrt(1 - _SQUARED_ECCENTRICITY * sin(latitude) ** 2)
    axis_distance = (normal_radius + altitude) * cos(latitude)
    return np.array(
        [
            axis_distance * cos(longitude),
            axis_distance * sin(longitude),
            (normal_radius * (1 - _SQUARED_ECCENTRICITY) + altitude) * sin(latitude),
        ]
    )


@dataclass(frozen=True, slots=True)
class Fix:
    """A measurement of a satellite receiver.

    Attributes:
        latitude, longitude: the geodetic position, in degrees.
        altitude: the altitude above the ellipsoid, in m.
        velocity: the velocity east, north and up, in m/s, shape (3,).
    """

    latitude: float
    longitude: float
    altitude: float
    velocity: Array


class NavsatSensor:
    """A satellite receiver.

    The position noise in m is added before conversion to latitude and longitude.

    Args:
        mount: the mount of the sensor.
        navsat: the parsed sensor; None for no noise.
        coordinates: the coordinates of the world; None for a world without them.
        generator: the source of the noise.
    """

    def __init__(
        self,
        mount: Mount,
        navsat: Navsat | None,
        coordinates: SphericalCoordinates | None,
        generator: np.random.Generator,
    ) -> None:
        settings = navsat or Navsat()
        horizontal_noise, vertical_noise = settings.horizontal_position, settings.vertical_position
        self.position_noise = VectorNoise(NoiseXyz(horizontal_noise, horizontal_noise, vertical_noise), generator)
        horizontal_noise, vertical_noise = settings.horizontal_velocity, settings.vertical_velocity
        self.velocity_noise = VectorNoise(NoiseXyz(horizontal_noise, horizontal_noise, vertical_noise), generator)
        self._mount = mount
        self._globe = Globe(coordinates)

    def measure(self) -> Fix:
        """Return the current position and velocity.

        Raises:
            KeyError: the link no longer exists.
        """
        position = self.position_noise.apply(np.array(self._mount.pose()[:3]))
        velocity = self._globe.to_east_north_up(np.array(self._mount.velocity()[0]))
        return Fix(*self._globe.to_geodetic(position), self.velocity_noise.apply(velocity))


class AltimeterSensor:
    """An altimeter that measures the height above its initial height.

    Args:
        mount: the mount of the sensor.
        altimeter: the parsed sensor; None for no noise.
        generator: the source of the noise.
    """

    def __init__(self, mount: Mount, altimeter: Altimeter | None, generator: np.random.Generator) -> None:
        settings = altimeter or Altimeter()
        self._position_noise = NoiseSource(settings.vertical_position, generator)
        self._velocity_noise = NoiseSource(settings.vertical_velocity, generator)
        self._mount = mount
        self.reference = mount.pose()[2]

    def measure(self) -> tuple[float, float]:
        """Return the height in m above the initial height, and the upward velocity in m/s.

        Raises:
            KeyError: the link no longer exists.
        """
        height = np.array(self._mount.pose()[2] - self.reference)
        velocity = np.array(self._mount.velocity()[0][2])
        return float(self._position_noise.apply(height)), float(self._velocity_noise.apply(velocity))


class Barometer:
    """A barometer that measures the air pressure at its altitude.

    Args:
        mount: the mount of the sensor.
        settings: the altitude of the world's origin, and noise in Pa; None for sea level and no noise.
        generator: the source of the noise.

    Attributes:
        noise: the noise of the pressure.
    """

    def __init__(self, mount: Mount, settings: AirPressure | None, generator: np.random.Generator) -> None:
        settings = settings or AirPressure()
        self.noise = NoiseSource(settings.noise, generator)
        self._mount = mount
        self._altitude = settings.reference_altitude

    def measure(self) -> float:
        """Return the air pressure in Pa, with noise.

        Raises:
            KeyError: the link no longer exists.
        """
        pressure = standard_pressure(self._altitude + self._mount.pose()[2])
        return float(self.noise.apply(np.array(pressure)))


def standard_pressure(altitude: float) -> float:
    """Return the pressure of the standard atmosphere in Pa at an altitude in m."""
    height = _ATMOSPHERE_RADIUS * altitude / (_ATMOSPHERE_RADIUS + altitude)
    temperature_ratio = max(1.0 - _LAPSE_RATE * height / _SEA_TEMPERATURE, 0.0)
    return float(_SEA_PRESSURE * temperature_ratio ** (_GRAVITY / (_AIR_GAS_CONSTANT * _LAPSE_RATE)))


class MagnetometerSensor:
    """A magnetometer that measures the magnetic field in the axes of the sensor.

    Args:
        mount: the mount of the sensor.
        noise: the noise on each axis, in tesla; None for no noise.
        field: the magnetic field of the world in tesla, in the axes of the world.
        generator: the source of the noise.
    """

    def __init__(
        self, mount: Mount, noise: NoiseXyz | None, generator: np.random.Generator, field: Vector3 = EARTH_FIELD
    ) -> None:
        self.noise = VectorNoise(noise or NoiseXyz(), generator)
        self._mount = mount
        self._field = np.array(field)

    def measure(self) -> Array:
        """Return the magnetic field in tesla in the axes of the sensor, shape (3,).

        Raises:
            KeyError: the link no longer exists.
        """
        return self.noise.apply(rotate(quaternion_inverse(np.array(self._mount.pose()[3:])), self._field))
