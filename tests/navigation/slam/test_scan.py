"""Laser scans as points around the robot."""

from __future__ import annotations

from math import inf, nan, pi

import numpy as np
import pytest

from linkwright.navigation.slam.scan import planar_scan

IDENTITY_MOUNTING = (np.eye(3), np.zeros(3))


def test_invalid_ranges_give_no_points():
    ranges = np.array([nan, inf, -inf, 0.0, 0.05, 40.0, 30.0, -1.0], dtype=np.float32)
    scan = planar_scan(ranges, np.zeros(8), (0.1, 30.0), (0.0, 20.0), IDENTITY_MOUNTING, 7)
    assert len(scan.points) == len(scan.free_ends) == 0
    assert scan.stamp_ns == 7


def test_range_above_maximum_gives_free_ray():
    scan = planar_scan(np.array([5.0, 25.0]), np.array([0.0, pi / 2]), (0.1, 30.0), (0.0, 20.0), IDENTITY_MOUNTING, 0)
    assert scan.points == pytest.approx(np.array([[5.0, 0.0]]))
    assert scan.free_ends == pytest.approx(np.array([[0.0, 20.0]]), abs=1e-9)


def test_range_below_minimum_is_ignored():
    scan = planar_scan(np.array([0.3, 0.6]), np.zeros(2), (0.1, 30.0), (0.5, 20.0), IDENTITY_MOUNTING, 0)
    assert scan.points == pytest.approx(np.array([[0.6, 0.0]]))


def test_laser_may_be_mounted_backward_or_upside_down():
    ranges, angles = np.array([2.0]), np.array([0.5])
    backward = (np.diag([-1.0, -1.0, 1.0]), np.array([-0.2, 0.0, 0.3]))
    scan = planar_scan(ranges, angles, (0.1, 30.0), (0.0, 20.0), backward, 0)
    assert scan.points[0] == pytest.approx([-0.2 - 2 * np.cos(0.5), -2 * np.sin(0.5)])
    assert scan.origin == pytest.approx([-0.2, 0.0])
    upside_down = (np.diag([1.0, -1.0, -1.0]), np.zeros(3))
    scan = planar_scan(ranges, angles, (0.1, 30.0), (0.0, 20.0), upside_down, 0)
    assert scan.points[0] == pytest.approx([2 * np.cos(0.5), -2 * np.sin(0.5)])
