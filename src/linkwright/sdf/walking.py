"""Computes the poses of an actor along its path.

Source: Gazebo's ``common::PoseAnimation``, ``Spline`` and ``RotationSpline``. The points of a trajectory are
interpolated by a Catmull-Rom spline, whose tangents are shortened by the tension, and their rotations by a quaternion
spline (squad).
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from math import acos, cos, fmod, sin

from linkwright.geometry.single import IDENTITY, Quaternion, Transform, Vector3, quaternion_inverse, quaternion_multiply
from linkwright.sdf.actors import Script, Trajectory
from linkwright.sdf.frames import transform_of

_NO_ANGLE = 1e-9
"""Half an angle in radians that is none."""


class Walk:
    """A walk along the trajectories of a script, one after the other.

    Args:
        script: the timing and the trajectories of the walk.
    """

    def __init__(self, script: Script) -> None:
        self._script = script
        self._legs = [_Leg(trajectory) for trajectory in script.trajectories if trajectory.waypoints]
        self._length = sum(leg.length for leg in self._legs)

    @property
    def has_waypoints(self) -> bool:
        """Whether the walk has at least one waypoint."""
        return bool(self._legs)

    def pose(self, seconds: float) -> Transform:
        """Return the pose at a simulated time in seconds.

        Before the walk starts, this is the pose of the first waypoint. After the end, the walk is repeated if the
        script loops, and otherwise the pose of the last waypoint is returned. A walk without waypoints is at
        the origin.

        Args:
            seconds: the simulated time in s.
        """
        if not self._legs:
            return IDENTITY
        since = max(seconds - self._script.delay_start, 0.0) if self._script.auto_start else 0.0
        if since > self._length:
            since = fmod(since, self._length) if self._script.loop and self._length > 0.0 else self._length
        for leg in self._legs[:-1]:
            if since < leg.length:
                return leg.pose(since)
            since -= leg.length
        return self._legs[-1].pose(since)


@dataclass(frozen=True, slots=True)
class _Key:
    """A waypoint: position and rotation, with the tangents of the splines through them."""

    point: Vector3
    turn: Quaternion
    tangent: Vector3
    rotation: Quaternion


class _Leg:
    """A section of the walk that follows one trajectory."""

    def __init__(self, trajectory: Trajectory) -> None:
        found = {waypoint.time: transform_of(waypoint.pose.pose) for waypoint in trajectory.waypoints}
        self._times = sorted(found)
        poses = [found[time] for time in self._times]
        self._times[0] = min(self._times[0], 0.0)  # The walk starts at the first point, whatever its time.
        stretch = 0.5 * (1.0 - trajectory.tension)
        self._keys = [_key(poses, index, stretch) for index in range(len(poses))]
        self.length = self._times[-1]

    def pose(self, seconds: float) -> Transform:
        place = min(max(bisect_right(self._times, seconds) - 1, 0), len(self._times) - 1)
        key = self._keys[place]
        if place + 1 == len(self._times):
            return (*key.point, *key.turn)
        after = self._keys[place + 1]
        share = (seconds - self._times[place]) / (self._times[place + 1] - self._times[place])
        share = min(max(share, 0.0), 1.0)
        return (*_between(key, after, share), *_squad(key, after, share))


def _key(poses: list[Transform], index: int, stretch: float) -> _Key:
    x, y, z, *_ = poses[index]
    before, after = poses[max(index - 1, 0)], poses[min(index + 1, len(poses) - 1)]
    tangent = (stretch * (after[0] - before[0]), stretch * (after[1] - before[1]), stretch * (after[2] - before[2]))
    turn = poses[index][3:]
    back = quaternion_inverse(turn)
    ahead, behind = (_log(quaternion_multiply(back, item[3:])) for item in (after, before))
    bent = _exp((-0.25 * (ahead[0] + behind[0]), -0.25 * (ahead[1] + behind[1]), -0.25 * (ahead[2] + behind[2])))
    return _Key((x, y, z), turn, tangent, quaternion_multiply(turn, bent))


def _between(one: _Key, other: _Key, share: float) -> Vector3:
    """Return a point of the cubic Hermite curve between two waypoints; `share` is from 0 to 1."""
    square, cube = share**2, share**3
    first, last = 2 * cube - 3 * square + 1, 3 * square - 2 * cube
    leaving, coming = cube - 2 * square + share, cube - square
    x, y, z = (
        first * p + last * q + leaving * t + coming * u
        for p, q, t, u in zip(one.point, other.point, one.tangent, other.tangent, strict=True)
    )
    return x, y, z


def _squad(one: _Key, other: _Key, share: float) -> Quaternion:
    outer = _slerp(one.turn, other.turn, share)
    inner = _slerp(one.rotation, other.rotation, share)
    return _slerp(outer, inner, 2.0 * share * (1.0 - share))


def _slerp(one: Quaternion, other: Quaternion, share: float) -> Quaternion:
    product = sum(a * b for a, b in zip(one, other, strict=True))
    if product < 0.0:
        x, y, z, w = other
        product, other = -product, (-x, -y, -z, -w)
    angle = acos(min(max(product, -1.0), 1.0))
    if sin(angle) < _NO_ANGLE:
        first, last = 1.0 - share, share
    else:
        first, last = sin((1.0 - share) * angle) / sin(angle), sin(share * angle) / sin(angle)
    x, y, z, w = (first * a + last * b for a, b in zip(one, other, strict=True))
    length = (x * x + y * y + z * z + w * w) ** 0.5 or 1.0
    return x / length, y / length, z / length, w / length


def _log(turn: Quaternion) -> Vector3:
    """Return the logarithm of a rotation: its axis multiplied by half its angle."""
    x, y, z, w = turn
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    angle = acos(min(w, 1.0))
    factor = angle / sin(angle) if sin(angle) > _NO_ANGLE else 1.0
    return factor * x, factor * y, factor * z


def _exp(vector: Vector3) -> Quaternion:
    x, y, z = vector
    angle = (x * x + y * y + z * z) ** 0.5
    factor = sin(angle) / angle if angle > _NO_ANGLE else 1.0
    return factor * x, factor * y, factor * z, cos(angle)
