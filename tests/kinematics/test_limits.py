"""Limited velocities: no limit is exceeded, and possible velocities are reached."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as some

from linkwright.kinematics.limits import SpeedLimiter

STEP = 0.01
WANTED = some.lists(some.floats(-5.0, 5.0), min_size=1, max_size=60)


def followed(limiter: SpeedLimiter, wanted: list[float]) -> list[float]:
    return [limiter.approach(each, STEP) for each in wanted]


@given(WANTED)
def test_no_bound_is_passed(wanted):
    speeds = [0.0, *followed(SpeedLimiter((-1.0, 2.0), (-4.0, 3.0)), wanted)]
    assert all(-1.0 <= speed <= 2.0 for speed in speeds)
    changes = [(after - before) / STEP for before, after in pairwise(speeds)]
    assert all(-4.0 - 1e-9 <= change <= 3.0 + 1e-9 for change in changes)


@given(WANTED)
def test_the_jerk_is_bounded(wanted):
    speeds = [0.0, 0.0, *followed(SpeedLimiter(jerk=(-50.0, 40.0)), wanted)]
    changes = [(after - before) / STEP for before, after in pairwise(speeds)]
    jerks = [(after - before) / STEP for before, after in pairwise(changes)]
    assert all(-50.0 - 1e-6 <= jerk <= 40.0 + 1e-6 for jerk in jerks)


def test_each_direction_has_its_own_bounds_for_speeding_up_and_braking():
    limiter = SpeedLimiter(acceleration=(-4.0, 2.0), reverse_acceleration=(-8.0, 10.0))
    assert limiter.approach(1.0, 0.1) == pytest.approx(0.2)
    assert limiter.approach(1.0, 0.1) == pytest.approx(0.4)
    assert limiter.approach(-1.0, 0.1) == pytest.approx(0.0)
    assert limiter.approach(-9.0, 0.1) == pytest.approx(-0.8)
    assert limiter.approach(-9.0, 0.1) == pytest.approx(-1.6)
    assert limiter.approach(9.0, 0.1) == pytest.approx(-0.6)


def test_braking_may_be_free_of_the_bound_of_the_jerk():
    bound = SpeedLimiter(jerk=(-1.0, 1.0))
    free = SpeedLimiter(jerk=(-1.0, 1.0), brakes_freely=True)
    for limiter in (bound, free):
        for _ in range(100):
            limiter.approach(9.0, STEP)
    assert free.speed == bound.speed
    speed = free.speed
    assert free.approach(speed, STEP) == speed
    assert bound.approach(speed, STEP) > speed


def test_without_bounds_every_velocity_is_reached_at_once():
    limiter = SpeedLimiter()
    assert followed(limiter, [3.0, -7.0]) == [3.0, -7.0]
    limiter.restart()
    assert limiter.speed == 0.0
