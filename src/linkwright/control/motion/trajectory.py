"""Trajectories of joints, sampled in time.

Source: the ``Trajectory`` of joint_trajectory_controller of ros2_controllers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, tau

from linkwright.control.motion.splines import MotionState, Segment
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND


@dataclass(slots=True)
class TrajectoryPoint:
    """A state at a time after the start of a trajectory.

    Attributes:
        time_ns: the time after the start of the trajectory, in nanoseconds.
        state: the state of all joints; `Trajectory.begin` computes missing positions.
    """

    time_ns: int
    state: MotionState


@dataclass(frozen=True, slots=True)
class Sample:
    """The state of a trajectory at a time.

    Attributes:
        state: the state at the sampled time.
        index: the index of the last point that was passed; also 0 before the first point.
        point_ns: the time of that point, in nanoseconds.
        has_ended: whether the last point has been passed.
    """

    state: MotionState
    index: int
    point_ns: int
    has_ended: bool


class Trajectory:
    """A sequence of points, and the splines between them.

    Args:
        points: at least one point, in order of time.
        start_ns: the time at which the trajectory starts; 0 to start when `begin` is called.
        interpolated: whether joints move along the splines; otherwise each point is commanded from the time of the
            previous one, and the initial state until the time of the first point.
    """

    def __init__(self, points: Sequence[TrajectoryPoint], start_ns: int = 0, *, interpolated: bool = True) -> None:
        self.points = list(points)
        self._requested_start_ns = start_ns
        self._is_interpolated = interpolated
        self.is_started = False

    def begin(self, time_ns: int, current: MotionState, wrap_mask: Sequence[bool] = ()) -> None:
        """Start the trajectory from the current state.

        Missing positions of a point are integrated from its velocities. If the velocities are missing, too, they are
        integrated from its accelerations.

        Args:
            time_ns: the time of the current state.
            current: the state of the joints; its velocities and accelerations are used if the first point has them.
            wrap_mask: for each joint whether it rotates without limits and takes the shorter way to the first point.
        """
        self.is_started = True
        self._start_ns = self._requested_start_ns or time_ns
        self._begin_ns = time_ns
        first_ns = self._start_ns + self.points[0].time_ns
        current = current.copy()
        previous_ns, previous = time_ns, current
        for point in self.points:
            next_ns = self._start_ns + point.time_ns
            point.state = _integrate_positions(
                previous, point.state, max(next_ns - previous_ns, 0) / NANOSECONDS_PER_SECOND
            )
            previous_ns, previous = next_ns, point.state
        for joint, is_wrapped in enumerate(wrap_mask):
            if is_wrapped:
                target = self.points[0].state.positions[joint]
                current.positions[joint] = target - shortest_turn(current.positions[joint], target)
        self._begin_state = current
        last_state = self.points[-1].state
        zeros = [0.0] * len(last_state.positions)
        end_state = MotionState(last_state.positions, last_state.velocities or zeros, last_state.accelerations or zeros)
        self._segments: list[Segment | None] = [None] * len(self.points)
        self._starts = [self._begin_ns, first_ns, *(self._start_ns + point.time_ns for point in self.points[1:])]
        self._index = 0
        self._end_sample = Sample(end_state, len(self.points) - 1, self._starts[-1], has_ended=True)

    def sample(self, time_ns: int) -> Sample | None:
        """Return the sample at a time in nanoseconds, or None before the time passed to `begin`.

        Segment n leads from the time ``_starts[n]`` to ``_starts[n + 1]``; segment 0 starts at the state in `begin`.
        """
        starts = self._starts
        if time_ns < starts[0]:
            return None
        if time_ns >= starts[-1]:
            return self._end_sample
        index = self._index
        if not starts[index] <= time_ns < starts[index + 1]:
            index = next(index for index in range(len(self.points)) if time_ns < starts[index + 1])
            self._index = index
        passed_index = max(index - 1, 0)
        return Sample(self._sample_segment(index, time_ns), passed_index, starts[passed_index + 1], has_ended=False)

    def _sample_segment(self, index: int, time_ns: int) -> MotionState:
        if not self._is_interpolated:
            return self.points[index].state if index else self._begin_state
        segment = self._segments[index]
        begin_ns, end_ns = self._starts[index], self._starts[index + 1]
        if segment is None:
            start = self.points[index - 1].state if index else self._begin_state
            segment = Segment(start, self.points[index].state, (end_ns - begin_ns) / NANOSECONDS_PER_SECOND)
            self._segments[index] = segment
        return segment.sample((time_ns - begin_ns) / NANOSECONDS_PER_SECOND)


def shortest_turn(start: float, end: float) -> float:
    """Return the smallest rotation from one angle to another, in rad, within (-pi, pi]."""
    rotation = (end - start) % tau
    return rotation - tau if rotation > pi else rotation


def _integrate_positions(previous: MotionState, state: MotionState, seconds: float) -> MotionState:
    """Return a state with positions.

    Missing positions are integrated from velocities or accelerations. `previous` is the state `seconds` earlier.
    """
    if state.positions:
        return state
    zeros = [0.0] * len(previous.positions)
    start_velocities = previous.velocities or zeros
    velocities = state.velocities or [
        velocity + 0.5 * (old_rate + new_rate) * seconds
        for velocity, old_rate, new_rate in zip(
            start_velocities, previous.accelerations or zeros, state.accelerations, strict=True
        )
    ]
    positions = [
        position + 0.5 * (first + second) * seconds
        for position, first, second in zip(previous.positions, start_velocities, velocities, strict=True)
    ]
    return MotionState(positions, velocities, state.accelerations)
