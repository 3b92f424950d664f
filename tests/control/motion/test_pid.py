"""PID control and tolerances."""

from __future__ import annotations

from math import inf, nan

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.control.motion.pid import BACK_CALCULATION, CLAMPED, CONDITIONAL, STRATEGIES, Pid, PidGains
from linkwright.control.motion.tolerances import StateTolerance, Tolerances, resolve_tolerance


def test_command_is_sum_of_p_i_and_d_terms():
    pid = Pid(PidGains(p=2.0, i=4.0, d=0.5))
    assert pid.command(1.0, 0.1) == pytest.approx(2.0 + 4.0 * 0.1 + 0.5 * 10.0)
    assert pid.command(0.5, 0.1) == pytest.approx(1.0 + 4.0 * 0.15 - 0.5 * 5.0)
    assert pid.command(0.5, 0.1, 3.0) == pytest.approx(1.0 + 4.0 * 0.2 + 1.5)


def test_integral_term_is_bounded_with_and_without_clamping():
    unclamped, clamped = (
        Pid(PidGains(i=1.0, i_min=-1.0, i_max=1.0, antiwindup=antiwindup)) for antiwindup in ("none", CLAMPED)
    )
    for pid in (unclamped, clamped):
        assert [pid.command(1.0, 1.0) for _ in range(5)] == [1.0] * 5
    assert [unclamped.command(-1.0, 1.0) for _ in range(5)] == [1.0, 1.0, 1.0, 1.0, 0.0]
    assert [clamped.command(-1.0, 1.0) for _ in range(3)] == [0.0, -1.0, -1.0]


@pytest.mark.parametrize("strategy", [CONDITIONAL, BACK_CALCULATION])
def test_antiwindup_bounds_integral(strategy: str):
    pid = Pid(PidGains(p=1.0, i=1.0, u_min=-2.0, u_max=2.0, antiwindup=strategy, tracking_time_constant=1.0))
    for _ in range(1000):
        assert pid.command(1.5, 0.1) <= 2.0
    assert pid.integral < 3.0
    commands = [pid.command(-1.5, 0.1) for _ in range(3)]
    assert max(commands) < 2.0


@given(st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=30), st.sampled_from(STRATEGIES))
def test_command_stays_within_bounds(errors: list[float], strategy: str):
    pid = Pid(PidGains(p=3.0, i=2.0, d=0.1, u_min=-5.0, u_max=5.0, antiwindup=strategy))
    assert all(-5.0 <= pid.command(error, 0.01) <= 5.0 for error in errors)


@pytest.mark.parametrize("error", [nan, inf])
def test_error_that_is_not_a_number_gives_zero_command(error: float):
    pid = Pid(PidGains(p=1.0, i=1.0))
    pid.command(1.0, 1.0)
    assert pid.command(error, 1.0) == pid.command(1.0, 1.0, error) == pid.command(1.0, 0.0) == 0.0
    assert pid.integral == 1.0


def test_reset_clears_previous_errors():
    pid = Pid(PidGains(i=1.0, d=1.0))
    pid.command(5.0, 1.0)
    pid.reset()
    assert pid.command(1.0, 1.0) == 2.0


def test_tracking_time_is_derived_from_gains():
    assert PidGains(p=6.0, i=2.0).tracking_time == 3.0
    assert PidGains(p=6.0, i=2.0, d=8.0).tracking_time == 2.0
    assert PidGains(p=6.0, i=2.0, tracking_time_constant=0.5).tracking_time == 0.5
    assert PidGains(p=6.0).tracking_time == 0.0


def test_tolerances_bound_errors_unless_zero():
    tolerance = StateTolerance(0.1, 0.0, 1.0)
    assert tolerance.is_within(-0.1, 99.0, 1.0)
    assert not tolerance.is_within(0.11, 0.0, 0.0)
    assert list(tolerance.find_violations(-0.2, 9.0, 2.0)) == [("Position", -0.2, 0.1), ("Acceleration", 2.0, 1.0)]


def test_goal_tolerances_replace_erase_or_keep_defaults():
    assert [resolve_tolerance(0.5, value) for value in (0.2, 0.0, -1.0)] == [0.2, 0.5, 0.0]
    with pytest.raises(ValueError, match="-2"):
        resolve_tolerance(0.5, -2.0)
    assert StateTolerance(0.1, 0.2, 0.3).override(0.0, -1.0, 1.0) == StateTolerance(0.1, 0.0, 1.0)
    tolerances = Tolerances((StateTolerance(), StateTolerance()), (StateTolerance(), StateTolerance()))
    assert tolerances.with_path(1, StateTolerance(1.0)).path == (StateTolerance(), StateTolerance(1.0))
    assert tolerances.with_goal(0, StateTolerance(2.0)).goal == (StateTolerance(2.0), StateTolerance())
