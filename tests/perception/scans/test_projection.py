"""Scans from depth images and point clouds."""

from __future__ import annotations

from math import atan, hypot, inf, nan, pi

import numpy as np
import pytest

from linkwright.perception.scans.projection import Pinhole, Rays, points_from_scan, scan_from_depths, scan_from_points
from tests.perception.scans.test_scan_filters import approx_ranges, make_scan

CAMERA = Pinhole(focal_length=4.0, center_column=2.0, center_row=1.5)


def test_flat_depth_image_becomes_straight_wall():
    distances, rays = scan_from_depths(np.full((3, 5), 2.0), CAMERA, 1, 0.1, 10.0)
    assert (rays.angle_min, rays.angle_max) == (pytest.approx(-atan(0.5)), pytest.approx(atan(0.5)))
    assert rays.angle_increment == pytest.approx(atan(0.5) / 2)
    # The angles between the rays of the scan are equal, but not those between the columns of the image: two columns
    # fall into the first ray.
    assert distances[[0, 2, 4]] == pytest.approx([hypot(2.0, 0.5), 2.0, hypot(2.0, 1.0)])


def test_left_of_image_is_end_of_scan_and_nearest_row_is_used():
    depths = np.full((3, 5), 9.0)
    depths[0, 0], depths[1, 0], depths[1, 4] = 1.0, 2.0, 3.0
    distances, _ = scan_from_depths(depths, CAMERA, 2, 0.1, 20.0)
    assert distances[-1] == pytest.approx(hypot(1.0, 0.5))
    assert distances[0] == pytest.approx(hypot(3.0, 1.5))


def test_invalid_depths_become_nan_or_inf_ranges():
    depths = np.array([[nan, inf, 50.0, 0.2, 2.0]] * 3)
    distances, _ = scan_from_depths(depths, CAMERA, 1, 0.45, 10.0)
    assert np.isnan(distances[-1])
    assert np.isposinf(distances).sum() == 1
    assert np.isfinite(distances).tolist() == [True, False, False, False, False]


def test_scan_height_above_image_height_is_an_error():
    with pytest.raises(ValueError, match="scan_height \\( 4 pixels\\) is too large for the image height"):
        scan_from_depths(np.ones((3, 5)), CAMERA, 4, 0.1, 10.0)


def test_nearest_point_within_heights_is_used_for_each_ray():
    rays = Rays(-pi, pi, pi / 2, 0.5, 10.0)
    points = np.array(
        [
            [2.0, 0.1, 0.0], [1.0, 0.1, 0.0],  # ahead, to the left
            [1.0, -0.1, 5.0], [3.0, -0.1, 0.5],  # ahead, to the right: the first is too high
            [-0.1, 0.01, 0.0], [-20.0, 0.1, 0.0],  # behind: too near, too far
            [nan, 0.0, 0.0],
        ]
    )  # fmt: skip
    distances = scan_from_points(points, rays, 0.0, 1.0, inf)
    assert list(distances) == approx_ranges([inf, hypot(3.0, 0.1), hypot(1.0, 0.1), inf])


def test_point_at_maximum_angle_is_ignored():
    assert list(scan_from_points(np.array([[-1.0, 0.0, 0.0]]), Rays(-pi, pi, pi, 0.0, 9.0), 0.0, 1.0, 7.0)) == [
        7.0,
        7.0,
    ]


def test_scan_to_points_round_trip():
    input_scan = make_scan(1.0, 2.0, nan, 20.0, 3.0, angle_min=-0.2)
    points, places = points_from_scan(input_scan)
    assert places.tolist() == [0, 1, 4]
    assert np.linalg.norm(points, axis=1) == pytest.approx([1.0, 2.0, 3.0])
    rays = Rays(-0.25, 0.25, 0.1, 0.1, 10.0)
    back = scan_from_points(points.astype(float), rays, -1.0, 1.0, nan)
    assert list(back) == approx_ranges([1.0, 2.0, nan, nan, 3.0])
