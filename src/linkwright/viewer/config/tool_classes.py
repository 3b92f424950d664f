"""RViz's tools: the properties of each class, declared once.

What a tool does with the mouse is the page's: `frontend/src/scene/tools`. Names, topics and defaults are RViz's
(rviz_default_plugins).
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace

from linkwright.viewer.config.property_store import Schema
from linkwright.viewer.config.schema import PropertySpec
from linkwright.viewer.config.topic_properties import topic_spec


@dataclass(frozen=True, slots=True)
class ToolKind:
    """A class of tools.

    Attributes:
        name: on its button, as RViz names it.
        schema: its properties.
        publishes: the type of what it publishes on its ``Topic``; None for one that publishes nothing.
    """

    name: str
    schema: Schema = ()
    publishes: str | None = None


def _topic(default: str, description: str) -> PropertySpec:
    """A Topic to publish to, with its quality of service; any name will do, not only one that is there."""
    return replace(topic_spec(default=default, description=description), kind="string")


TOOL_KINDS: dict[str, ToolKind] = {
    "rviz_default_plugins/Interact": ToolKind(
        "Interact",
        (
            PropertySpec(
                "Hide Inactive Objects",
                "bool",
                True,
                "While an interactive marker is held, those beside it are not shown.",
            ),
        ),
    ),
    "rviz_default_plugins/MoveCamera": ToolKind("Move Camera"),
    "rviz_default_plugins/Select": ToolKind("Select"),
    "rviz_default_plugins/FocusCamera": ToolKind("Focus Camera"),
    "rviz_default_plugins/Measure": ToolKind(
        "Measure", (PropertySpec("Line color", "color", "#808000", "The colour of the measuring line."),)
    ),
    "rviz_default_plugins/SetInitialPose": ToolKind(
        "2D Pose Estimate",
        (
            _topic("/initialpose", "Where pose estimates are published."),
            PropertySpec("Covariance x", "float", 0.25, "Covariance along x, in square metres.", minimum=0.0),
            PropertySpec("Covariance y", "float", 0.25, "Covariance along y, in square metres.", minimum=0.0),
            PropertySpec(
                "Covariance yaw",
                "float",
                (math.pi / 12) ** 2,
                "Covariance of the direction, in square radians.",
                minimum=0.0,
            ),
        ),
        "geometry_msgs/msg/PoseWithCovarianceStamped",
    ),
    "rviz_default_plugins/SetGoal": ToolKind(
        "2D Goal Pose", (_topic("/goal_pose", "Where goals are published."),), "geometry_msgs/msg/PoseStamped"
    ),
    "rviz_default_plugins/PublishPoint": ToolKind(
        "Publish Point",
        (
            _topic("/clicked_point", "Where points are published."),
            PropertySpec("Single click", "bool", True, "One click, and the default tool is in hand again."),
        ),
        "geometry_msgs/msg/PointStamped",
    ),
}
"""The classes in the order of RViz's default toolbar."""


def tool_name(cls: str) -> str:
    """What the button of a tool says: of an unknown class its name with spaces, as RViz does."""
    kind = TOOL_KINDS.get(cls)
    return kind.name if kind else re.sub(r"(?<!^)(?=[A-Z])", " ", cls.rpartition("/")[2])
