"""Views, which are poses of the camera, and tools, which determine how the mouse acts in the scene.

Every page has its own camera and selected tool. Pages share the file's view, the saved views, and the list and settings
of tools. The values of a view are identified by the path of their property: ``Distance``, ``Focal Point/X``.
"""

from __future__ import annotations

from typing import ClassVar

from linkwright.page.protocol.configuration import Property, PropertyValue
from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class View(Record):
    """A view: its RViz class (``rviz_default_plugins/Orbit``), its name, and its values."""

    cls: str
    name: str
    values: dict[str, PropertyValue]


class ViewClass(Record):
    """A type of view: its rows, whose IDs are names of values, and RViz's defaults, including rows not shown."""

    cls: str
    properties: list[Property]
    defaults: dict[str, PropertyValue]


class ViewClasses(ServerMessage):
    """All types of views; sent before the first view."""

    classes: list[ViewClass]


class ViewState(ServerMessage):
    """The view of a configuration; from then on the page controls the camera.

    `revision` counts the configurations that were opened. If it is unchanged, a page that reconnects keeps its camera.
    `whole_robot` is whether no user chose this view: the camera then fits the robot once it is drawn.
    """

    view: View
    revision: int
    whole_robot: bool = False


class SavedView(Record):
    """A saved view and its ID, which does not change when the view is renamed or edited."""

    id: str
    view: View


class SavedViews(ServerMessage):
    """The saved views in order, sent after each change."""

    views: list[SavedView]


class ViewChanged(PageMessage):
    """The page's current camera, sent at most a few times per second; the last one of any page is saved in the file."""

    view: View


class RobotMeasured(PageMessage):
    """The size of the robots with their meshes, measured by a page whose camera the user has not moved.

    It consists of the diagonal of their bounding box, and the height of the ground below them, in the Fixed Frame, m.
    """

    diagonal: float
    ground: float


class SaveView(PageMessage):
    """Add a view to the saved ones."""

    view: View


class ChangeSavedView(PageMessage):
    """Change the name or the values of a saved view."""

    id: str
    view: View


class RemoveSavedView(PageMessage):
    """Remove a saved view."""

    id: str


class Tool(Record):
    """A tool of the toolbar. `supported` is false for an unknown class, which is preserved in the file."""

    id: str
    cls: str
    name: str
    supported: bool
    properties: list[Property]


class ToolClass(Record):
    """A type of tool that can be added."""

    cls: str
    name: str


class Tools(ServerMessage):
    """The tools in the order of the toolbar, sent after each change; the first is the default one."""

    tools: list[Tool]
    classes: list[ToolClass]


class ToolPropertyChanged(ServerMessage):
    """A tool's new setting, set by any page; after a refused value, it contains the current setting."""

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
    """Remove a tool from the toolbar."""

    id: str


class PoseChosen(PageMessage):
    """The user set a 2D Pose Estimate or 2D Goal Pose in the Fixed Frame: metres, and radians about z."""

    tool: str
    x: float
    y: float
    yaw: float


class PointChosen(PageMessage):
    """The user selected a point with a Publish Point tool, in the Fixed Frame, metres."""

    tool: str
    x: float
    y: float
    z: float
