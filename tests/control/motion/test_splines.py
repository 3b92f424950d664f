"""Segments of trajectories, compared with polynomials, and sampling of trajectories."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.control.motion.splines import MotionState, Segment
from linkwright.control.motion.trajectory import Sample, Trajectory, TrajectoryPoint, shortest_turn

SECOND_NS = 1_000_000_000
numbers = st.floats(-10.0, 10.0)
durations = st.floats(0.1, 10.0)


def trajectory_point(seconds: float, *lists: list[float]) -> TrajectoryPoint:
    """Return a point with some of positions, velocities and accelerations."""
    return TrajectoryPoint(round(seconds * SECOND_NS), MotionState(*lists))


def sample_at(trajectory: Trajectory, seconds: float) -> Sample:
    """Return the sample at a time in seconds."""
    sample = trajectory.sample(round(seconds * SECOND_NS))
    assert sample is not None
    return sample


def solve_polynomial(start: list[float], end: list[float], duration: float) -> np.ndarray:
    """Return the polynomial with given derivatives at both ends, lowest power first.

    The linear system is solved.
    """
    order = len(start) + len(end)
    equations = []
    for time in (0.0, duration):
        for derivative in range(len(start)):
            basis_values = [np.polynomial.Polynomial.basis(power).deriv(derivative)(time) for power in range(order)]
            equations.append([float(coefficient) for coefficient in basis_values])
    return np.linalg.solve(np.array(equations), np.array([*start, *end]))


@given(numbers, numbers, durations)
def test_segment_of_positions_is_linear(p0: float, p1: float, duration: float):
    segment = Segment(MotionState([p0]), MotionState([p1]), duration)
    for fraction in (0.0, 0.3, 1.0):
        state = segment.sample(fraction * duration)
        assert state.positions == pytest.approx([p0 + fraction * (p1 - p0)], abs=1e-9)
        assert state.velocities == pytest.approx([(p1 - p0) / duration])
        assert state.accelerations == [0.0]


@given(*[numbers] * 6, durations, st.sampled_from([2, 3]))
def test_segment_is_polynomial_through_both_points(p0, v0, a0, p1, v1, a1, duration, derivative_count):
    start, end = [p0, v0, a0][:derivative_count], [p1, v1, a1][:derivative_count]
    segment = Segment(MotionState(*([value] for value in start)), MotionState(*([value] for value in end)), duration)
    expected = np.polynomial.Polynomial(solve_polynomial(start, end, duration))
    scale = 1.0 + max(map(abs, (p0, p1, v0, v1, a0, a1))) * max(1.0, duration, duration**-2)
    for fraction in (0.0, 0.1, 0.5, 0.9, 1.0):
        time = fraction * duration
        state = segment.sample(time)
        assert state.positions[0] == pytest.approx(float(expected(time)), abs=1e-9 * scale)
        assert state.velocities[0] == pytest.approx(float(expected.deriv()(time)), abs=1e-8 * scale)
        assert state.accelerations[0] == pytest.approx(float(expected.deriv(2)(time)), abs=1e-7 * scale)


def test_segment_uses_only_values_given_at_both_points():
    state = Segment(MotionState([0.0], [1.0], [1.0]), MotionState([1.0]), 2.0).sample(1.0)
    assert (state.positions, state.velocities) == ([0.5], [0.5])
    cubic = Segment(MotionState([0.0], [0.0], [9.0]), MotionState([1.0], [0.0]), 2.0).sample(1.0)
    assert cubic.positions == pytest.approx([0.5])
    assert cubic.velocities == pytest.approx([0.75])


def test_trajectory_starts_at_joint_state_and_ends_at_last_point():
    trajectory = Trajectory([trajectory_point(1.0, [1.0]), trajectory_point(3.0, [2.0])])
    trajectory.begin(10 * SECOND_NS, MotionState([0.0]))
    assert trajectory.sample(9 * SECOND_NS) is None
    assert [sample_at(trajectory, time).state.positions[0] for time in (10.0, 10.5, 11.0, 12.0, 13.0, 99.0)] == (
        pytest.approx([0.0, 0.5, 1.0, 1.5, 2.0, 2.0])
    )
    assert [sample_at(trajectory, time).index for time in (10.0, 11.0, 12.9, 13.0)] == [0, 0, 0, 1]
    assert [sample_at(trajectory, time).has_ended for time in (12.9, 13.0)] == [False, True]
    assert sample_at(trajectory, 99.0).point_ns == 13 * SECOND_NS
    assert sample_at(trajectory, 99.0).state == MotionState([2.0], [0.0], [0.0])


def test_trajectory_can_be_sampled_backwards():
    trajectory = Trajectory([trajectory_point(float(seconds), [float(seconds)]) for seconds in range(1, 6)])
    trajectory.begin(SECOND_NS, MotionState([0.0]))
    assert [sample_at(trajectory, time).state.positions[0] for time in (5.5, 1.5, 3.5)] == pytest.approx(
        [4.5, 0.5, 2.5]
    )


def test_trajectory_with_future_start_moves_to_first_point_from_now():
    trajectory = Trajectory([trajectory_point(0.0, [1.0])], start_ns=4 * SECOND_NS)
    trajectory.begin(2 * SECOND_NS, MotionState([0.0]))
    assert sample_at(trajectory, 3.0).state.positions == pytest.approx([0.5])
    assert sample_at(trajectory, 4.0).has_ended


def test_trajectory_with_past_start_continues_at_current_segment():
    trajectory = Trajectory([trajectory_point(1.0, [1.0]), trajectory_point(5.0, [5.0])], start_ns=SECOND_NS)
    trajectory.begin(4 * SECOND_NS, MotionState([0.0]))
    assert sample_at(trajectory, 4.0).state.positions == pytest.approx([3.0])


def test_missing_positions_and_velocities_are_integrated():
    trajectory = Trajectory(
        [trajectory_point(1.0, [], [2.0]), trajectory_point(2.0, [], [4.0]), trajectory_point(3.0, [], [], [0.0])]
    )
    trajectory.begin(SECOND_NS, MotionState([0.0]))
    assert [point.state.positions for point in trajectory.points] == [[1.0], [4.0], [8.0]]
    assert trajectory.points[2].state.velocities == [4.0]


@given(
    st.lists(st.tuples(st.floats(0.05, 3.0), numbers, numbers, numbers), min_size=1, max_size=6),
    numbers,
    st.sampled_from([1, 2, 3]),
)
def test_trajectory_is_continuous_through_its_points(points, begin, derivative_count):
    times = np.cumsum([point[0] for point in points])
    trajectory_points = [
        trajectory_point(float(time), *([value] for value in values[:derivative_count]))
        for time, (_, *values) in zip(times, points, strict=True)
    ]
    trajectory = Trajectory(trajectory_points)
    trajectory.begin(0, MotionState([begin], [0.0], [0.0]))
    assert sample_at(trajectory, 0.0).state.positions == pytest.approx([begin])
    for time, (_, position, *_rest) in zip(times, points, strict=True):
        ns = round(float(time) * SECOND_NS)
        earlier, later = trajectory.sample(ns - 1), trajectory.sample(ns)
        assert earlier is not None
        assert later is not None
        assert earlier.state.positions == pytest.approx([position], abs=1e-5)
        assert later.state.positions == pytest.approx([position], abs=1e-9)
    assert sample_at(trajectory, float(times[-1])).has_ended


def test_points_are_sampled_when_due_without_interpolation():
    trajectory = Trajectory([trajectory_point(1.0, [1.0]), trajectory_point(2.0, [2.0])], interpolated=False)
    trajectory.begin(SECOND_NS, MotionState([0.0]))
    assert [sample_at(trajectory, time).state.positions for time in (1.5, 2.0, 3.0)] == [[0.0], [2.0], [2.0]]


@given(st.floats(-20.0, 20.0), st.floats(-20.0, 20.0))
def test_shortest_turn_is_at_most_half_a_turn(start: float, end: float):
    angle = shortest_turn(start, end)
    assert -pi <= angle <= pi
    assert np.cos(start + angle) == pytest.approx(np.cos(end), abs=1e-9)
    assert np.sin(start + angle) == pytest.approx(np.sin(end), abs=1e-9)


def test_continuous_joint_turns_shorter_way():
    trajectory = Trajectory([trajectory_point(1.0, [-3.0, -3.0])])
    trajectory.begin(0, MotionState([3.0, 3.0]), (True, False))
    middle = sample_at(trajectory, 0.5).state.positions
    assert middle == pytest.approx([-pi, 0.0])
