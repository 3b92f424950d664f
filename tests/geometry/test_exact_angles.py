"""Sines and cosines without the system's library."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.geometry.exact_angles import exact_quaternion, regular_polygon, sine_and_cosine
from linkwright.geometry.single import quaternion_from_rpy


def test_sine_and_cosine_match_math_to_12_digits() -> None:
    for angle in np.linspace(-40.0, 40.0, 4001).tolist():
        assert sine_and_cosine(angle) == pytest.approx((math.sin(angle), math.cos(angle)), abs=1e-12)


@pytest.mark.parametrize("quarters", range(-9, 10))
def test_quarter_turns_are_exact(quarters: int) -> None:
    sine, cosine = sine_and_cosine(quarters * math.pi / 2)
    assert (sine, cosine) == ((0, 1, 0, -1)[quarters % 4], (1, 0, -1, 0)[quarters % 4])


def test_exact_quaternion_matches_urdfdom_to_12_digits() -> None:
    for rpy in np.random.default_rng(1).uniform(-7, 7, (200, 3)).tolist():
        assert exact_quaternion(tuple(rpy)) == pytest.approx(quaternion_from_rpy(tuple(rpy)), abs=4e-12)


def test_circle_is_closed_and_symmetrical() -> None:
    points = regular_polygon(12)
    assert points[0] == points[-1] == (1.0, 0.0)
    assert points[3] == (0.0, 1.0)
    assert points[2][0] == points[1][1]
