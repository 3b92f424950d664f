# SPDX-License-Identifier: Apache-2.0
"""What the nodes decide, without a robot."""

import math

import numpy as np
import pytest
from my_robot_control.drive_square import square
from my_robot_control.driving_node import limited, wrapped
from my_robot_control.follow_line import line_offset
from my_robot_control.follow_wall import wall_distance


def test_a_square_ends_where_it_began():
    corners = square(1.0, 2.0, 0.3, 0.5)
    assert len(corners) == 4
    assert corners[-1] == pytest.approx((1.0, 2.0))


def test_angles_are_wrapped_and_values_limited():
    assert wrapped(1.5 * math.pi) == pytest.approx(-0.5 * math.pi)
    assert [limited(value, 0.5) for value in (-2.0, 0.1, 2.0)] == [-0.5, 0.1, 0.5]


def test_a_wall_beside_the_robot_stays_as_far_away():
    assert wall_distance(0.5, 0.5 / math.cos(math.radians(45.0)), 0.3) == pytest.approx(0.5)


def test_a_wall_that_comes_closer_will_be_nearer():
    assert wall_distance(0.5, 0.5, 0.3) < 0.5


def test_a_line_is_found_in_the_lower_part_of_the_picture():
    picture = np.full((40, 101), 255.0)
    picture[:20, 10] = 0.0
    assert line_offset(picture, 80, 0.15) is None
    picture[20:, 75] = 0.0
    assert line_offset(picture, 80, 0.15) == pytest.approx(0.5)
