"""Zones around a robot, and the velocities that they allow."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.navigation.behaviors.zones import (
    Circle,
    Polygon,
    SpeedRange,
    Verdict,
    ZoneAction,
    ZoneRule,
    limit_by_zones,
)
from linkwright.navigation.following.follower import Velocity

ZONE_AHEAD = Polygon(np.array([[0.0, -0.3], [0.6, -0.3], [0.6, 0.3], [0.0, 0.3]]))
BODY_CIRCLE = Circle(0.2)
FORWARD_VELOCITY = Velocity(0.4, 0.0, 0.2)


def repeat_point(count, x, y=0.0):
    return np.tile([[x, y]], (count, 1))


def test_zone_with_too_few_points_sets_no_limit():
    rule = ZoneRule(ZoneAction.STOP, min_points=4)
    assert rule.limit_velocity(ZONE_AHEAD, repeat_point(3, 0.5), FORWARD_VELOCITY) is None
    assert rule.limit_velocity(ZONE_AHEAD, repeat_point(9, 0.7), FORWARD_VELOCITY) is None
    assert rule.limit_velocity(ZONE_AHEAD, repeat_point(4, 0.5), FORWARD_VELOCITY) == Velocity(0.0, 0.0, 0.0)


def test_slowdown_zone_applies_ratio():
    allowed = ZoneRule(ZoneAction.SLOWDOWN, 1, slowdown_ratio=0.25).limit_velocity(
        ZONE_AHEAD, repeat_point(1, 0.5), FORWARD_VELOCITY
    )
    assert allowed == pytest.approx((0.1, 0.0, 0.05))


@pytest.mark.parametrize(
    ("velocity", "remaining_share"),
    [
        (Velocity(0.4, 0.0, 0.2), (0.2, 0.0, 0.1)),
        (Velocity(0.3, 0.4, 0.0), (0.12, 0.16, 0.0)),
        (Velocity(0.1, 0.0, -2.0), (0.025, 0.0, -0.5)),
        (Velocity(0.1, 0.0, 0.1), (0.1, 0.0, 0.1)),
    ],
)
def test_limit_zone_keeps_curvature(velocity, remaining_share):
    rule = ZoneRule(ZoneAction.LIMIT, 1, linear_limit=0.2, angular_limit=0.5)
    assert rule.limit_velocity(ZONE_AHEAD, repeat_point(1, 0.5), velocity) == pytest.approx(remaining_share)


def test_approach_zone_keeps_time_before_collision():
    rule = ZoneRule(ZoneAction.APPROACH, 1, time_before_collision=2.0, simulation_time_step=0.1)
    forward = Velocity(0.5, 0.0, 0.0)
    # The point is 0.7 m ahead. The edge of the body, at 0.2 m, reaches it after 0.5 m or 1 s, which is less than 2 s.
    allowed = rule.limit_velocity(BODY_CIRCLE, repeat_point(1, 0.699), forward)
    assert allowed is not None
    assert allowed.x == pytest.approx(0.25, abs=0.03)
    assert rule.limit_velocity(BODY_CIRCLE, repeat_point(1, 1.5), forward) is None
    assert rule.limit_velocity(BODY_CIRCLE, repeat_point(1, -0.7), forward) is None
    assert rule.limit_velocity(BODY_CIRCLE, repeat_point(1, 0.1), forward) == pytest.approx((0.0, 0.0, 0.0))
    assert rule.limit_velocity(BODY_CIRCLE, np.zeros((0, 2)), forward) is None


def test_approach_zone_considers_area_swept_by_rotation():
    long = Polygon(np.array([[-0.1, -0.1], [0.5, -0.1], [0.5, 0.1], [-0.1, 0.1]]))
    rule = ZoneRule(ZoneAction.APPROACH, 1, time_before_collision=2.0, simulation_time_step=0.05)
    assert rule.limit_velocity(long, repeat_point(1, 0.0, 0.4), Velocity(0.0, 0.0, 1.0)) is not None
    assert rule.limit_velocity(long, repeat_point(1, 0.0, 0.4), Velocity(0.0, 0.0, -1.0)) is None


def test_most_restrictive_zone_applies():
    slow, slower = (
        ZoneRule(ZoneAction.SLOWDOWN, 1, slowdown_ratio=0.5),
        ZoneRule(ZoneAction.SLOWDOWN, 1, slowdown_ratio=0.1),
    )
    observed = repeat_point(1, 0.5)
    zones = [
        ("slow", slow, ZONE_AHEAD, observed),
        ("slower", slower, ZONE_AHEAD, observed),
        ("again", slow, ZONE_AHEAD, observed),
    ]
    assert limit_by_zones(FORWARD_VELOCITY, zones).zone == "slower"
    stop = ("stop", ZoneRule(ZoneAction.STOP, 1), ZONE_AHEAD, observed)
    assert limit_by_zones(FORWARD_VELOCITY, [stop, *zones]) == Verdict(Velocity(0.0, 0.0, 0.0), ZoneAction.STOP, "stop")
    assert limit_by_zones(
        FORWARD_VELOCITY, [("off", ZoneRule(ZoneAction.NOTHING, 1), ZONE_AHEAD, observed)]
    ) == Verdict(FORWARD_VELOCITY)


def test_stop_zone_is_reported_for_standing_robot():
    standing = Velocity(0.0, 0.0, 0.0)
    verdict = limit_by_zones(standing, [("stop", ZoneRule(ZoneAction.STOP, 1), ZONE_AHEAD, repeat_point(1, 0.5))])
    assert verdict == Verdict(standing, ZoneAction.STOP, "stop")


@pytest.mark.parametrize(
    ("velocity", "direction", "is_covered"),
    [
        (Velocity(0.2, 0.0, 0.0), None, True),
        (Velocity(-0.2, 0.0, 0.0), None, False),
        (Velocity(0.2, 0.0, 2.0), None, False),
        (Velocity(0.0, 0.2, 0.0), (pi / 4, 3 * pi / 4), True),
        (Velocity(0.2, 0.0, 0.0), (pi / 4, 3 * pi / 4), False),
        (Velocity(-0.2, 0.01, 0.0), (3 * pi / 4, -3 * pi / 4), True),
        (Velocity(0.2, 0.0, 0.0), (3 * pi / 4, -3 * pi / 4), False),
    ],
)
def test_speed_range_covers_velocities_and_directions(velocity, direction, is_covered):
    assert SpeedRange(ZONE_AHEAD, (0.0, 0.5), (-1.0, 1.0), direction).covers(velocity) is is_covered
