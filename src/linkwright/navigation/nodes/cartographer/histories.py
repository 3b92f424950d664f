"""Recent odometry and rates of rotation, by time."""

from __future__ import annotations

from bisect import bisect_right

from linkwright.navigation.slam.poses import FloatArray, compose, relative_pose
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_KEPT_NS = 10 * NANOSECONDS_PER_SECOND


class OdometryHistory:
    """The poses of a robot by odometry, in the order of their times."""

    def __init__(self) -> None:
        self._stamps: list[int] = []
        self._poses: list[FloatArray] = []

    @property
    def latest_ns(self) -> int | None:
        """The time of the latest pose, or None."""
        return self._stamps[-1] if self._stamps else None

    def add(self, stamp_ns: int, pose: FloatArray) -> None:
        """Add a pose, unless it is not later than the latest one."""
        if self._stamps and stamp_ns <= self._stamps[-1]:
            return
        self._stamps.append(stamp_ns)
        self._poses.append(pose)
        if stamp_ns - self._stamps[0] > 2 * _KEPT_NS:
            first = bisect_right(self._stamps, stamp_ns - _KEPT_NS)
            del self._stamps[:first], self._poses[:first]

    def find_pose(self, time_ns: int) -> FloatArray:
        """Return the pose at a time, of shape (3,), interpolated, or the nearest one outside the known times.

        There must be at least one pose.
        """
        index = bisect_right(self._stamps, time_ns)
        if index == 0:
            return self._poses[0]
        if index == len(self._stamps):
            return self._poses[-1]
        first, second = self._stamps[index - 1], self._stamps[index]
        motion = relative_pose(self._poses[index - 1], self._poses[index])
        return compose(self._poses[index - 1], motion * ((time_ns - first) / (second - first)))


class RotationHistory:
    """The rates of rotation about the vertical axis that a gyroscope measured, in the order of their times."""

    def __init__(self) -> None:
        self._stamps: list[int] = []
        self._rates: list[float] = []

    def add(self, stamp_ns: int, rate: float) -> None:
        """Add a rate in rad/s, unless it is not later than the latest one."""
        if self._stamps and stamp_ns <= self._stamps[-1]:
            return
        self._stamps.append(stamp_ns)
        self._rates.append(rate)
        if stamp_ns - self._stamps[0] > 2 * _KEPT_NS:
            first = bisect_right(self._stamps, stamp_ns - _KEPT_NS)
            del self._stamps[:first], self._rates[:first]

    def find_rotation(self, begin_ns: int, end_ns: int) -> float | None:
        """Return the rotation between two times in radians, or None if no rate was measured between them."""
        first, last = bisect_right(self._stamps, begin_ns), bisect_right(self._stamps, end_ns)
        if first == last:
            return None
        rotation, time_ns = 0.0, begin_ns
        for stamp_ns, rate in zip(self._stamps[first:last], self._rates[first:last], strict=True):
            rotation += rate * (stamp_ns - time_ns)
            time_ns = stamp_ns
        rotation += self._rates[last - 1] * (end_ns - time_ns)
        return rotation / NANOSECONDS_PER_SECOND
