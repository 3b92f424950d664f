"""Tools: what the mouse does in the scene. Which is in hand is the page's own; list and settings are shared."""

from __future__ import annotations

from typing import ClassVar

from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage
from linkwright.viewer.protocol.parts import Property, PropertyValue


class Tool(Record):
    """A tool of the toolbar. `supported` is false for a class that this program does not know; the file keeps it."""

    id: str
    cls: str
    name: str
    supported: bool
    properties: list[Property]


class ToolClass(Record):
    """A class of tools that can be added."""

    cls: str
    name: str


class Tools(ServerMessage):
    """The tools in the order of the toolbar, whenever they change; the first is the default one."""

    tools: list[Tool]
    classes: list[ToolClass]


class ToolPropertyChanged(ServerMessage):
    """One setting of a tool, set by any page; a refused value is answered with the one that stands."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("id",)

    id: str
    value: PropertyValue


class SetToolProperty(PageMessage):
    """The user edited a setting of a tool."""

    id: str
    value: PropertyValue


class AddTool(PageMessage):
    """Add a tool of a class at the end of the toolbar."""

    cls: str


class RemoveTool(PageMessage):
    """Take a tool out of the toolbar."""

    id: str


class PoseChosen(PageMessage):
    """A 2D Pose Estimate or 2D Goal Pose was set in the Fixed Frame: metres, and radians about z."""

    tool: str
    x: float
    y: float
    yaw: float


class PointChosen(PageMessage):
    """A Publish Point tool was used on a point of the Fixed Frame, metres."""

    tool: str
    x: float
    y: float
    z: float
