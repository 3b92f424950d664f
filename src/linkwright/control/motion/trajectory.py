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
        state: the state of all joints; missing positions are computed, see `Trajectory.begin`.
    """

    time_ns: int
    state: MotionState


@dataclass(frozen=True, slots=True)
class Sample:
    """The state of a trajectory at a time.

    Attributes:
        state: the state at the sampled time.
        index: the index of the point that was passed last; 0 before the first point, too.
        point_ns: the time of that point, in nanoseconds.
        ended: whether the last point has been passed.
    """

    state: MotionState
    index: int
    point_ns: int
    ended: bool


class Trajectory:
    """A sequence of points, and the splines between them.

    Args:
        points: at least one point, in order of time.
        start_ns: the time at which the trajectory starts; 0 to start when `begin` is called.
        interpolated: whether joints move along the splines; otherwise the next point is commanded at once.
    """

    def __init__(self, points: Sequence[TrajectoryPoint], start_ns: int = 0, *, interpolated: bool = True) -> None:
        self.points = list(points)
        self._given_start_ns = start_ns
        self._interpolated = interpolated
        self.begun = False

    def begin(self, time_ns: int, before: MotionState, wrapped: Sequence[bool] = ()) -> None:
        """Start the trajectory from the current state.

        Positions that a point lacks are integrated from velocities, and velocities that are then missing from
        accelerations.

        Args:
            time_ns: the time of the state `before`.
            before: the state of the joints; its velocities and accelerations are used if the first point has them.
            wrapped: whether each joint rotates without limits; such joints take the shorter way to the first point.
        """
        self.begun = True
        self._start_ns = self._given_start_ns or time_ns
        self._before_ns = time_ns
        first = self._start_ns + self.points[0].time_ns
        before = before.copy()
        due_ns, state = time_ns, before
        for point in self.points:
            next_ns = self._start_ns + point.time_ns
            point.state = _with_positions(state, point.state, max(next_ns - due_ns, 0) / NANOSECONDS_PER_SECOND)
            due_ns, state = next_ns, point.state
        for joint, turns in enumerate(wrapped):
            if turns:
                target = self.points[0].state.positions[joint]
                before.positions[joint] = target - shortest_turn(before.positions[joint], target)
        self._before = before
        last = self.points[-1].state
        none = [0.0] * len(last.positions)
        end = MotionState(last.positions, last.velocities or none, last.accelerations or none)
        self._segments: list[Segment | None] = [None] * len(self.points)
        self._starts = [self._before_ns, first, *(self._start_ns + point.time_ns for point in self.points[1:])]
        self._index = 0
        self._end = Sample(end, len(self.points) - 1, self._starts[-1], ended=True)

    def sample(self, time_ns: int) -> Sample | None:
        """Return the sample at a time in nanoseconds, or None before the time passed to `begin`.

        Segment number n leads from ``_starts[n]`` to ``_starts[n + 1]``, and the first segment from the state before.
        """
        starts = self._starts
        if time_ns < starts[0]:
            return None
        if time_ns >= starts[-1]:
            return self._end
        index = self._index
        if not starts[index] <= time_ns < starts[index + 1]:
            index = next(index for index in range(len(self.points)) if time_ns < starts[index + 1])
            self._index = index
        passed = max(index - 1, 0)
        return Sample(self._state(index, time_ns), passed, starts[passed + 1], ended=False)

    def _state(self, index: int, time_ns: int) -> MotionState:
        if not self._interpolated:
            return self.points[index].state if index else self._before
        segment = self._segments[index]
        begin_ns, end_ns = self._starts[index], self._starts[index + 1]
        if segment is None:
            start = self.points[index - 1].state if index else self._before
            segment = Segment(start, self.points[index].state, (end_ns - begin_ns) / NANOSECONDS_PER_SECOND)
            self._segments[index] = segment
        return segment.at((time_ns - begin_ns) / NANOSECONDS_PER_SECOND)


def shortest_turn(start: float, end: float) -> float:
    """Return the smallest rotation from one angle to another, in rad, within (-pi, pi]."""
    turn = (end - start) % tau
    return turn - tau if turn > pi else turn


def _with_positions(before: MotionState, state: MotionState, seconds: float) -> MotionState:
    """Return a state with positions, integrated from its velocities or accelerations if missing.

    `before` is the state `seconds` earlier.
    """
    if state.positions:
        return state
    none = [0.0] * len(before.positions)
    begin = before.velocities or none
    velocities = state.velocities or [
        speed + 0.5 * (first + second) * seconds
        for speed, first, second in zip(begin, before.accelerations or none, state.accelerations, strict=True)
    ]
    positions = [
        place + 0.5 * (first + second) * seconds
        for place, first, second in zip(before.positions, begin, velocities, strict=True)
    ]
    return MotionState(positions, velocities, state.accelerations)
