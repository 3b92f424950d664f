"""Tools: what the mouse does in the scene. Which is in hand is the page's own; list and settings are shared."""

from __future__ import annotations

from typing import ClassVar, Literal

from linkwright.viewer.protocol.parts import Property, PropertyValue
from linkwright.viewer.protocol.record import record


@record
class Tool:
    """A tool of the toolbar. `supported` is false for a class that this program does not know; the file keeps it."""

    id: str
    cls: str
    name: str
    supported: bool
    properties: list[Property]


@record
class ToolClass:
    """A class of tools that can be added."""

    cls: str
    name: str


@record
class Tools:
    """The tools in the order of the toolbar, whenever they change; the first is the default one."""

    tools: list[Tool]
    classes: list[ToolClass]
    type: Literal["tools"] = "tools"


@record
class ToolPropertyChanged:
    """One setting of a tool, set by any page; a refused value is answered with the one that stands."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("id",)

    id: str
    value: PropertyValue
    type: Literal["tool_property_changed"] = "tool_property_changed"


@record
class SetToolProperty:
    """The user edited a setting of a tool."""

    id: str
    value: PropertyValue
    type: Literal["set_tool_property"] = "set_tool_property"


@record
class AddTool:
    """Add a tool of a class at the end of the toolbar."""

    cls: str
    type: Literal["add_tool"] = "add_tool"


@record
class RemoveTool:
    """Take a tool out of the toolbar."""

    id: str
    type: Literal["remove_tool"] = "remove_tool"


@record
class PoseChosen:
    """A 2D Pose Estimate or 2D Goal Pose was set in the Fixed Frame: metres, and radians about z."""

    tool: str
    x: float
    y: float
    yaw: float
    type: Literal["pose_chosen"] = "pose_chosen"


@record
class PointChosen:
    """A Publish Point tool was used on a point of the Fixed Frame, metres."""

    tool: str
    x: float
    y: float
    z: float
    type: Literal["point_chosen"] = "point_chosen"
