"""The motion model of the estimator, and its derivatives."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.navigation.estimation.motion_model import (
    STATE_SIZE,
    State,
    predict_state,
    rotation,
    state_jacobian,
    wrap_angle,
)

numbers = st.floats(-2.0, 2.0)
# Near a pitch of 90 degrees, the rates of roll and yaw are unbounded.
states = st.tuples(*([numbers] * 3), numbers, st.floats(-1.0, 1.0), numbers, *([numbers] * 9)).map(np.array)


def moving_state(**values):
    state = np.zeros(STATE_SIZE)
    for name, value in values.items():
        state[State[name.upper()]] = value
    return state


def test_constant_velocity_moves_along_line():
    predicted = predict_state(moving_state(x=1.0, yaw=pi / 2, vx=2.0, vy=1.0), 0.5)
    assert predicted[:3] == pytest.approx([0.5, 1.0, 0.0])


def test_constant_acceleration_changes_position_and_velocity():
    predicted = predict_state(moving_state(vx=1.0, ax=2.0), 3.0)
    assert predicted[State.X] == pytest.approx(1.0 * 3.0 + 0.5 * 2.0 * 9.0)
    assert predicted[State.VX] == pytest.approx(7.0)


def test_constant_turn_converges_to_circle_with_small_steps():
    def end(steps):
        state = moving_state(vx=1.0, vyaw=0.5)
        for _ in range(steps):
            state = predict_state(state, 2.0 / steps)
        return state

    radius = 1.0 / 0.5
    exact = (radius * sin(1.0), radius * (1.0 - cos(1.0)), 1.0)
    errors = [np.abs(end(steps)[[State.X, State.Y, State.YAW]] - exact).max() for steps in (10, 100, 1000)]
    assert errors[0] > 5.0 * errors[1] > 25.0 * errors[2]
    assert errors[2] < 1e-3


def test_angles_are_wrapped_to_pi():
    assert predict_state(moving_state(yaw=3.0, vyaw=1.0), 1.0)[State.YAW] == pytest.approx(4.0 - 2.0 * pi)
    assert wrap_angle(-pi - 0.1) == pytest.approx(pi - 0.1)


def test_yaw_rate_of_rolled_body_changes_pitch():
    predicted = predict_state(moving_state(roll=pi / 2, vyaw=1.0), 0.1)
    assert predicted[State.PITCH] == pytest.approx(-0.1)
    assert predicted[State.YAW] == pytest.approx(0.0)


@settings(max_examples=40)
@given(states)
def test_rotation_matches_fixed_axis_rotations(state):
    roll, pitch, yaw = state[3:6]
    about_x = np.array([[1, 0, 0], [0, cos(roll), -sin(roll)], [0, sin(roll), cos(roll)]])
    about_y = np.array([[cos(pitch), 0, sin(pitch)], [0, 1, 0], [-sin(pitch), 0, cos(pitch)]])
    about_z = np.array([[cos(yaw), -sin(yaw), 0], [sin(yaw), cos(yaw), 0], [0, 0, 1]])
    np.testing.assert_allclose(rotation(roll, pitch, yaw), about_z @ about_y @ about_x, atol=1e-12)


@settings(max_examples=40)
@given(states, st.floats(0.001, 0.2))
def test_jacobian_matches_finite_differences(state, seconds):
    step = 1e-6
    columns = []
    for index in range(STATE_SIZE):
        higher, lower = state.copy(), state.copy()
        higher[index] += step
        lower[index] -= step
        difference = predict_state(higher, seconds) - predict_state(lower, seconds)
        difference[3:6] = [wrap_angle(float(angle)) for angle in difference[3:6]]
        columns.append(difference / (2.0 * step))
    np.testing.assert_allclose(state_jacobian(state, seconds), np.array(columns).T, atol=1e-7)
