"""Limited velocities: no limit is exceeded, and possible velocities are reached."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as some

from linkwright.kinematics.limits import SpeedLimiter

STEP_S = 0.01
TARGETS = some.lists(some.floats(-5.0, 5.0), min_size=1, max_size=60)


def limit_speeds(limiter: SpeedLimiter, targets: list[float]) -> list[float]:
    return [limiter.approach(speed, STEP_S) for speed in targets]


@given(TARGETS)
def test_speed_and_acceleration_stay_within_limits(commands):
    speeds = [0.0, *limit_speeds(SpeedLimiter((-1.0, 2.0), (-4.0, 3.0)), commands)]
    assert all(-1.0 <= speed <= 2.0 for speed in speeds)
    changes = [(after - before) / STEP_S for before, after in pairwise(speeds)]
    assert all(-4.0 - 1e-9 <= change <= 3.0 + 1e-9 for change in changes)


@given(TARGETS)
def test_jerk_stays_within_limits(commands):
    speeds = [0.0, 0.0, *limit_speeds(SpeedLimiter(jerk=(-50.0, 40.0)), commands)]
    changes = [(after - before) / STEP_S for before, after in pairwise(speeds)]
    jerks = [(after - before) / STEP_S for before, after in pairwise(changes)]
    assert all(-50.0 - 1e-6 <= jerk <= 40.0 + 1e-6 for jerk in jerks)


def test_reverse_motion_has_its_own_acceleration_limits():
    limiter = SpeedLimiter(acceleration=(-4.0, 2.0), reverse_acceleration=(-8.0, 10.0))
    assert limiter.approach(1.0, 0.1) == pytest.approx(0.2)
    assert limiter.approach(1.0, 0.1) == pytest.approx(0.4)
    assert limiter.approach(-1.0, 0.1) == pytest.approx(0.0)
    assert limiter.approach(-9.0, 0.1) == pytest.approx(-0.8)
    assert limiter.approach(-9.0, 0.1) == pytest.approx(-1.6)
    assert limiter.approach(9.0, 0.1) == pytest.approx(-0.6)


def test_braking_can_ignore_jerk_limit():
    bound = SpeedLimiter(jerk=(-1.0, 1.0))
    free = SpeedLimiter(jerk=(-1.0, 1.0), brakes_freely=True)
    for limiter in (bound, free):
        for _ in range(100):
            limiter.approach(9.0, STEP_S)
    assert free.speed == bound.speed
    speed = free.speed
    assert free.approach(speed, STEP_S) == speed
    assert bound.approach(speed, STEP_S) > speed


def test_velocity_is_reached_at_once_without_limits():
    limiter = SpeedLimiter()
    assert limit_speeds(limiter, [3.0, -7.0]) == [3.0, -7.0]
    limiter.restart()
    assert limiter.speed == 0.0
