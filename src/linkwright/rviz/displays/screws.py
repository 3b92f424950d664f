"""The displays TwistStamped, AccelStamped and Wrench: a linear and an angular vector."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Any

from linkwright.page.protocol.geometry import Screw
from linkwright.page.protocol.message import DataContent
from linkwright.rviz.config.schema import PropertySpec, Schema, alpha, topic_spec
from linkwright.rviz.displays.base.topic_display import RecentDisplay


def _screw_specs(linear: str, angular: str) -> Schema:
    return (
        PropertySpec(f"{linear} Color", "color", "#cc3333", f"Color of the {linear.lower()} arrows."),
        PropertySpec(f"{angular} Color", "color", "#cccc33", f"Color of the {angular.lower()} arrows."),
        alpha(),
        PropertySpec(f"{linear} Arrow Scale", "float", 2.0, f"Meters for each unit of the {linear.lower()} vector."),
        PropertySpec(f"{angular} Arrow Scale", "float", 2.0, f"Meters for each unit of the {angular.lower()} vector."),
        PropertySpec("Arrow Width", "float", 0.5, "Width of the arrows, in meters."),
        PropertySpec("History Length", "int", 1, "The number of messages that are shown.", minimum=1, maximum=100000),
    )


class ScrewDisplay(RecentDisplay):
    """The base class of displays of a linear and an angular vector.

    Both are drawn as arrows at the frame's origin.
    """

    LENGTH = ("History Length",)

    def content(self, message: Any) -> DataContent | None:
        """Return the linear and the angular vector of a message, or None if a number is not finite."""
        linear, angular = (self.number_list(vector) for vector in self.vectors(message))
        return Screw(linear, angular) if self.is_finite(linear, angular) else None

    @abstractmethod
    def vectors(self, message: Any) -> tuple[Any, Any]:
        """Return the linear and the angular vector of a message, as geometry_msgs/msg/Vector3."""

    def number_list(self, vector: Any) -> list[float]:
        """Return x, y and z of a geometry_msgs/msg/Vector3."""
        return [float(vector.x), float(vector.y), float(vector.z)]


class TwistDisplay(ScrewDisplay):
    """A display of linear and angular velocities."""

    CLASS = "rviz_default_plugins/TwistStamped"
    MESSAGE = "geometry_msgs/msg/TwistStamped"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *_screw_specs("Linear", "Angular"),
        PropertySpec("Hide Small Values", "bool", True, "Do not draw arrows that are shorter than their width."),
    )

    def vectors(self, message: Any) -> tuple[Any, Any]:
        """Return the linear and the angular velocity."""
        return message.twist.linear, message.twist.angular


class AccelDisplay(ScrewDisplay):
    """A display of linear and angular accelerations."""

    CLASS = "rviz_default_plugins/AccelStamped"
    MESSAGE = "geometry_msgs/msg/AccelStamped"
    SCHEMA = (topic_spec(description=MESSAGE, filter_size=10), *TwistDisplay.SCHEMA[1:])

    def vectors(self, message: Any) -> tuple[Any, Any]:
        """Return the linear and the angular acceleration."""
        return message.accel.linear, message.accel.angular


class WrenchDisplay(ScrewDisplay):
    """A display of forces and torques."""

    CLASS = "rviz_default_plugins/Wrench"
    MESSAGE = "geometry_msgs/msg/WrenchStamped"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec("Accept NaN Values", "bool", False, "Use 0 for invalid numbers."),
        *_screw_specs("Force", "Torque"),
    )

    def vectors(self, message: Any) -> tuple[Any, Any]:
        """Return the force and the torque."""
        return message.wrench.force, message.wrench.torque

    def number_list(self, vector: Any) -> list[float]:
        """Return x, y and z, with NaN replaced by 0 if the property is set."""
        numbers = super().number_list(vector)
        if not self.properties.flag("Accept NaN Values"):
            return numbers
        return [0.0 if math.isnan(number) else number for number in numbers]
