"""The display rviz_imu_plugin/Imu."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array, quaternion_multiply, rotate
from linkwright.geometry.single import IDENTITY
from linkwright.rviz.config.schema import FIXED_FRAME, PropertySpec, topic_spec
from linkwright.rviz.displays.message_drawing import Marker, make_marker, make_pose, read_color
from linkwright.rviz.displays.placed_markers import PlacedMarkersDisplay

_BOX, _AXES, _ACCELERATION = "Box properties", "Axes properties", "Acceleration properties"
_FIXED_ORIENTATION = "fixed_frame_orientation"
_AXIS_DIAMETER = 0.2
"""The diameter of an axis, relative to its length."""
_ARROW_PROPORTIONS = (0.1, 0.2, 0.3)
"""The diameters of the shaft and of the head, and the length of the head, relative to the arrow."""
_UNKNOWN_ORIENTATION = -1.0
"""The first element of the covariance, if a sensor does not measure its orientation."""


class ImuDisplay(PlacedMarkersDisplay):
    """A display of an IMU's orientation as a box and as axes, and of its acceleration as an arrow."""

    CLASS = "rviz_imu_plugin/Imu"
    MESSAGE = "sensor_msgs/msg/Imu"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec(
            _FIXED_ORIENTATION,
            "bool",
            True,
            "Whether the orientation is relative to the Fixed Frame, instead of the frame of the message.",
        ),
        PropertySpec(
            _BOX,
            "group",
            children=(
                PropertySpec("Enable box", "bool", False, "Draw a box with the orientation."),
                PropertySpec("x_scale", "float", 1.0, "Length of the box, in meters."),
                PropertySpec("y_scale", "float", 1.0, "Width of the box, in meters."),
                PropertySpec("z_scale", "float", 1.0, "Height of the box, in meters."),
                PropertySpec("Box color", "color", "#ff0000", "Color of the box."),
                PropertySpec("Box alpha", "float", 1.0, "Opacity of the box.", minimum=0.0, maximum=1.0),
            ),
        ),
        PropertySpec(
            _AXES,
            "group",
            children=(
                PropertySpec("Enable axes", "bool", True, "Draw axes with the orientation."),
                PropertySpec("Axes scale", "float", 1.0, "Length of the axes, in meters."),
            ),
        ),
        PropertySpec(
            _ACCELERATION,
            "group",
            children=(
                PropertySpec("Enable acceleration", "bool", False, "Draw the linear acceleration."),
                PropertySpec(
                    "Derotate acceleration",
                    "bool",
                    True,
                    "Whether the acceleration is turned by the orientation of the IMU.",
                ),
                PropertySpec("Acc. vector scale", "float", 1.0, "Length of the arrow of 1 m/s², in meters."),
                PropertySpec("Acc. vector color", "color", "#ffff00", "Color of the arrow."),
                PropertySpec("Acc. vector alpha", "float", 1.0, "Opacity of the arrow.", minimum=0.0, maximum=1.0),
            ),
        ),
    )

    def markers(self, message: Any) -> Iterator[Any]:
        """Return the box, the axes and the arrow that are switched on."""
        written, measured = message.orientation, message.linear_acceleration
        orientation = np.array([written.x, written.y, written.z, written.w], dtype=np.float64)
        acceleration = np.array([measured.x, measured.y, measured.z], dtype=np.float64)
        if not self.is_finite(orientation, acceleration):
            return
        length = float(np.linalg.norm(orientation))
        is_unknown = message.orientation_covariance[0] == _UNKNOWN_ORIENTATION or length == 0.0
        orientation = np.array(IDENTITY[3:]) if is_unknown else orientation / length
        frame = np.array(IDENTITY[3:]) if self.properties.flag(_FIXED_ORIENTATION) else self.frame_pose[3:]
        turned = quaternion_multiply(frame, orientation)
        origin = self.frame_pose[:3]
        is_derotated = self.properties.flag(_ACCELERATION, "Derotate acceleration")
        arrow = rotate(turned if is_derotated else frame, acceleration)
        for marker in (
            *self._make_box(origin, turned),
            *self._make_axes(origin, turned),
            *self._make_arrow(origin, arrow),
        ):
            marker.header.frame_id = FIXED_FRAME
            yield marker

    def _make_box(self, origin: Array, orientation: Array) -> Iterator[Any]:
        if not self.properties.flag(_BOX, "Enable box"):
            return
        pose = make_pose(origin.tolist())
        rotation = pose.orientation
        rotation.x, rotation.y, rotation.z, rotation.w = orientation.tolist()
        color = read_color(self.properties.text(_BOX, "Box color"), self.properties.number(_BOX, "Box alpha"))
        scale = [self.properties.number(_BOX, f"{axis}_scale") for axis in "xyz"]
        yield make_marker("box", 0, Marker.CUBE, color, scale=scale, pose=pose)

    def _make_axes(self, origin: Array, orientation: Array) -> Iterator[Any]:
        length = self.properties.number(_AXES, "Axes scale")
        if not self.properties.flag(_AXES, "Enable axes") or length <= 0:
            return
        for number, axis in enumerate(np.eye(3)):
            ends = [origin, origin + length * rotate(orientation, axis)]
            # An arrow without a head is a cylinder between two points.
            scale = (_AXIS_DIAMETER * length, _AXIS_DIAMETER * length, 1e-3 * length)
            red, green, blue = axis.tolist()
            yield make_marker("axes", number, Marker.ARROW, (red, green, blue, 1.0), scale=scale, points=ends)

    def _make_arrow(self, origin: Array, acceleration: Array) -> Iterator[Any]:
        end = self.properties.number(_ACCELERATION, "Acc. vector scale") * acceleration
        length = float(np.linalg.norm(end))
        if not self.properties.flag(_ACCELERATION, "Enable acceleration") or length == 0.0:
            return
        opacity = self.properties.number(_ACCELERATION, "Acc. vector alpha")
        color = read_color(self.properties.text(_ACCELERATION, "Acc. vector color"), opacity)
        scale = [length * share for share in _ARROW_PROPORTIONS]
        yield make_marker("acceleration", 0, Marker.ARROW, color, scale=scale, points=[origin, origin + end])
