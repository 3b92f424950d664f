"""The estimator: the order of measurements, delays and timeouts."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.navigation.estimation.estimator import Estimator, Timing
from linkwright.navigation.estimation.kalman import ExtendedKalmanFilter, Settings
from linkwright.navigation.estimation.motion_model import STATE_SIZE, State
from tests.navigation.estimation.test_kalman import SECOND_NS, make_measurement


def estimator(**timing):
    kalman = ExtendedKalmanFilter(Settings(initial_covariance=np.eye(STATE_SIZE)))
    return Estimator(kalman, Timing(**{"sensor_timeout_ns": SECOND_NS, **timing}))


def advance(estimator, seconds):
    estimator.advance(round(seconds * SECOND_NS))
    return estimator.filter


def test_measurements_are_processed_in_order_of_stamps():
    forwards, backwards = estimator(), estimator()
    measurements = [make_measurement(0.1 * step, x=0.3 * step**2, vyaw=0.1 * step) for step in range(10)]
    for measurement in measurements:
        forwards.add(measurement)
    for measurement in reversed(measurements):
        backwards.add(measurement)
    np.testing.assert_array_equal(advance(forwards, 1.0).state, advance(backwards, 1.0).state)


def test_future_measurement_is_delayed():
    active = estimator()
    active.add(make_measurement(0.0, x=1.0))
    active.add(make_measurement(2.0, x=9.0))
    assert advance(active, 1.0).state[State.X] == 1.0
    assert advance(active, 2.0).state[State.X] > 1.0


def test_state_is_predicted_only_after_sensor_timeout():
    active = estimator(sensor_timeout_ns=SECOND_NS // 2)
    active.add(make_measurement(0.0, vx=1.0))
    assert advance(active, 0.0).time_ns == 0
    assert advance(active, 0.4).time_ns == 0
    assert advance(active, 0.6).state[State.X] == pytest.approx(0.6)
    always = estimator(predict_to_now=True)
    always.add(make_measurement(0.0, vx=1.0))
    assert advance(always, 0.1).state[State.X] == pytest.approx(0.1)


def test_no_prediction_before_first_measurement():
    assert not advance(estimator(predict_to_now=True), 10.0).is_initialized


def test_late_measurement_is_processed_at_its_stamp():
    measurements = [make_measurement(0.1 * step, x=np.sin(0.1 * step), vx=np.cos(0.1 * step)) for step in range(20)]
    in_order, out_of_order = estimator(history_ns=10 * SECOND_NS), estimator(history_ns=10 * SECOND_NS)
    for measurement in measurements:
        in_order.add(measurement)
        advance(in_order, 5.0)
    for index, measurement in enumerate(measurements):
        if index != 7:
            out_of_order.add(measurement)
            advance(out_of_order, 5.0)
    out_of_order.add(measurements[7])
    np.testing.assert_allclose(advance(out_of_order, 5.0).state, in_order.filter.state, atol=1e-12)
    np.testing.assert_allclose(out_of_order.filter.covariance, in_order.filter.covariance, atol=1e-12)


def test_measurement_older_than_history_is_applied_at_history_start():
    active = estimator(history_ns=SECOND_NS)
    for step in range(50):
        active.add(make_measurement(0.1 * step, x=0.0))
        advance(active, 0.1 * step)
    active.add(make_measurement(1.0, x=1.0))
    state = advance(active, 5.0)
    assert state.time_ns == round(4.9 * SECOND_NS)
    assert state.state[State.X] != 0.0


def test_clear_discards_queued_measurements():
    active = estimator()
    active.add(make_measurement(0.0, x=1.0))
    active.clear()
    assert not advance(active, 1.0).is_initialized
