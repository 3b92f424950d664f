"""How fast a frame moves, from where it was at two times. The formulas are those of tf2's ``lookupVelocity``.

They are kept as they are there, so that programs get the numbers that they get from tf2, also where the reference
frame turns against the others and other formulas would be right.
"""

from __future__ import annotations

from math import acos, sqrt
from typing import Protocol

from linkwright.graph.transforms.pose import Pose, Quaternion, Vector, multiply, rotate

_EARLIEST_S = 0.00001


class PoseSource(Protocol):
    """What gives poses of frames in frames."""

    def lookup(self, target: str, source: str, time_ns: int) -> tuple[Pose, int]:
        """The pose of the source frame in the target frame, and its time."""


def velocity(
    buffer: PoseSource,
    tracking_frame: str,
    observation_frame: str,
    reference: tuple[str, Vector, str],
    times_ns: tuple[int, int, int],
) -> tuple[Vector, Vector]:
    """Linear and angular velocity of a frame, in metres and radians a second.

    Args:
        buffer: gives the poses.
        tracking_frame: the frame that moves.
        observation_frame: the frame in which its movement is seen.
        reference: the frame in which the velocity is given, a point for which it is given, and that point's frame.
        times_ns: the time, the latest time that both frames have, and the interval over which it is averaged, in
            nanoseconds.

    Raises:
        TransformException: there are no poses for these times.
    """
    reference_frame, point, point_frame = reference
    time_s, latest_s, interval_s = (each / 1e9 for each in times_ns)
    end_s = min(time_s + interval_s * 0.5, latest_s)
    start_s = max(_EARLIEST_S + interval_s, end_s) - interval_s
    span_s = end_s - start_s
    start, _ = buffer.lookup(observation_frame, tracking_frame, round(start_s * 1e9))
    end, _ = buffer.lookup(observation_frame, tracking_frame, round(end_s * 1e9))
    axis, angle = _axis_and_angle(multiply(_inverse(start[3:]), end[3:]))
    turning = _scaled(rotate(start[3:], axis), angle / span_s)
    moving = _scaled(_minus(end[:3], start[:3]), 1.0 / span_s)
    in_reference, _ = buffer.lookup(reference_frame, tracking_frame, times_ns[0])
    angular = rotate(in_reference[3:], turning)
    linear = _plus(rotate(in_reference[3:], moving), _cross(in_reference[:3], angular))
    of_point, _ = buffer.lookup(reference_frame, point_frame, times_ns[0])
    delta = _minus(_plus(rotate(of_point[3:], point), of_point[:3]), in_reference[:3])
    shift = (angular[0] * delta[0], angular[1] * delta[1], angular[2] * delta[2])
    return _plus(linear, shift), angular


def _axis_and_angle(quaternion: Quaternion) -> tuple[Vector, float]:
    x, y, z, w = quaternion
    squared = 1.0 - w * w
    if squared < 1e-12:
        return (1.0, 0.0, 0.0), 2.0 * acos(max(-1.0, min(1.0, w)))
    scale = 1.0 / sqrt(squared)
    return (x * scale, y * scale, z * scale), 2.0 * acos(max(-1.0, min(1.0, w)))


def _inverse(quaternion: Quaternion) -> Quaternion:
    x, y, z, w = quaternion
    return -x, -y, -z, w


def _plus(first: Vector, second: Vector) -> Vector:
    return first[0] + second[0], first[1] + second[1], first[2] + second[2]


def _minus(first: Vector, second: Vector) -> Vector:
    return first[0] - second[0], first[1] - second[1], first[2] - second[2]


def _scaled(vector: Vector, factor: float) -> Vector:
    return vector[0] * factor, vector[1] * factor, vector[2] * factor


def _cross(first: Vector, second: Vector) -> Vector:
    return (
        first[1] * second[2] - first[2] * second[1],
        first[2] * second[0] - first[0] * second[2],
        first[0] * second[1] - first[1] * second[0],
    )
