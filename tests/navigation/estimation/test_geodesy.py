"""The UTM projection of latitudes and longitudes."""

from __future__ import annotations

from math import cos, degrees, hypot, radians, sqrt

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.navigation.estimation.geodesy import (
    TangentPlane,
    UtmZone,
    convergence,
    degrees_from_utm,
    utm_from_degrees,
    zone_from_degrees,
)

latitudes, longitudes = st.floats(-80.0, 84.0), st.floats(-180.0, 179.999)


def meridian_arc(latitude):
    """Return the length of a meridian arc from the equator, by Simpson's rule.

    This is independent of the projection.
    """
    squared_eccentricity = (2.0 - 1.0 / 298.257223563) / 298.257223563

    def radius(phi):
        from math import sin

        return 6378137.0 * (1.0 - squared_eccentricity) / (1.0 - squared_eccentricity * sin(phi) ** 2) ** 1.5

    steps, end = 2000, radians(latitude)
    step = end / steps
    weighted_sum = sum((4 if index % 2 else 2) * radius(index * step) for index in range(1, steps))
    return step / 3.0 * (radius(0.0) + weighted_sum + radius(end))


@pytest.mark.parametrize("latitude", [10.0, 45.0, 79.0])
def test_northing_on_central_meridian_is_scaled_meridian_arc(latitude):
    easting, northing = utm_from_degrees(latitude, 9.0, UtmZone(32, True))
    assert easting == pytest.approx(500000.0, abs=1e-6)
    assert northing == pytest.approx(0.9996 * meridian_arc(latitude), abs=1e-5)


def test_southern_northing_has_false_northing():
    _, north = utm_from_degrees(30.0, 10.0, UtmZone(32, True))
    _, south = utm_from_degrees(-30.0, 10.0, UtmZone(32, False))
    assert south == pytest.approx(10000000.0 - north)


@settings(max_examples=100)
@given(latitudes, longitudes)
def test_utm_conversion_round_trip(latitude, longitude):
    zone = zone_from_degrees(latitude, longitude)
    round_trip = degrees_from_utm(*utm_from_degrees(latitude, longitude, zone), zone)
    assert round_trip[0] == pytest.approx(latitude, abs=1e-9)
    assert (round_trip[1] - longitude + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=1e-8)


@settings(max_examples=50)
@given(st.floats(-75.0, 75.0), st.floats(-2.9, 2.9))
def test_utm_projection_is_conformal_with_grid_convergence(latitude, offset):
    zone, step = UtmZone(31, True), 1e-5
    longitude = 3.0 + offset
    (x, y), (xn, yn) = utm_from_degrees(latitude, longitude, zone), utm_from_degrees(latitude + step, longitude, zone)
    xe, ye = utm_from_degrees(latitude, longitude + step, zone)
    north, east = (xn - x, yn - y), (xe - x, ye - y)
    assert north[0] * east[0] + north[1] * east[1] == pytest.approx(0.0, abs=1e-5 * hypot(*north) * hypot(*east) + 1e-6)
    angle = convergence(latitude, longitude, zone)
    assert degrees(angle) == pytest.approx(degrees(-north[0] / hypot(*north)), abs=0.02)


@pytest.mark.parametrize(
    ("latitude", "longitude", "number"),
    [(0.0, -180.0, 1), (0.0, 179.9, 60), (48.0, 9.0, 32), (60.0, 5.0, 32), (78.0, 10.0, 33), (78.0, 8.0, 31)],
)
def test_utm_zone_of_degrees(latitude, longitude, number):
    assert zone_from_degrees(latitude, longitude) == UtmZone(number, True)


@settings(max_examples=50)
@given(
    st.floats(-85.0, 85.0), longitudes, st.floats(-3000.0, 3000.0), st.floats(-3000.0, 3000.0), st.floats(-50.0, 50.0)
)
def test_tangent_plane_round_trip(latitude, longitude, x, y, z):
    plane = TangentPlane(latitude, longitude, 100.0)
    assert plane.point_from_geodetic(*plane.geodetic_from_point((x, y, z))) == pytest.approx((x, y, z), abs=1e-5)
    assert plane.point_from_geodetic(latitude, longitude, 107.0) == pytest.approx((0.0, 0.0, 7.0), abs=1e-6)


def test_tangent_plane_accounts_for_earth_curvature():
    plane = TangentPlane(0.0, 0.0, 0.0)
    point = plane.point_from_geodetic(0.0, 0.1, 0.0)
    east = 6378137.0 * radians(0.1)
    assert point[0] == pytest.approx(east, rel=1e-5)
    assert point[2] == pytest.approx(-(6378137.0 - 6378137.0 * cos(radians(0.1))), rel=1e-6)
    assert sqrt(point[1] ** 2) < 1e-9
