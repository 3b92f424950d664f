"""tf2_echo of tf2_ros: prints the transform between two frames periodically."""

from __future__ import annotations

import asyncio
from math import asin, atan2, cos, degrees, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.geometry.arrays import rotation_matrix
from linkwright.graph import Graph, TransformException
from linkwright.graph.time.values import Time
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.listener import TransformListener
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

USAGE = """Usage: tf2_echo source_frame target_frame [echo_rate]

This will echo the transform from the coordinate frame of the source_frame
to the coordinate frame of the target_frame.
Note: This is the transform to get data from target_frame into the source_frame.
Default echo rate is 1 if echo_rate is not given."""

_LATEST = Time()


class Tf2Echo(SingleNode):
    """The running tf2_echo node.

    Raises:
        LinkwrightError: NODE401 if the rate is not a number.
    """

    DEFAULT_NAME = "tf2_echo"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        self._output = options.output
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        if len(arguments) not in (2, 3):
            self._output(USAGE)
            self.finished.set_result(1)
            return
        with handle_start_errors(self._node):
            rate = _parse_rate(arguments[2]) if len(arguments) == 3 else 1.0
        self._source, self._target = arguments[:2]
        self._waiting = True
        self._buffer = BufferCore(logger=self._node.get_logger().get_child("tf2"))
        TransformListener(self._buffer, self._node)
        self._node.create_timer(1.0 / rate, self._print_transform)
        self._print_transform()

    def _print_transform(self) -> None:
        if self._waiting:
            is_possible, reason = self._buffer.can_transform_core(self._source, self._target, _LATEST)
            if not is_possible:
                self._node.get_logger().info(
                    f"Waiting for transform {self._source} ->  {self._target}: {reason}", throttle_duration_sec=1.0
                )
                return
            self._waiting = False
        try:
            transform = self._buffer.lookup_transform_core(self._source, self._target, _LATEST)
        except TransformException as error:
            seconds = self._node.get_clock().now().nanoseconds / 1e9
            frames = self._buffer.all_frames_as_string()
            self._output(
                f"Failure at {seconds:.3f}\nException thrown:{error}\nThe current list of frames is:\n{frames}"
            )
        else:
            self._output(format_transform(transform))


def format_transform(transform: Any) -> str:
    """Format a geometry_msgs/msg/TransformStamped as tf2_echo does."""
    stamp, translation, rotation = transform.header.stamp, transform.transform.translation, transform.transform.rotation
    position = (translation.x, translation.y, translation.z)
    quaternion = (rotation.x, rotation.y, rotation.z, rotation.w)
    matrix = rotation_matrix(quaternion)
    angles = _compute_roll_pitch_yaw(matrix)
    transform_matrix = np.eye(4)
    transform_matrix[:3, :3], transform_matrix[:3, 3] = matrix, position
    return "\n".join(
        [
            # As in tf2_echo, the nanoseconds have no leading zeros.
            f"At time {stamp.sec}.{stamp.nanosec}",
            f"- Translation: [{_join_numbers(position)}]",
            f"- Rotation: in Quaternion (xyzw) [{_join_numbers(quaternion)}]",
            f"- Rotation: in RPY (radian) [{_join_numbers(angles)}]",
            f"- Rotation: in RPY (degree) [{_join_numbers([degrees(angle) for angle in angles])}]",
            "- Matrix:",
            *("".join(f" {value:6.3f}" for value in row) for row in transform_matrix.tolist()),
        ]
    )


def _compute_roll_pitch_yaw(matrix: NDArray[np.float64]) -> tuple[float, float, float]:
    """Return roll, pitch and yaw of a rotation matrix, with the signs of zero as in tf2."""
    (xx, xy, xz), (yx, _, _), (zx, zy, zz) = matrix.tolist()
    if abs(zx) >= 1.0:
        # In gimbal lock, roll and yaw rotate about the same axis, so the whole angle is assigned to roll.
        delta = atan2(xy, xz) if zx < 0.0 else atan2(-xy, -xz)
        return delta, pi / 2.0 if zx < 0.0 else -pi / 2.0, 0.0
    pitch = -asin(zx)
    cos_pitch = cos(pitch)
    return atan2(zy / cos_pitch, zz / cos_pitch), pitch, atan2(yx / cos_pitch, xx / cos_pitch)


def _join_numbers(values: Any) -> str:
    return ", ".join(f"{value:.3f}" for value in values)


def _parse_rate(text: str) -> float:
    try:
        rate = float(text)
    except ValueError:
        rate = 0.0
    if not 0.0 < rate < float("inf"):
        message = phrase("Failed to convert rate argument '{text}' to a floating-point number", text=text)
        raise LinkwrightError(Diagnostic("NODE401", message, hint=phrase("give the rate in hertz, such as 2.0")))
    return rate
