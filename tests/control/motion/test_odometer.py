"""The integration of velocities, compared with closed formulas."""

from __future__ import annotations

from math import cos, sin

import pytest

from linkwright.control.motion.odometer import Odometer


def test_arc_is_exact_for_any_number_of_steps():
    odometer = Odometer(10)
    for _ in range(1000):
        odometer.measure((0.5, 0.0, 0.4), 0.01)
    assert (odometer.pose.x, odometer.pose.y, odometer.pose.yaw) == pytest.approx(
        (1.25 * sin(4.0), 1.25 * (1.0 - cos(4.0)), 4.0), abs=1e-9
    )
    assert odometer.velocity == pytest.approx((0.5, 0.0, 0.4))


def test_velocity_is_mean_of_last_measurements():
    odometer = Odometer(4)
    messages = []
    for speed in (1.0, 1.0, 3.0, 3.0, 3.0):
        odometer.measure((speed, -speed, 0.0), 0.1)
        messages.append(odometer.velocity[0])
    assert messages == pytest.approx([1.0, 1.0, 5 / 3, 2.0, 2.5])
    assert odometer.velocity[1] == pytest.approx(-2.5)


def test_commanded_velocity_is_not_smoothed():
    odometer = Odometer(4)
    odometer.integrate_command((1.0, 0.0, 0.0), 0.5)
    odometer.integrate_command((0.0, 0.0, 0.0), 0.5)
    assert (odometer.pose.x, odometer.velocity) == (0.5, (0.0, 0.0, 0.0))


def test_reset_sets_pose():
    odometer = Odometer()
    odometer.measure((1.0, 0.0, 0.0), 1.0)
    odometer.reset(2.0, 3.0, 0.0)
    assert odometer.velocity == (0.0, 0.0, 0.0)
    odometer.measure((1.0, 0.0, 0.0), 1.0)
    assert (odometer.pose.x, odometer.pose.y) == (3.0, 3.0)
