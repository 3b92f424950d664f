"""The Kalman filters, compared with batch least squares."""

from __future__ import annotations

from math import inf, nan, pi, sqrt

import numpy as np
import pytest

from linkwright.navigation.estimation.kalman import (
    Control,
    ExtendedKalmanFilter,
    Measurement,
    Settings,
    UnscentedKalmanFilter,
)
from linkwright.navigation.estimation.motion_model import STATE_SIZE, State, state_jacobian, wrap_angle

SECOND_NS = 1_000_000_000
FILTERS = pytest.mark.parametrize("filter_type", [ExtendedKalmanFilter, UnscentedKalmanFilter])


def make_measurement(time_s, variance=0.01, threshold=inf, **values):
    vector, covariance, measured = np.zeros(STATE_SIZE), np.zeros((STATE_SIZE, STATE_SIZE)), [False] * STATE_SIZE
    for name, value in values.items():
        index = State[name.upper()]
        vector[index], covariance[index, index], measured[index] = value, variance, True
    return Measurement("sensor", round(time_s * SECOND_NS), vector, covariance, tuple(measured), threshold)


def diagonal_matrix(**values):
    matrix = np.zeros((STATE_SIZE, STATE_SIZE))
    for name, value in values.items():
        matrix[State[name.upper()], State[name.upper()]] = value
    return matrix


@FILTERS
def test_first_measurement_initializes_state(filter_type):
    kalman = filter_type()
    assert kalman.process(make_measurement(5.0, 0.3, x=2.0, yaw=1.0))
    assert kalman.is_initialized
    assert kalman.time_ns == 5 * SECOND_NS
    assert (kalman.state[State.X], kalman.state[State.YAW], kalman.state[State.Y]) == (2.0, 1.0, 0.0)
    assert kalman.covariance[State.X, State.X] == 0.3
    assert kalman.covariance[State.Y, State.Y] == 1e-9


@FILTERS
def test_correction_is_weighted_mean(filter_type):
    kalman = filter_type(Settings(initial_covariance=diagonal_matrix(x=0.3)))
    kalman.is_initialized = True
    kalman.state[State.X] = 1.0
    kalman.correct(make_measurement(0.0, 0.1, x=2.0))
    weight = 0.3 / (0.3 + 0.1)
    assert kalman.state[State.X] == pytest.approx(1.0 + weight)
    assert kalman.covariance[State.X, State.X] == pytest.approx((1 - weight) * 0.3)


def solve_batch(settings, measurements, steps):
    """Return the most likely last state by least squares over all times, with its covariance.

    It is independent of filters. The motion is assumed to be linear, so nothing may turn.
    """
    count = len(measurements)
    free = np.flatnonzero(np.diag(settings.initial_covariance))
    size = len(free)
    motions = [state_jacobian(np.zeros(STATE_SIZE), step)[np.ix_(free, free)] for step in steps]
    rows, targets = [], []

    def add(block_by_time, target, covariance):
        weight = np.linalg.inv(np.linalg.cholesky(covariance))
        row = np.zeros((len(target), size * count))
        for time, block in block_by_time.items():
            row[:, time * size : (time + 1) * size] = block
        rows.append(weight @ row)
        targets.append(weight @ target)

    add({0: np.eye(size)}, settings.initial_state[free], settings.initial_covariance[np.ix_(free, free)])
    for time, (step, motion) in enumerate(zip(steps, motions, strict=True)):
        noise = settings.noise[np.ix_(free, free)] * step
        add({time: -motion, time + 1: np.eye(size)}, np.zeros(size), noise)
    for time, measurement in enumerate(measurements):
        indices = [index for index, is_used in enumerate(measurement.used) if is_used]
        observation_matrix = np.zeros((len(indices), size))
        for row, index in enumerate(indices):
            observation_matrix[row, list(free).index(index)] = 1.0
        add({time: observation_matrix}, measurement.values[indices], measurement.covariance[np.ix_(indices, indices)])
    matrix, target = np.vstack(rows), np.concatenate(targets)
    information = matrix.T @ matrix
    solution = np.linalg.solve(information, matrix.T @ target)
    return free, solution[-size:], np.linalg.inv(information)[-size:, -size:]


@FILTERS
def test_filter_matches_batch_least_squares(filter_type):
    noise = diagonal_matrix(x=0.02, vx=0.1, ax=0.3, y=0.03, vy=0.2, ay=0.1)
    start = diagonal_matrix(x=1.0, vx=2.0, ax=1.0, y=1.0, vy=1.0, ay=0.5)
    # Sigma points near the state lose digits by rounding. Far points are as exact, because the motion is linear here.
    settings = Settings(noise=noise, initial_covariance=start)
    kalman = filter_type(settings) if filter_type is ExtendedKalmanFilter else filter_type(settings, alpha=1.0)
    kalman.is_initialized = True
    random = np.random.default_rng(7)
    steps = list(random.uniform(0.05, 0.5, 29))
    times = np.concatenate([[0.0], np.cumsum(steps)])
    measurements = []
    for index, time in enumerate(times):
        if index % 3 == 0:
            measurements.append(make_measurement(time, 0.05, x=time + random.normal(0, 0.2), y=random.normal(0, 0.2)))
        elif index % 3 == 1:
            measurements.append(make_measurement(time, 0.02, vx=1.0 + random.normal(0, 0.1)))
        else:
            measurements.append(make_measurement(time, 0.3, ax=random.normal(0, 0.5), vy=random.normal(0, 0.5)))
    steps = list(np.diff([measurement.time_ns for measurement in measurements]) / SECOND_NS)
    for measurement in measurements:
        kalman.process(measurement)
    free, state, covariance = solve_batch(settings, measurements, steps)
    np.testing.assert_allclose(kalman.state[free], state, atol=1e-7)
    np.testing.assert_allclose(kalman.covariance[np.ix_(free, free)], covariance, atol=1e-7)


@FILTERS
def test_velocity_is_estimated_from_positions(filter_type):
    kalman = filter_type(Settings(initial_covariance=np.eye(STATE_SIZE)))
    for step in range(200):
        kalman.process(
            make_measurement(0.1 * step, 1e-4, x=0.5 * 0.1 * step, y=0.0, z=0.0, roll=0.0, pitch=0.0, yaw=0.0)
        )
    assert kalman.state[State.VX] == pytest.approx(0.5, abs=1e-3)
    assert kalman.state[State.X] == pytest.approx(0.5 * 19.9, abs=1e-3)


@FILTERS
def test_constant_turn_is_tracked(filter_type):
    # An uncertain heading shortens the mean displacement, so the heading is certain here.
    kalman = filter_type(Settings(noise=np.eye(STATE_SIZE) * 1e-6))
    for step in range(1, 301):
        kalman.process(make_measurement(0.01 * step, 1e-6, vx=1.0, vy=0.0, vz=0.0, vroll=0.0, vpitch=0.0, vyaw=0.5))
    yaw = 0.5 * 2.99
    assert wrap_angle(kalman.state[State.YAW] - yaw) == pytest.approx(0.0, abs=1e-3)
    assert kalman.state[State.X] == pytest.approx(2.0 * np.sin(yaw), abs=2e-2)
    assert kalman.state[State.Y] == pytest.approx(2.0 * (1.0 - np.cos(yaw)), abs=2e-2)


@FILTERS
def test_compass_bounds_drift_of_biased_gyroscope(filter_type):
    bias = 0.05
    kalman = filter_type()
    for step in range(200):
        kalman.process(make_measurement(0.1 * step, 0.1, vyaw=bias))
        kalman.correct(make_measurement(0.1 * step, 1e-3, yaw=0.0))
    free = filter_type()
    for step in range(200):
        free.process(make_measurement(0.1 * step, 0.1, roll=0.0, pitch=0.0, vroll=0.0, vpitch=0.0, vyaw=bias))
    assert free.state[State.YAW] == pytest.approx(bias * 19.9, rel=0.1)
    assert abs(kalman.state[State.YAW]) < 0.02


@FILTERS
def test_yaw_correction_wraps_around_pi(filter_type):
    kalman = filter_type(Settings(initial_covariance=diagonal_matrix(yaw=0.1)))
    kalman.is_initialized = True
    kalman.state[State.YAW] = pi - 0.1
    kalman.correct(make_measurement(0.0, 0.1, yaw=-pi + 0.1))
    assert abs(kalman.state[State.YAW]) == pytest.approx(pi)


def test_outliers_are_rejected():
    kalman = ExtendedKalmanFilter(Settings(initial_covariance=diagonal_matrix(x=0.03)))
    kalman.is_initialized = True
    deviation = sqrt(0.03 + 0.01)
    assert not kalman.correct(make_measurement(0.0, 0.01, threshold=3.0, x=3.01 * deviation))
    assert kalman.state[State.X] == 0.0
    assert kalman.correct(make_measurement(0.0, 0.01, threshold=3.0, x=2.99 * deviation))
    assert kalman.state[State.X] > 0.0


def test_nonfinite_values_are_ignored_and_others_are_used():
    kalman = ExtendedKalmanFilter(Settings(initial_covariance=diagonal_matrix(x=1.0, y=1.0)))
    kalman.is_initialized = True
    assert kalman.correct(make_measurement(0.0, 1.0, x=nan, y=1.0))
    assert kalman.state[:2] == pytest.approx([0.0, 0.5])
    assert not kalman.correct(make_measurement(0.0, 1.0, x=inf))
    assert not kalman.correct(make_measurement(0.0, nan, x=1.0))
    assert kalman.state[:2] == pytest.approx([0.0, 0.5])


def test_zero_and_negative_variances_are_replaced():
    kalman = ExtendedKalmanFilter(Settings(initial_covariance=diagonal_matrix(x=1.0, y=1.0)))
    kalman.is_initialized = True
    assert kalman.correct(make_measurement(0.0, 0.0, x=1.0))
    assert kalman.state[State.X] == pytest.approx(1.0)
    assert kalman.correct(make_measurement(0.0, -1.0, y=1.0))
    assert kalman.state[State.Y] == pytest.approx(0.5)


def test_past_measurement_corrects_without_moving_time_back():
    kalman = ExtendedKalmanFilter()
    kalman.process(make_measurement(2.0, x=0.0))
    kalman.process(make_measurement(1.0, x=1.0))
    assert kalman.time_ns == 2 * SECOND_NS
    assert 0.0 < kalman.state[State.X] < 1.0


def test_dynamic_process_noise_grows_with_velocity():
    kalman = ExtendedKalmanFilter(
        Settings(uses_dynamic_noise=True, initial_covariance=np.zeros((STATE_SIZE, STATE_SIZE)))
    )
    kalman.is_initialized = True
    kalman.predict(SECOND_NS)
    assert kalman.covariance[State.X, State.X] == 0.0
    assert kalman.covariance[State.VX, State.VX] == pytest.approx(0.025)
    kalman.restore(kalman.snapshot())
    kalman.covariance[:] = 0.0
    kalman.state[State.VX] = 2.0
    kalman.predict(2 * SECOND_NS)
    assert kalman.covariance[State.X, State.X] == pytest.approx(0.05 * 4.0)


def test_commands_accelerate_within_limits_and_time_out():
    unit_gains, limits = (1.0,) * 6, (0.5,) * 6
    is_controlled = (True, False, False, False, False, True)
    kalman = ExtendedKalmanFilter(
        Settings(control=Control(is_controlled, SECOND_NS, limits, unit_gains, limits, unit_gains))
    )
    kalman.process(make_measurement(0.0, vx=0.0, vyaw=0.0))
    kalman.command = (np.array([2.0, 0.0, 0.0, 0.0, 0.0, 0.1]), 0)
    kalman.predict(SECOND_NS // 2)
    assert kalman.state[State.AX] == 0.5
    assert kalman.state[State.VX] == pytest.approx(0.25)
    assert kalman.state[State.VYAW] == pytest.approx(0.05)
    kalman.predict(2 * SECOND_NS)
    assert kalman.state[State.AX] == pytest.approx(-0.25)


@FILTERS
def test_reset_restores_initial_state(filter_type):
    start = np.arange(STATE_SIZE) / 100.0
    kalman = filter_type(Settings(initial_state=start))
    kalman.process(make_measurement(0.0, x=3.0))
    kalman.reset()
    assert not kalman.is_initialized
    np.testing.assert_array_equal(kalman.state, start)
