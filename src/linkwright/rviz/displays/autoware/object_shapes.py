"""The markers of one object that Autoware detects, tracks or predicts."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array, rotate
from linkwright.messages import get_message
from linkwright.rviz.displays.message_drawing import (
    Marker,
    Rgba,
    compute_yaw,
    list_orientations,
    list_positions,
    make_marker,
    make_pose,
    make_text,
)

_Shape = get_message("autoware_perception_msgs/msg/Shape")
_CIRCLE = 2 * math.pi * np.arange(20) / 20
_TEXT_HEIGHT_M = 0.5
_RED: Rgba = (1.0, 0.0, 0.0, 0.999)
_PINK: Rgba = (1.0, 0.2, 0.4, 0.9)
_ARC_STEPS = 12
_YAW_LENGTH = 0.65
"""The length of the lines of the heading's uncertainty, relative to the object's length."""
_ARC_S = 0.8
"""The radius of the arc of the yaw rate: the distance traveled in this time."""
_FLAT_M = 0.05


@dataclass(frozen=True, slots=True)
class Style:
    """The color of an object, the color of its predicted paths, and the width of lines in meters."""

    color: Rgba
    path_color: Rgba
    line_width: float


class ObjectDrawing:
    """The markers of an object.

    Args:
        number: the ID of the object's markers.
        pose: the geometry_msgs/msg/PoseWithCovariance in the frame of the message.
        shape: the autoware_perception_msgs/msg/Shape.
        style: colors and line width.
        has_heading: whether the front of the object is known and marked.
    """

    def __init__(self, number: int, pose: Any, shape: Any, style: Style, *, has_heading: bool) -> None:
        self._number = number
        self._pose = pose.pose
        self._covariance = np.asarray(pose.covariance, dtype=np.float64).reshape(6, 6)
        self._shape = shape
        self._style = style
        self._has_heading = has_heading

    # --- shape -------------------------------------------------------------------------------------------------

    def shape(self, kind: str, *, footprint: bool) -> Iterator[Any]:
        """Return the shape as edges, as an outline on the ground, or filled."""
        outline = self._outline()
        if len(outline) < 3 or kind == "None":  # fewer corners have no area
            return
        height = self._shape.dimensions.z
        if kind == "Fill":
            yield from self._fill(outline, height)
        else:
            yield self._lines("shape", self._list_edges(outline, height, is_flat=kind == "Skeleton 2D"))
        if footprint and self._shape.type == _Shape.BOUNDING_BOX and len(self._shape.footprint.points) > 1:
            yield self._lines(
                "footprint", _close(_at_height(list_positions(self._shape.footprint.points), -height / 2))
            )

    def _outline(self) -> Array:
        """Return the corners of the shape seen from above, in its own frame, shape (N, 3)."""
        size = self._shape.dimensions
        if self._shape.type == _Shape.POLYGON:
            return _at_height(list_positions(self._shape.footprint.points), 0.0)
        if self._shape.type == _Shape.CYLINDER:
            circle: Array = size.x / 2 * np.stack([np.cos(_CIRCLE), np.sin(_CIRCLE), np.zeros(20)], axis=1)
            return circle
        x, y = size.x / 2, size.y / 2
        return np.array([(x, -y, 0.0), (x, y, 0.0), (-x, y, 0.0), (-x, -y, 0.0)])

    def _list_edges(self, outline: Array, height: float, *, is_flat: bool) -> Array:
        """Return the ends of the edges, two rows for each."""
        bottom, top = _at_height(outline, -height / 2), _at_height(outline, height / 2)
        lines = [_close(bottom)]
        if not is_flat:
            step = 5 if self._shape.type == _Shape.CYLINDER else 1
            lines += [_close(top), np.stack([bottom, top], axis=1)[::step].reshape(-1, 3)]
        if self._has_heading and self._shape.type == _Shape.BOUNDING_BOX:
            size = self._shape.dimensions
            z = -height / 2 if is_flat else height / 2
            front, sides = (size.x / 2, 0.0, z), [(size.x / 4, side * size.y / 2, z) for side in (1, -1)]
            lines.append(np.array([front, sides[0], front, sides[1]]))
        return np.concatenate(lines)

    def _fill(self, outline: Array, height: float) -> Iterator[Any]:
        size = self._shape.dimensions
        if self._shape.type == _Shape.POLYGON:
            bottom, top = _at_height(outline, -height / 2), _at_height(outline, height / 2)
            next_bottom, next_top = np.roll(bottom, -1, axis=0), np.roll(top, -1, axis=0)
            walls = np.stack([bottom, next_bottom, top, top, next_bottom, next_top], axis=1).reshape(-1, 3)
            middle = np.broadcast_to(top.mean(axis=0), top.shape)
            roof = np.stack([middle, top, next_top], axis=1).reshape(-1, 3)
            yield self._marker("shape", Marker.TRIANGLE_LIST, (1, 1, 1), points=np.concatenate([walls, roof]))
            return
        is_box = self._shape.type == _Shape.BOUNDING_BOX
        scale = (size.x, size.y if is_box else size.x, height)
        if all(side > 0 for side in scale):
            yield self._marker("shape", Marker.CUBE if is_box else Marker.CYLINDER, scale)

    # --- texts and paths ---------------------------------------------------------------------------------------

    def text(self, namespace: str, text: str, offset: float) -> Any:
        """Return a text beside the object; the offset is along x and z of the frame, in meters."""
        position = self._pose.position
        place = (position.x + offset, position.y, position.z + offset)
        return make_text(namespace, self._number, text, place, _TEXT_HEIGHT_M, self._style.color)

    def path(self, index: int, poses: Sequence[Any]) -> Any:
        """Return a predicted path as a line at the bottom of the object."""
        line = list_positions([pose.position for pose in poses]) - [0, 0, self._shape.dimensions.z / 2]
        scale, color = (self._style.line_width, 0, 0), self._style.path_color
        return make_marker("path", self._path_number(index), Marker.LINE_STRIP, color, scale=scale, points=line)

    def path_footprint(self, index: int, poses: Sequence[Any]) -> Any:
        """Return the outlines of the object along a predicted path."""
        outline = _close(_at_height(self._outline(), -self._shape.dimensions.z / 2))
        positions, orientations = list_positions([pose.position for pose in poses]), list_orientations(poses)
        lines = positions[:, None] + rotate(orientations[:, None], outline)
        scale, number = (self._style.line_width, 0, 0), self._path_number(index)
        return make_marker(
            "path footprint", number, Marker.LINE_LIST, self._style.path_color, scale=scale, points=lines
        )

    def path_text(self, index: int, end: Any, text: str) -> Any:
        """Return a text at the end of a predicted path."""
        position, number = end.position, self._path_number(index)
        place = (position.x, position.y, position.z)
        return make_text("path confidence", number, text, place, _TEXT_HEIGHT_M, self._style.path_color)

    def _path_number(self, index: int) -> int:
        """Return the ID of a path's markers: an object has fewer than a thousand paths."""
        return 1000 * self._number + index

    # --- velocities and uncertainties --------------------------------------------------------------------------

    def speed(self, twist: Any) -> float:
        """Return the speed of a geometry_msgs/msg/TwistWithCovariance, m/s."""
        linear = twist.twist.linear
        return math.hypot(linear.x, linear.y, linear.z)

    def acceleration(self, acceleration: Any) -> float:
        """Return the magnitude of a geometry_msgs/msg/AccelWithCovariance, m/s²."""
        linear = acceleration.accel.linear
        return math.hypot(linear.x, linear.y, linear.z)

    def twist(self, twist: Any) -> Any:
        """Return the way that the object moves in a second."""
        linear = twist.twist.linear
        return self._lines("twist", np.array([(0.0, 0.0, 0.0), (linear.x, linear.y, linear.z)]), color=_RED)

    def yaw_rate(self, twist: Any) -> Any:
        """Return an arc of the angle that the object turns in a second."""
        start = math.atan2(twist.twist.linear.y, twist.twist.linear.x)
        angles = np.linspace(start, start + twist.twist.angular.z, _ARC_STEPS)
        arc = _ARC_S * self.speed(twist) * _directions(angles)
        line = np.concatenate([np.zeros((1, 3)), arc, np.zeros((1, 3))])
        scale = (0.4 * self._style.line_width, 0, 0)
        return self._marker("yaw rate", Marker.LINE_STRIP, scale, points=line, color=_RED)

    def position_region(self, probability: float) -> Iterator[Any]:
        """Return the ellipse that contains the position with a probability."""
        position = self._pose.position
        place = (position.x, position.y, position.z)
        yield from self._ellipse("position covariance", place, self._covariance, 0.0, probability, (0.8, 0.8, 0.8))

    def twist_region(self, twist: Any, probability: float) -> Iterator[Any]:
        """Return the ellipse that contains the end of the velocity with a probability."""
        yaw, linear, position = compute_yaw(self._pose.orientation), twist.twist.linear, self._pose.position
        x = position.x + linear.x * math.cos(yaw) - linear.y * math.sin(yaw)
        y = position.y + linear.x * math.sin(yaw) + linear.y * math.cos(yaw)
        matrix = np.asarray(twist.covariance, dtype=np.float64).reshape(6, 6)
        yield from self._ellipse("twist covariance", (x, y, position.z), matrix, yaw, probability, (0.2, 0.4, 0.9))

    def yaw_region(self, probability: float) -> Iterator[Any]:
        """Return the headings between which the object's heading is with a probability."""
        deviation = _interval(self._covariance[5, 5], probability)
        if deviation is not None:
            ends = _YAW_LENGTH * self._shape.dimensions.x * _directions(np.array([deviation, -deviation]))
            line = np.array([ends[0], (0.0, 0.0, 0.0), ends[1]])
            scale = (0.5 * self._style.line_width, 0, 0)
            yield self._marker("yaw covariance", Marker.LINE_STRIP, scale, points=line, color=_PINK)

    def yaw_rate_region(self, twist: Any, probability: float) -> Iterator[Any]:
        """Return the angles between which the object turns in a second with a probability."""
        deviation = _interval(float(twist.covariance[35]), probability)
        if deviation is not None:
            middle = math.atan2(twist.twist.linear.y, twist.twist.linear.x) + twist.twist.angular.z
            angles = np.linspace(middle - deviation, middle + deviation, _ARC_STEPS)
            scale = (0.3 * self._style.line_width, 0, 0)
            arc = _ARC_S * self.speed(twist) * _directions(angles)
            yield self._marker("yaw rate covariance", Marker.LINE_STRIP, scale, points=arc, color=_PINK)

    def _ellipse(
        self,
        namespace: str,
        place: tuple[float, float, float],
        matrix: Array,
        turn: float,
        probability: float,
        rgb: tuple[float, float, float],
    ) -> Iterator[Any]:
        """Return the ellipse of a covariance of x and y, which are turned by an angle."""
        if not np.isfinite(matrix[:2, :2]).all():
            return
        variances, vectors = np.linalg.eigh(matrix[:2, :2])
        if (variances <= 0).any():
            return
        # The squared distance of two normal variables from their means has an exponential distribution.
        diameters = 2 * math.sqrt(-2 * math.log(1 - probability)) * np.sqrt(variances)
        angle = turn + math.atan2(vectors[1, 0], vectors[0, 0])
        opacity = min(max(0.1, 3.0 / float(np.prod(np.sqrt(variances)))), 0.5)
        scale = (float(diameters[0]), float(diameters[1]), _FLAT_M)
        pose = make_pose(place, angle)
        yield make_marker(namespace, self._number, Marker.CYLINDER, (*rgb, opacity), scale=scale, pose=pose)

    # --- markers -----------------------------------------------------------------------------------------------

    def _lines(self, namespace: str, points: Array, color: Rgba | None = None) -> Any:
        return self._marker(namespace, Marker.LINE_LIST, (self._style.line_width, 0, 0), points=points, color=color)

    def _marker(
        self, namespace: str, kind: int, scale: Sequence[float], *, points: Any = (), color: Rgba | None = None
    ) -> Any:
        """Return a marker at the pose of the object."""
        return make_marker(
            namespace, self._number, kind, color or self._style.color, scale=scale, pose=self._pose, points=points
        )


def _at_height(points: Array, height: float) -> Array:
    """Return points with another z."""
    return np.column_stack([points[:, :2], np.full(len(points), height)])


def _close(corners: Array) -> Array:
    """Return the ends of the sides of a polygon, two rows for each side."""
    return np.stack([corners, np.roll(corners, -1, axis=0)], axis=1).reshape(-1, 3)


def _directions(angles: Array) -> Array:
    """Return the unit vectors of angles about z, shape (N, 3)."""
    return np.stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))], axis=1)


def _interval(variance: float, probability: float) -> float | None:
    """Return the half width of the interval that contains a normal variable with a probability; None if undefined."""
    if not variance > 0 or not math.isfinite(variance):
        return None
    return NormalDist().inv_cdf((1 + probability) / 2) * math.sqrt(variance)
