"""The poses of an actor along its path.

Source: Gazebo's ``common::PoseAnimation``, ``Spline`` and ``RotationSpline``. A Catmull-Rom spline, with
tangents shortened by the tension, interpolates the positions of a trajectory. A quaternion spline (squad) interpolates
the rotations.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from math import acos, cos, fmod, sin

from linkwright.geometry.single import IDENTITY, Quaternion, Transform, Vector3, quaternion_inverse, quaternion_multiply
from linkwright.sdf.actors import Script, Trajectory
from linkwright.sdf.frames import transform_of

_ANGLE_TOLERANCE = 1e-9
"""Half angles in radians below this are treated as zero."""


class Walk:
    """An actor's walk along the trajectories of a script, one after the other.

    Args:
        script: the start of the walk, its repetition and its trajectories.
    """

    def __init__(self, script: Script) -> None:
        self._script = script
        self._sections = [_Section(trajectory) for trajectory in script.trajectories if trajectory.waypoints]
        self._duration = sum(leg.length for leg in self._sections)

    @property
    def has_waypoints(self) -> bool:
        """Whether the walk has at least one waypoint."""
        return bool(self._sections)

    def pose(self, seconds: float) -> Transform:
        """Return the pose at a simulated time in seconds.

        Before the start, this is the pose at the start of the walk. After the end, the walk is repeated if the script
        loops; otherwise the actor stays at the last waypoint. A walk without waypoints is at the origin.

        Args:
            seconds: the simulated time in s.
        """
        if not self._sections:
            return IDENTITY
        walk_time = max(seconds - self._script.delay_start, 0.0) if self._script.auto_start else 0.0
        if walk_time > self._duration:
            walk_time = (
                fmod(walk_time, self._duration) if self._script.loop and self._duration > 0.0 else self._duration
            )
        for section in self._sections[:-1]:
            if walk_time < section.length:
                return section.pose(walk_time)
            walk_time -= section.length
        return self._sections[-1].pose(walk_time)


@dataclass(frozen=True, slots=True)
class _Keyframe:
    """A waypoint for interpolation.

    `point` and `turn` are its position and rotation. `tangent` is the tangent of the position spline, and `rotation`
    the inner control point of the rotation spline.
    """

    point: Vector3
    turn: Quaternion
    tangent: Vector3
    rotation: Quaternion


class _Section:
    """A section of the walk that follows one trajectory."""

    def __init__(self, trajectory: Trajectory) -> None:
        poses_by_time = {waypoint.time: transform_of(waypoint.pose.pose) for waypoint in trajectory.waypoints}
        self._times = sorted(poses_by_time)
        poses = [poses_by_time[time] for time in self._times]
        self._times[0] = min(self._times[0], 0.0)  # The walk starts at the first point at once.
        tangent_scale = 0.5 * (1.0 - trajectory.tension)
        self._keyframes = [_make_keyframe(poses, index, tangent_scale) for index in range(len(poses))]
        self.length = self._times[-1]

    def pose(self, seconds: float) -> Transform:
        index = min(max(bisect_right(self._times, seconds) - 1, 0), len(self._times) - 1)
        keyframe = self._keyframes[index]
        if index + 1 == len(self._times):
            return (*keyframe.point, *keyframe.turn)
        next_keyframe = self._keyframes[index + 1]
        fraction = (seconds - self._times[index]) / (self._times[index + 1] - self._times[index])
        fraction = min(max(fraction, 0.0), 1.0)
        return (*_interpolate_position(keyframe, next_keyframe, fraction), *_squad(keyframe, next_keyframe, fraction))


def _make_keyframe(poses: list[Transform], index: int, tangent_scale: float) -> _Keyframe:
    x, y, z, *_ = poses[index]
    previous_pose, next_pose = poses[max(index - 1, 0)], poses[min(index + 1, len(poses) - 1)]
    tangent = (
        tangent_scale * (next_pose[0] - previous_pose[0]),
        tangent_scale * (next_pose[1] - previous_pose[1]),
        tangent_scale * (next_pose[2] - previous_pose[2]),
    )
    orientation = poses[index][3:]
    inverse = quaternion_inverse(orientation)
    log_to_next, log_to_previous = (
        _log(quaternion_multiply(inverse, neighbor[3:])) for neighbor in (next_pose, previous_pose)
    )
    offset = _exp(
        (
            -0.25 * (log_to_next[0] + log_to_previous[0]),
            -0.25 * (log_to_next[1] + log_to_previous[1]),
            -0.25 * (log_to_next[2] + log_to_previous[2]),
        )
    )
    return _Keyframe((x, y, z), orientation, tangent, quaternion_multiply(orientation, offset))


def _interpolate_position(start: _Keyframe, end: _Keyframe, fraction: float) -> Vector3:
    """Return the position between two waypoints on a cubic Hermite curve.

    `fraction` is from 0 to 1.
    """
    square, cube = fraction**2, fraction**3
    start_weight, end_weight = 2 * cube - 3 * square + 1, 3 * square - 2 * cube
    start_tangent_weight, end_tangent_weight = cube - 2 * square + fraction, cube - square
    x, y, z = (
        start_weight * p + end_weight * q + start_tangent_weight * t + end_tangent_weight * u
        for p, q, t, u in zip(start.point, end.point, start.tangent, end.tangent, strict=True)
    )
    return x, y, z


def _squad(start: _Keyframe, end: _Keyframe, fraction: float) -> Quaternion:
    outer = _slerp(start.turn, end.turn, fraction)
    inner = _slerp(start.rotation, end.rotation, fraction)
    return _slerp(outer, inner, 2.0 * fraction * (1.0 - fraction))


def _slerp(start: Quaternion, end: Quaternion, fraction: float) -> Quaternion:
    product = sum(a * b for a, b in zip(start, end, strict=True))
    if product < 0.0:
        x, y, z, w = end
        product, end = -product, (-x, -y, -z, -w)
    angle = acos(min(max(product, -1.0), 1.0))
    if sin(angle) < _ANGLE_TOLERANCE:
        start_weight, end_weight = 1.0 - fraction, fraction
    else:
        start_weight, end_weight = sin((1.0 - fraction) * angle) / sin(angle), sin(fraction * angle) / sin(angle)
    x, y, z, w = (start_weight * a + end_weight * b for a, b in zip(start, end, strict=True))
    length = (x * x + y * y + z * z + w * w) ** 0.5 or 1.0
    return x / length, y / length, z / length, w / length


def _log(rotation: Quaternion) -> Vector3:
    """Return the logarithm of a rotation: its axis multiplied by half its angle."""
    x, y, z, w = rotation
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    angle = acos(min(w, 1.0))
    factor = angle / sin(angle) if sin(angle) > _ANGLE_TOLERANCE else 1.0
    return factor * x, factor * y, factor * z


def _exp(vector: Vector3) -> Quaternion:
    x, y, z = vector
    angle = (x * x + y * y + z * z) ** 0.5
    factor = sin(angle) / angle if angle > _ANGLE_TOLERANCE else 1.0
    return factor * x, factor * y, factor * z, cos(angle)
