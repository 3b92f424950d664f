"""Views, where the camera is, and tools, what the mouse does in the scene.

Every page has a camera of its own and a tool in hand; what pages share is the file's view, the saved ones, and the list
and settings of tools. The values of a view are named by the path of their property: ``Distance``, ``Focal Point/X``.
"""

from __future__ import annotations

from typing import ClassVar

from linkwright.viewer.protocol.displays import Property, PropertyValue
from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage


class View(Record):
    """A view: RViz's class of it (``rviz_default_plugins/Orbit``), its name, and its values."""

    cls: str
    name: str
    values: dict[str, PropertyValue]


class ViewClass(Record):
    """A class of views: its rows, whose ids are names of values, and RViz's defaults, also of rows not shown."""

    cls: str
    properties: list[Property]
    defaults: dict[str, PropertyValue]


class ViewClasses(ServerMessage):
    """All classes of views; comes before the first view."""

    classes: list[ViewClass]


class ViewState(ServerMessage):
    """The view of a configuration; the page owns the camera from then on.

    `revision` counts the configurations that were opened: a page that comes back keeps its camera while it is the same.
    `whole_robot` says that nobody chose this view: the camera goes where all of the robot is seen, once it is drawn.
    """

    view: View
    revision: int
    whole_robot: bool = False


class SavedView(Record):
    """A saved view and its id, which stays while it is renamed or changed."""

    id: str
    view: View


class SavedViews(ServerMessage):
    """The saved views, in their order, whenever they change."""

    views: list[SavedView]


class ViewChanged(PageMessage):
    """The camera as the page has it now, at most a few times a second; the last of any page is saved in the file."""

    view: View


class RobotMeasured(PageMessage):
    """The extent of robots with their meshes, measured by a page whose camera nobody has moved.

    That is the diagonal of the box around them, and how high the ground is that they stand on, in the Fixed Frame, m.
    """

    diagonal: float
    ground: float


class SaveView(PageMessage):
    """Add a view to the saved ones."""

    view: View


class ChangeSavedView(PageMessage):
    """Give a saved view another name or other values."""

    id: str
    view: View


class RemoveSavedView(PageMessage):
    """Take a saved view away."""

    id: str


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
    """A new setting of a tool, set by any page; a refused value is answered with the present one."""

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
