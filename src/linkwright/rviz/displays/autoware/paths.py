"""The displays of Autoware's paths and trajectories: a band, velocities, footprints and points."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array, rotate
from linkwright.rviz.config.schema import PropertySpec, Schema, alpha, length_spec, topic_spec
from linkwright.rviz.displays.marker import MessageMarkersDisplay
from linkwright.rviz.displays.message_drawing import (
    Marker,
    list_orientations,
    list_positions,
    make_marker,
    make_text,
    read_color,
)

_BAND, _VELOCITY, _FOOTPRINT, _POINT = "View Path", "View Velocity", "View Footprint", "View Point"
_VELOCITY_TEXT, _SLOPE_TEXT, _AREA, _LANES = (
    "View Text Velocity",
    "View Text Slope",
    "View Drivable Area",
    "View LaneId",
)
_CONSTANT_WIDTH, _CONSTANT_COLOR = "Constant Width", "Constant Color"
_MAX_VELOCITY = "Color Border Vel Max"
_LINE_WIDTH_M = 0.05
_CIRCLE = 2 * np.pi * np.arange(9) / 8
_WHITE = (1.0, 1.0, 1.0, 1.0)


def _text_spec(name: str, shown: bool, scale: float, description: str) -> PropertySpec:
    return PropertySpec(
        name, "bool", shown, description, children=(length_spec("Scale", scale, "Height of the texts, in meters."),)
    )


_VELOCITY_COLORS = (
    PropertySpec("Min Velocity Color", "color", "#3f2ee3", "Color at standstill."),
    PropertySpec("Mid Velocity Color", "color", "#208aae", "Color at half of Color Border Vel Max."),
    PropertySpec("Max Velocity Color", "color", "#00e678", "Color from Color Border Vel Max on."),
)

_PATH_SCHEMA: Schema = (
    PropertySpec(
        _BAND,
        "bool",
        True,
        "Draw a band whose color shows the velocity.",
        children=(
            PropertySpec(_CONSTANT_WIDTH, "bool", False, "Use Width instead of the width of the vehicle."),
            PropertySpec("Width", "float", 2.0, "Width of the band, in meters.", minimum=0.0),
            alpha("Opacity of the band."),
            *_VELOCITY_COLORS,
            PropertySpec(
                "Fade Out Distance", "float", 0.0, "Length of the end that fades out, in meters.", minimum=0.0
            ),
        ),
    ),
    PropertySpec(_MAX_VELOCITY, "float", 3.0, "Velocity of Max Velocity Color, in m/s.", minimum=0.0),
    PropertySpec(
        _VELOCITY,
        "bool",
        True,
        "Draw the velocity as the height of a line.",
        children=(
            alpha("Opacity of the line."),
            PropertySpec("Scale", "float", 0.3, "Height of 1 m/s, in meters.", minimum=0.1, maximum=10.0),
            PropertySpec(_CONSTANT_COLOR, "bool", False, "Use Color instead of the colors of the velocity."),
            PropertySpec("Color", "color", "#000000", "Color of the line."),
        ),
    ),
    _text_spec(_VELOCITY_TEXT, False, 0.3, "Write the velocity at each point, in m/s."),
    PropertySpec(
        _FOOTPRINT,
        "bool",
        False,
        "Draw the outline of the vehicle at each point.",
        children=(
            alpha("Opacity of the outlines."),
            PropertySpec("Color", "color", "#e6e632", "Color of the outlines."),
            PropertySpec("Vehicle Length", "float", 4.77, "Length of the vehicle, in meters.", minimum=0.0),
            PropertySpec("Vehicle Width", "float", 1.83, "Width of the vehicle, in meters.", minimum=0.0),
            PropertySpec("Rear Overhang", "float", 1.03, "Distance from the rear axle to the rear.", minimum=0.0),
            length_spec("Offset from BaseLink", 0.0, "Distance by which the outlines are shorter, in meters."),
        ),
    ),
    PropertySpec(
        _POINT,
        "bool",
        False,
        "Draw each point as a disk.",
        children=(
            alpha("Opacity of the disks."),
            PropertySpec("Color", "color", "#003cff", "Color of the disks."),
            length_spec("Radius", 0.1, "Radius of the disks, in meters."),
            length_spec("Offset", 0.0, "Distance of the disks ahead of their points, in meters."),
        ),
    ),
    _text_spec(_SLOPE_TEXT, False, 0.3, "Write the slope at each point, in radians."),
)

_AREA_SPEC = PropertySpec(
    _AREA,
    "bool",
    True,
    "Draw the bounds of the drivable area.",
    children=(
        alpha("Opacity of the bounds.", 0.999),
        PropertySpec("Color", "color", "#0094cd", "Color of the bounds."),
        length_spec("Width", 0.3, "Width of the lines, in meters."),
    ),
)


class TrajectoryDisplay(MessageMarkersDisplay):
    """A display of trajectories, whose points have times."""

    CLASS = "rviz_plugins/Trajectory"
    MESSAGE = "autoware_planning_msgs/msg/Trajectory"
    OCCASIONAL = True
    SCHEMA = (topic_spec(description=MESSAGE), *_PATH_SCHEMA)

    def path_points(self, message: Any) -> Sequence[Any]:
        """Return the points of a message, which have a pose and a velocity."""
        return list(message.points)

    def markers(self, message: Any) -> Iterator[Any]:
        """Return the parts that are switched on."""
        points = self.path_points(message)
        positions = list_positions([point.pose.position for point in points])
        orientations = list_orientations([point.pose for point in points])
        velocities = np.array([point.longitudinal_velocity_mps for point in points], dtype=np.float64)
        if not self.is_finite(positions, orientations, velocities) or not points:
            return
        if self.properties.flag(_BAND) and len(points) > 1:
            yield self._make_band(positions, orientations, velocities)
        if self.properties.flag(_VELOCITY) and len(points) > 1:
            yield self._make_velocity_line(positions, velocities)
        if self.properties.flag(_FOOTPRINT):
            yield self._make_footprints(positions, orientations)
        if self.properties.flag(_POINT):
            yield self._make_disks(positions, orientations)
        yield from self._make_texts(positions, velocities)

    def _make_band(self, positions: Array, orientations: Array, velocities: Array) -> Any:
        is_constant = self.properties.flag(_BAND, _CONSTANT_WIDTH)
        width = self._number(_BAND, "Width") if is_constant else self._number(_FOOTPRINT, "Vehicle Width")
        sides = rotate(orientations, [0.0, width / 2, 0.0])
        left, right = positions + sides, positions - sides
        colors = self._color_velocities(velocities, self._number(_BAND, "Alpha") * self._fade(positions))
        corners = np.stack([right[:-1], left[:-1], right[1:], right[1:], left[:-1], left[1:]], axis=1)
        rows = np.stack([colors[:-1], colors[:-1], colors[1:], colors[1:], colors[:-1], colors[1:]], axis=1)
        return make_marker("path", 0, Marker.TRIANGLE_LIST, _WHITE, scale=(1, 1, 1), points=corners, colors=rows)

    def _make_velocity_line(self, positions: Array, velocities: Array) -> Any:
        line = positions + np.outer(velocities * self._number(_VELOCITY, "Scale"), [0.0, 0.0, 1.0])
        opacity = self._number(_VELOCITY, "Alpha")
        colors = self._color_velocities(velocities, np.full(len(line), opacity))
        if self.properties.flag(_VELOCITY, _CONSTANT_COLOR):
            colors[:] = read_color(self.properties.text(_VELOCITY, "Color"), opacity)
        scale = (_LINE_WIDTH_M, 0, 0)
        return make_marker("velocity", 0, Marker.LINE_STRIP, _WHITE, scale=scale, points=line, colors=colors)

    def _make_footprints(self, positions: Array, orientations: Array) -> Any:
        length, width, rear, offset = (
            self._number(_FOOTPRINT, name)
            for name in ("Vehicle Length", "Vehicle Width", "Rear Overhang", "Offset from BaseLink")
        )
        front, back = length - rear - offset, -rear + offset
        half = width / 2
        corners = [(front, -half, 0), (front, half, 0), (back, half, 0), (back, -half, 0)]
        edges = [corner for i in range(4) for corner in (corners[i], corners[(i + 1) % 4])]
        lines = positions[:, None] + rotate(orientations[:, None], np.array(edges, dtype=np.float64))
        color = read_color(self.properties.text(_FOOTPRINT, "Color"), self._number(_FOOTPRINT, "Alpha"))
        return make_marker("footprint", 0, Marker.LINE_LIST, color, scale=(_LINE_WIDTH_M, 0, 0), points=lines)

    def _make_disks(self, positions: Array, orientations: Array) -> Any:
        centers = positions + rotate(orientations, [self._number(_POINT, "Offset"), 0.0, 0.0])
        radius = self._number(_POINT, "Radius")
        ring = radius * np.stack([np.cos(_CIRCLE), np.sin(_CIRCLE), np.zeros(9)], axis=1)
        fan = np.stack([np.zeros((8, 3)), ring[:-1], ring[1:]], axis=1).reshape(-1, 3)
        color = read_color(self.properties.text(_POINT, "Color"), self._number(_POINT, "Alpha"))
        disks = centers[:, None] + fan
        return make_marker("points", 0, Marker.TRIANGLE_LIST, color, scale=(1, 1, 1), points=disks)

    def _make_texts(self, positions: Array, velocities: Array) -> Iterator[Any]:
        if self.properties.flag(_VELOCITY_TEXT):
            height = self._number(_VELOCITY_TEXT, "Scale")
            for i, (position, velocity) in enumerate(zip(positions.tolist(), velocities, strict=True)):
                yield make_text("velocity text", i, f"{velocity:.2f}", position, height, _WHITE)
        if self.properties.flag(_SLOPE_TEXT) and len(positions) > 1:
            steps = np.diff(positions, axis=0)
            slopes = np.arctan2(steps[:, 2], np.hypot(steps[:, 0], steps[:, 1]))
            height = self._number(_SLOPE_TEXT, "Scale")
            for i, (position, slope) in enumerate(zip(positions.tolist(), [*slopes, slopes[-1]], strict=True)):
                yield make_text("slope text", i, f"{slope:.2f}", position, height, _WHITE)

    def _color_velocities(self, velocities: Array, opacities: Array) -> Array:
        """Return the colors of velocities with their opacities, shape (N, 4)."""
        names = [spec.name for spec in _VELOCITY_COLORS]
        stops = np.array([read_color(self.properties.text(_BAND, name)) for name in names])
        maximum = max(self._number(_MAX_VELOCITY), 1e-9)
        channels = [np.interp(np.abs(velocities), [0, maximum / 2, maximum], stops[:, i]) for i in range(3)]
        return np.stack([*channels, opacities], axis=1)

    def _fade(self, positions: Array) -> Array:
        """Return the share of the opacity at each point, which falls to 0 at the end."""
        distance = self._number(_BAND, "Fade Out Distance")
        if distance <= 0:
            return np.ones(len(positions))
        steps = np.hypot(*np.diff(positions[:, :2], axis=0).T)
        rest = np.append(np.cumsum(steps[::-1])[::-1], 0.0)
        return np.minimum(rest / distance, 1.0)

    def _number(self, *path: str) -> float:
        return self.properties.number(*path)


class PathDisplay(TrajectoryDisplay):
    """A display of paths, with the bounds of the drivable area."""

    CLASS = "rviz_plugins/Path"
    MESSAGE = "autoware_planning_msgs/msg/Path"
    SCHEMA = (topic_spec(description=MESSAGE), *_PATH_SCHEMA, _AREA_SPEC)

    def markers(self, message: Any) -> Iterator[Any]:
        """Return the parts that are switched on."""
        yield from super().markers(message)
        if not self.properties.flag(_AREA):
            return
        color = read_color(self.properties.text(_AREA, "Color"), self._number(_AREA, "Alpha"))
        scale = (self._number(_AREA, "Width"), 0, 0)
        for i, bound in enumerate((message.left_bound, message.right_bound)):
            if len(bound) > 1:
                line = list_positions(bound)
                yield make_marker("drivable area", i, Marker.LINE_STRIP, color, scale=scale, points=line)


class PathWithLaneIdDisplay(PathDisplay):
    """A display of paths with the numbers of the lanes."""

    CLASS = "rviz_plugins/PathWithLaneId"
    MESSAGE = "autoware_internal_planning_msgs/msg/PathWithLaneId"
    SCHEMA = (
        topic_spec(description=MESSAGE),
        *_PATH_SCHEMA,
        _AREA_SPEC,
        _text_spec(_LANES, True, 0.1, "Write the numbers of the lanes at each point."),
    )

    def path_points(self, message: Any) -> Sequence[Any]:
        """Return the points without the numbers of their lanes."""
        return [point.point for point in message.points]

    def markers(self, message: Any) -> Iterator[Any]:
        """Return the parts that are switched on."""
        yield from super().markers(message)
        if not self.properties.flag(_LANES):
            return
        height = self._number(_LANES, "Scale")
        for i, point in enumerate(message.points):
            position = point.point.pose.position
            text = ", ".join(map(str, point.lane_ids))
            yield make_text("lanes", i, text, (position.x, position.y, position.z), height, _WHITE)
