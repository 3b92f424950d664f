"""The velocity of a frame, computed with the formulas of tf2's ``lookupVelocity``.

With tf2's formulas, programs receive the same numbers. The formulas are not correct if the reference frame rotates
relative to the other frames, but they are used even then.
"""

from __future__ import annotations

from typing import Protocol

from linkwright.geometry.single import (
    Transform,
    Vector3,
    add_vectors,
    axis_and_angle,
    cross,
    quaternion_inverse,
    quaternion_multiply,
    rotate,
    scaled,
    subtract_vectors,
)

_EARLIEST_S = 0.00001


class PoseSource(Protocol):
    """A source of the poses of frames in other frames."""

    def lookup(self, target: str, source: str, time_ns: int) -> tuple[Transform, int]:
        """Return the pose of the source frame in the target frame, and its time in nanoseconds."""


def compute_velocity(
    buffer: PoseSource,
    tracking_frame: str,
    observation_frame: str,
    reference: tuple[str, Vector3, str],
    times_ns: tuple[int, int, int],
) -> tuple[Vector3, Vector3]:
    """Return the linear and angular velocity of a frame, in meters and radians per second.

    Args:
        buffer: provides the poses.
        tracking_frame: the frame that moves.
        observation_frame: the frame in which the movement is observed.
        reference: the frame in which the velocity is expressed, the point to which it refers, and the frame of that
            point.
        times_ns: the time, the latest time for which both frames have transforms, and the interval over which to
            average, in nanoseconds.

    Raises:
        TransformException: there are no poses for these times.
    """
    reference_frame, point, point_frame = reference
    time_s, latest_s, interval_s = (time_ns / 1e9 for time_ns in times_ns)
    end_s = min(time_s + interval_s * 0.5, latest_s)
    start_s = max(_EARLIEST_S + interval_s, end_s) - interval_s
    span_s = end_s - start_s
    start, _ = buffer.lookup(observation_frame, tracking_frame, round(start_s * 1e9))
    end, _ = buffer.lookup(observation_frame, tracking_frame, round(end_s * 1e9))
    axis, angle = axis_and_angle(quaternion_multiply(quaternion_inverse(start[3:]), end[3:]))
    angular_velocity = scaled(rotate(start[3:], axis), angle / span_s)
    linear_velocity = scaled(subtract_vectors(end[:3], start[:3]), 1.0 / span_s)
    tracking_pose, _ = buffer.lookup(reference_frame, tracking_frame, times_ns[0])
    angular = rotate(tracking_pose[3:], angular_velocity)
    linear = add_vectors(rotate(tracking_pose[3:], linear_velocity), cross(tracking_pose[:3], angular))
    point_pose, _ = buffer.lookup(reference_frame, point_frame, times_ns[0])
    delta = subtract_vectors(add_vectors(rotate(point_pose[3:], point), point_pose[:3]), tracking_pose[:3])
    shift = (angular[0] * delta[0], angular[1] * delta[1], angular[2] * delta[2])
    return add_vectors(linear, shift), angular
