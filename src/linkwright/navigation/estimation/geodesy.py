"""Convert WGS 84 coordinates in degrees to meters: UTM and tangent planes.

Sources: L. Krüger 1912 for the transverse Mercator projection, with the coefficients of C. Karney, "Transverse Mercator
with an accuracy of a few nanometers", 2011, to the fourth order, whose error is far below a millimeter within a zone;
EPSG Guidance Note 7-2 for the zones, false origins and the plane.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import asinh, atan, atan2, atanh, cos, cosh, degrees, floor, hypot, radians, sin, sinh, sqrt, tan
from typing import NamedTuple

from linkwright.geometry.single import Vector3, dot

_EQUATORIAL_RADIUS_M = 6378137.0
_FLATTENING = 1.0 / 298.257223563
"""The flattening of the ellipsoid of WGS 84."""
_ECCENTRICITY_SQUARED = _FLATTENING * (2.0 - _FLATTENING)
_ECCENTRICITY = sqrt(_ECCENTRICITY_SQUARED)
_N = _FLATTENING / (2.0 - _FLATTENING)
"""The third flattening of the ellipsoid, n in the sources."""
_CENTRAL_SCALE, _FALSE_EASTING_M, _FALSE_NORTHING_M = 0.9996, 500000.0, 10000000.0
_RECTIFYING_RADIUS_M = _EQUATORIAL_RADIUS_M / (1.0 + _N) * (1.0 + _N**2 / 4.0 + _N**4 / 64.0)
_FORWARD_COEFFICIENTS = (
    _N / 2.0 - 2.0 * _N**2 / 3.0 + 5.0 * _N**3 / 16.0 + 41.0 * _N**4 / 180.0,
    13.0 * _N**2 / 48.0 - 3.0 * _N**3 / 5.0 + 557.0 * _N**4 / 1440.0,
    61.0 * _N**3 / 240.0 - 103.0 * _N**4 / 140.0,
    49561.0 * _N**4 / 161280.0,
)
_INVERSE_COEFFICIENTS = (
    _N / 2.0 - 2.0 * _N**2 / 3.0 + 37.0 * _N**3 / 96.0 - _N**4 / 360.0,
    _N**2 / 48.0 + _N**3 / 15.0 - 437.0 * _N**4 / 1440.0,
    17.0 * _N**3 / 480.0 - 37.0 * _N**4 / 840.0,
    4397.0 * _N**4 / 161280.0,
)
_ITERATION_COUNT = 6
"""The number of iterations for the latitude. Each reduces the error by a factor of hundreds."""


class UtmZone(NamedTuple):
    """A UTM zone, 1 to 60, in the northern or southern hemisphere."""

    number: int
    is_northern: bool

    @property
    def meridian(self) -> float:
        """The longitude of the zone's central meridian, in rad."""
        return radians(6.0 * self.number - 183.0)


def zone_from_degrees(latitude: float, longitude: float) -> UtmZone:
    """Return the UTM zone of a position in degrees.

    Some zones of Norway and Svalbard are wider or narrower than the others.
    """
    longitude = (longitude + 180.0) % 360.0 - 180.0
    number = floor((longitude + 180.0) / 6.0) + 1
    if 56.0 <= latitude < 64.0 and 3.0 <= longitude < 12.0:
        number = 32
    elif 72.0 <= latitude <= 84.0 and 0.0 <= longitude < 42.0:
        number = 31 + 2 * int((longitude + 3.0) // 12.0)
    return UtmZone(number, latitude >= 0.0)


def utm_from_degrees(latitude: float, longitude: float, zone: UtmZone) -> tuple[float, float]:
    """Convert a position in degrees to easting and northing in meters."""
    tau = tan(radians(latitude))
    sigma = sinh(_ECCENTRICITY * atanh(_ECCENTRICITY * tau / hypot(1.0, tau)))
    conformal = tau * hypot(1.0, sigma) - sigma * hypot(1.0, tau)
    offset = radians(longitude) - zone.meridian
    xi = atan2(conformal, cos(offset))
    eta = asinh(sin(offset) / hypot(conformal, cos(offset)))
    north, east = xi, eta
    for order, factor in enumerate(_FORWARD_COEFFICIENTS, 1):
        north += factor * sin(2 * order * xi) * cosh(2 * order * eta)
        east += factor * cos(2 * order * xi) * sinh(2 * order * eta)
    false_northing = 0.0 if zone.is_northern else _FALSE_NORTHING_M
    return (
        _FALSE_EASTING_M + _CENTRAL_SCALE * _RECTIFYING_RADIUS_M * east,
        false_northing + _CENTRAL_SCALE * _RECTIFYING_RADIUS_M * north,
    )


def degrees_from_utm(easting: float, northing: float, zone: UtmZone) -> tuple[float, float]:
    """Convert easting and northing in meters to latitude and longitude in degrees.

    This is the inverse of `utm_from_degrees`.
    """
    north = (northing - (0.0 if zone.is_northern else _FALSE_NORTHING_M)) / (_CENTRAL_SCALE * _RECTIFYING_RADIUS_M)
    east = (easting - _FALSE_EASTING_M) / (_CENTRAL_SCALE * _RECTIFYING_RADIUS_M)
    xi, eta = north, east
    for order, factor in enumerate(_INVERSE_COEFFICIENTS, 1):
        xi -= factor * sin(2 * order * north) * cosh(2 * order * east)
        eta -= factor * cos(2 * order * north) * sinh(2 * order * east)
    target = sin(xi) / hypot(sinh(eta), cos(xi))
    tau = target / (1.0 - _ECCENTRICITY_SQUARED)
    for _ in range(_ITERATION_COUNT):
        sigma = sinh(_ECCENTRICITY * atanh(_ECCENTRICITY * tau / hypot(1.0, tau)))
        conformal = tau * hypot(1.0, sigma) - sigma * hypot(1.0, tau)
        slope = (1.0 + (1.0 - _ECCENTRICITY_SQUARED) * tau * tau) / (1.0 - _ECCENTRICITY_SQUARED)
        tau += (target - conformal) / hypot(1.0, conformal) * slope / hypot(1.0, tau)
    longitude = degrees(zone.meridian + atan2(sinh(eta), cos(xi)))
    return degrees(atan(tau)), (longitude + 180.0) % 360.0 - 180.0


def convergence(latitude: float, longitude: float, zone: UtmZone) -> float:
    """Return the meridian convergence, in rad, at a position in degrees.

    The meridian convergence is the clockwise angle from true north to grid north.
    """
    return atan(tan(radians(longitude) - zone.meridian) * sin(radians(latitude)))


@dataclass(frozen=True, slots=True)
class TangentPlane:
    """A plane tangent to the ellipsoid, whose x, y and z axes point east, north and up.

    Args:
        latitude: the latitude of the plane's origin, in degrees.
        longitude: the longitude of the plane's origin, in degrees.
        altitude: the altitude of the plane's origin above the ellipsoid, in meters.
    """

    latitude: float
    longitude: float
    altitude: float

    def point_from_geodetic(self, latitude: float, longitude: float, altitude: float) -> Vector3:
        """Convert latitude and longitude in degrees and altitude in meters to a point in meters."""
        x, y, z = _geocentric_from_geodetic(latitude, longitude, altitude)
        ox, oy, oz = _geocentric_from_geodetic(self.latitude, self.longitude, self.altitude)
        east, north, up = self._axes()
        offset = (x - ox, y - oy, z - oz)
        return dot(east, offset), dot(north, offset), dot(up, offset)

    def geodetic_from_point(self, point: Vector3) -> Vector3:
        """Convert a point in meters to latitude and longitude in degrees and altitude in meters."""
        ox, oy, oz = _geocentric_from_geodetic(self.latitude, self.longitude, self.altitude)
        axes = self._axes()
        x, y, z = (
            sum(axis[index] * coordinate for axis, coordinate in zip(axes, point, strict=True)) for index in range(3)
        )
        return _geodetic_from_geocentric(ox + x, oy + y, oz + z)

    def _axes(self) -> tuple[Vector3, Vector3, Vector3]:
        phi, lam = radians(self.latitude), radians(self.longitude)
        return (
            (-sin(lam), cos(lam), 0.0),
            (-sin(phi) * cos(lam), -sin(phi) * sin(lam), cos(phi)),
            (cos(phi) * cos(lam), cos(phi) * sin(lam), sin(phi)),
        )


def _geocentric_from_geodetic(latitude: float, longitude: float, altitude: float) -> Vector3:
    phi, lam = radians(latitude), radians(longitude)
    radius = _EQUATORIAL_RADIUS_M / sqrt(1.0 - _ECCENTRICITY_SQUARED * sin(phi) ** 2)
    axis_distance = (radius + altitude) * cos(phi)
    return (
        axis_distance * cos(lam),
        axis_distance * sin(lam),
        (radius * (1.0 - _ECCENTRICITY_SQUARED) + altitude) * sin(phi),
    )


def _geodetic_from_geocentric(x: float, y: float, z: float) -> Vector3:
    axis_distance = hypot(x, y)
    phi, altitude = atan2(z, axis_distance * (1.0 - _ECCENTRICITY_SQUARED)), 0.0
    for _ in range(_ITERATION_COUNT):
        radius = _EQUATORIAL_RADIUS_M / sqrt(1.0 - _ECCENTRICITY_SQUARED * sin(phi) ** 2)
        altitude = (
            axis_distance * cos(phi)
            + z * sin(phi)
            - _EQUATORIAL_RADIUS_M * sqrt(1.0 - _ECCENTRICITY_SQUARED * sin(phi) ** 2)
        )
        phi = atan2(z, axis_distance * (1.0 - _ECCENTRICITY_SQUARED * radius / (radius + altitude)))
    return degrees(phi), degrees(atan2(y, x)), altitude
