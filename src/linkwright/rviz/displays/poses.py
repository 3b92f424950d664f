"""The displays Pose, PoseArray, PoseWithCovariance, ParticleCloud, Odometry and Path."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.page.protocol.geometry import ParticleMarks, PoseMarks
from linkwright.page.protocol.message import DataContent, Floats
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import (
    PropertySpec,
    Schema,
    alpha,
    length_spec,
    line_style_spec,
    line_width_spec,
    topic_spec,
    vector_spec,
)
from linkwright.rviz.displays.base.display import DisplayHost
from linkwright.rviz.displays.base.topic_display import RecentDisplay

_IS_ARROW = (("Shape",), "Arrow")
_IS_AXES = (("Shape",), "Axes")


def pose_shape_specs(*, nested: bool = False) -> Schema:
    """Return the declarations of the properties for the shape of a pose.

    With `nested`, the sizes are below ``Shape``, as in Odometry.
    """
    description = "Whether a pose is drawn as an arrow along its x or as axes."
    sizes = (
        PropertySpec("Color", "color", "#ff1900", "Color of the arrow.", when=_IS_ARROW),
        alpha("Opacity of the arrow.", when=_IS_ARROW),
        length_spec("Shaft Length", 1.0, "Length of the arrow's shaft, in meters.", _IS_ARROW),
        length_spec("Shaft Radius", 0.05, "Thickness of the arrow's shaft, in meters.", _IS_ARROW),
        length_spec("Head Length", 0.3, "Length of the arrow's head, in meters.", _IS_ARROW),
        length_spec("Head Radius", 0.1, "Width of the arrow's head, in meters.", _IS_ARROW),
        length_spec("Axes Length", 1.0, "Length of each axis, in meters.", _IS_AXES),
        length_spec("Axes Radius", 0.1, "Thickness of each axis, in meters.", _IS_AXES),
    )
    options = ("Arrow", "Axes")
    if nested:
        return (PropertySpec("Shape", "enum", "Arrow", description, options=options, children=sizes),)
    return (PropertySpec("Shape", "enum", "Arrow", description, options=options), *sizes)


def covariance_spec() -> PropertySpec:
    """Return the declaration of the property group of RViz's CovarianceProperty."""
    position = (
        PropertySpec("Color", "color", "#cc33cc", "Color of the ellipsoid."),
        alpha("Opacity of the ellipsoid.", 0.3),
        PropertySpec("Scale", "float", 1.0, "Size of the ellipsoid, in standard deviations.", minimum=0.0),
    )
    orientation = (
        PropertySpec(
            "Frame",
            "enum",
            "Local",
            "Whether the deviations are about the axes of the pose, or about those of its reference frame.",
            options=("Local", "Fixed"),
        ),
        PropertySpec(
            "Color Style",
            "enum",
            "Unique",
            "One color for all three, or red, green and blue for the rotations about x, y and z.",
            options=("Unique", "RGB"),
        ),
        PropertySpec(
            "Color",
            "color",
            "#ffff7f",
            "Color of the three rotations.",
            when=(("Covariance", "Orientation", "Color Style"), "Unique"),
        ),
        alpha("Opacity of the three rotations.", 0.5),
        PropertySpec(
            "Offset",
            "float",
            1.0,
            "Distance from the pose, in meters; in a plane: length of the triangle.",
            minimum=0.0,
        ),
        PropertySpec("Scale", "float", 1.0, "Size of the three rotations, in standard deviations.", minimum=0.0),
    )
    return PropertySpec(
        "Covariance",
        "bool",
        True,
        "Draw the uncertainty of each pose.",
        children=(
            PropertySpec("Position", "bool", True, "Draw the uncertainty of the position.", children=position),
            PropertySpec("Orientation", "bool", True, "Draw the uncertainty of the orientation.", children=orientation),
        ),
    )


NO_COVARIANCE: Floats = np.zeros(0, dtype=np.float32)

_IS_FLAT_ARROW = (("Shape",), "Arrow (Flat)")
_IS_SOLID_ARROW = (("Shape",), "Arrow (3D)")


def pose_to_row(pose: Any) -> tuple[float, ...]:
    """Return a geometry_msgs/msg/Pose as x, y, z, qx, qy, qz, qw."""
    position, orientation = pose.position, pose.orientation
    return (position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, orientation.w)


def poses_to_rows(poses: Iterable[Any]) -> Floats:
    """Return poses as rows x y z qx qy qz qw, shape (N, 7)."""
    return np.array([pose_to_row(pose) for pose in poses], dtype=np.float32).reshape(-1, 7)


class PoseDisplay(RecentDisplay):
    """A display of the last pose of a topic."""

    CLASS = "rviz_default_plugins/Pose"
    MESSAGE = "geometry_msgs/msg/PoseStamped"
    OCCASIONAL = True
    SCHEMA = (topic_spec(description=MESSAGE, filter_size=10), *pose_shape_specs())

    def content(self, message: Any) -> DataContent | None:
        """Return the pose of a message, or None if it is not valid."""
        pose_values = pose_to_row(message.pose)
        return (
            PoseMarks(np.array([pose_values], dtype=np.float32), NO_COVARIANCE) if self.is_finite(pose_values) else None
        )


class PoseWithCovarianceDisplay(RecentDisplay):
    """A display of the last pose of a topic, with its uncertainty."""

    CLASS = "rviz_default_plugins/PoseWithCovariance"
    MESSAGE = "geometry_msgs/msg/PoseWithCovarianceStamped"
    SCHEMA = (topic_spec(description=MESSAGE, filter_size=10), *pose_shape_specs(), covariance_spec())

    def content(self, message: Any) -> DataContent | None:
        """Return the pose and covariance of a message, or None if they are not valid."""
        pose_values = pose_to_row(message.pose.pose)
        covariance_values = np.asarray(message.pose.covariance, dtype=np.float64)
        if not self.is_finite(pose_values, covariance_values):
            return None
        return PoseMarks(np.array([pose_values], dtype=np.float32), covariance_values.astype(np.float32))


_POSE_PROPERTIES = (
    PropertySpec(
        "Shape",
        "enum",
        "Arrow (Flat)",
        "Whether poses are drawn as arrows of lines, as solid arrows or as axes.",
        options=("Arrow (Flat)", "Arrow (3D)", "Axes"),
    ),
    PropertySpec("Color", "color", "#ff1900", "Color of the arrows."),
    alpha("Opacity of the arrows."),
)


class PoseArrayDisplay(RecentDisplay):
    """A display of the poses in the last message of a topic."""

    CLASS = "rviz_default_plugins/PoseArray"
    MESSAGE = "geometry_msgs/msg/PoseArray"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *_POSE_PROPERTIES,
        length_spec("Arrow Length", 0.3, "Length of the arrows, in meters.", _IS_FLAT_ARROW),
        length_spec("Head Radius", 0.03, "Width of the arrows' heads, in meters.", _IS_SOLID_ARROW),
        length_spec("Head Length", 0.07, "Length of the arrows' heads, in meters.", _IS_SOLID_ARROW),
        length_spec("Shaft Radius", 0.01, "Thickness of the arrows' shafts, in meters.", _IS_SOLID_ARROW),
        length_spec("Shaft Length", 0.23, "Length of the arrows' shafts, in meters.", _IS_SOLID_ARROW),
        length_spec("Axes Length", 0.3, "Length of each axis, in meters.", _IS_AXES),
        length_spec("Axes Radius", 0.01, "Thickness of each axis, in meters.", _IS_AXES),
    )

    def content(self, message: Any) -> DataContent | None:
        """Return the poses of a message, or None if they are not valid."""
        rows = poses_to_rows(message.poses)
        return PoseMarks(rows, NO_COVARIANCE) if self.is_finite(rows) else None


class ParticleCloudDisplay(RecentDisplay):
    """A display of the particles of Nav2's AMCL. More likely particles are larger."""

    CLASS = "nav2_rviz_plugins/ParticleCloud"
    MESSAGE = "nav2_msgs/msg/ParticleCloud"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *_POSE_PROPERTIES,
        length_spec("Min Arrow Length", 0.02, "Length of the arrow of an unlikely pose, in meters."),
        length_spec("Max Arrow Length", 0.3, "Length of the arrow of a certain pose, in meters."),
        PropertySpec(
            "Arrow Height Scale", "float", 5.0, "Height in meters at which a pose of weight 1 is drawn.", minimum=0.0
        ),
    )

    def content(self, message: Any) -> DataContent | None:
        """Return the poses and weights of the particles, or None if they are not valid."""
        rows = poses_to_rows(particle.pose for particle in message.particles)
        weights = np.array([particle.weight for particle in message.particles], dtype=np.float32)
        return ParticleMarks(rows, weights) if self.is_finite(rows, weights) else None


_NORM_TOLERANCE = 10e-3
"""The maximum deviation of a quaternion's squared length from 1."""


class OdometryDisplay(RecentDisplay):
    """A display of a robot's path as a series of marks.

    A mark is added whenever the robot has moved or turned by a tolerance.
    """

    CLASS = "rviz_default_plugins/Odometry"
    MESSAGE = "nav_msgs/msg/Odometry"
    LENGTH = ("Keep",)
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec(
            "Position Tolerance",
            "float",
            0.1,
            "Distance from the last mark at which a new one is drawn, in meters.",
            minimum=0.0,
        ),
        PropertySpec(
            "Angle Tolerance",
            "float",
            0.1,
            "Angle from the last mark at which a new one is drawn, in radians.",
            minimum=0.0,
        ),
        PropertySpec("Keep", "int", 100, "The number of marks that are kept; 0 for all.", minimum=0),
        *pose_shape_specs(nested=True),
        covariance_spec(),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._last_mark: tuple[float, ...] | None = None

    def content(self, message: Any) -> DataContent | None:
        """Return the pose and its covariance, or None.

        None means that the pose is not valid, or too close to the last mark.
        """
        pose_values = pose_to_row(message.pose.pose)
        covariance_values = np.asarray(message.pose.covariance, dtype=np.float64)
        if not self.is_finite(pose_values, covariance_values):
            return None
        if abs(sum(component * component for component in pose_values[3:]) - 1.0) >= _NORM_TOLERANCE:
            self.refuse(phrase("Message contained unnormalized quaternion (squares of values don't add to 1)"))
            return None
        if self._is_near(pose_values):
            return None
        self._last_mark = pose_values
        return PoseMarks(np.array([pose_values], dtype=np.float32), covariance_values.astype(np.float32))

    def reset(self) -> None:
        """Discard the marks, so that the next valid message adds a mark at any distance."""
        self._last_mark = None
        super().reset()

    def _is_near(self, pose_values: tuple[float, ...]) -> bool:
        if self._last_mark is None:
            return False
        cosine = sum(a * b for a, b in zip(self._last_mark[3:], pose_values[3:], strict=True))
        angle = math.acos(min(1.0, max(-1.0, 2.0 * cosine * cosine - 1.0)))
        return math.dist(self._last_mark[:3], pose_values[:3]) < self.properties.number(
            "Position Tolerance"
        ) and angle < self.properties.number("Angle Tolerance")


_SHOWS_AXES = (("Pose Style",), "Axes")
_SHOWS_ARROWS = (("Pose Style",), "Arrows")


class PathDisplay(RecentDisplay):
    """A display of the last paths of a topic as lines, optionally with the poses on them."""

    CLASS = "rviz_default_plugins/Path"
    MESSAGE = "nav_msgs/msg/Path"
    OCCASIONAL = True
    LENGTH = ("Buffer Length",)
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        line_style_spec(),
        line_width_spec(),
        PropertySpec("Color", "color", "#19ff00", "Color of the lines."),
        alpha("Opacity of the lines."),
        PropertySpec("Buffer Length", "int", 1, "The number of paths that are shown.", minimum=1),
        vector_spec("Offset", "Offset of the paths in the Fixed Frame, in meters."),
        PropertySpec("Pose Style", "enum", "None", "The shape of the poses.", options=("None", "Axes", "Arrows")),
        length_spec("Length", 0.3, "Length of each axis, in meters.", _SHOWS_AXES),
        length_spec("Radius", 0.03, "Thickness of each axis, in meters.", _SHOWS_AXES),
        PropertySpec("Pose Color", "color", "#ff55ff", "Color of the arrows.", when=_SHOWS_ARROWS),
        length_spec("Shaft Length", 0.1, "Length of the arrows' shafts, in meters.", _SHOWS_ARROWS),
        length_spec("Head Length", 0.2, "Length of the arrows' heads, in meters.", _SHOWS_ARROWS),
        length_spec("Shaft Diameter", 0.1, "Thickness of the arrows' shafts, in meters.", _SHOWS_ARROWS),
        length_spec("Head Diameter", 0.3, "Width of the arrows' heads, in meters.", _SHOWS_ARROWS),
    )

    def content(self, message: Any) -> DataContent | None:
        """Return the poses of a path, or None if they are not valid."""
        rows = poses_to_rows(stamped_pose.pose for stamped_pose in message.poses)
        return PoseMarks(rows, NO_COVARIANCE) if self.is_finite(rows) else None
