"""Views for the camera, and tools for the mouse in the scene.

Every page has its own view and selected tool. Pages share the file's view, the saved views, and the list and settings
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
    """A class of views: its property rows and the defaults of RViz.

    The IDs of the rows are the names of values.

    The defaults include values without a row.
    """

    cls: str
    properties: list[Property]
    defaults: dict[str, PropertyValue]


class ViewClasses(ServerMessage):
    """All classes of views, sent before the first view."""

    classes: list[ViewClass]


class ViewState(ServerMessage):
    """The view with which a page shows a configuration. Afterwards the page controls its camera.

    `revision` is the number of configurations opened so far. A page that reconnects keeps its camera if the number has
    not changed. `whole_robot` is whether no user has chosen this view, so that the page fits the camera to the robot.
    """

    view: View
    revision: int
    whole_robot: bool = False


class SavedView(Record):
    """A saved view and its ID.

    The ID does not change when the view is renamed or edited.
    """

    id: str
    view: View


class SavedViews(ServerMessage):
    """The saved views in order, sent after each change."""

    views: list[SavedView]


class ViewChanged(PageMessage):
    """The page's current view, sent at most a few times per second while it changes.

    The last view that any page has sent is stored in the file.
    """

    view: View


class RobotMeasured(PageMessage):
    """The size of the drawn robots, measured by a page whose camera the user has not moved.

    It consists of the diagonal of their bounding box in m, and the height of the ground below them in the Fixed Frame
    in m.
    """

    diagonal: float
    ground: float


class SaveView(PageMessage):
    """A request to add a view to the saved views."""

    view: View


class ChangeSavedView(PageMessage):
    """A request to change the name or the values of a saved view."""

    id: str
    view: View


class RemoveSavedView(PageMessage):
    """A request to remove a saved view."""

    id: str


class Tool(Record):
    """A tool of the toolbar.

    `supported` is false for an unknown class, which is preserved in the file.
    """

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
    """The tools in the order of the toolbar, sent at first and after each change.

    The first tool is the default tool.
    """

    tools: list[Tool]
    classes: list[ToolClass]


class ToolPropertyChanged(ServerMessage):
    """The value of a tool property after any page has set it, or after a value was refused."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("id",)

    id: str
    value: PropertyValue


class SetToolProperty(PageMessage):
    """A property value that the user has entered for a tool."""

    id: str
    value: PropertyValue


class AddTool(PageMessage):
    """A request to add a tool of a class at the end of the toolbar."""

    cls: str


class RemoveTool(PageMessage):
    """A request to remove a tool from the toolbar."""

    id: str


class PoseChosen(PageMessage):
    """A pose that the user has set with a tool such as 2D Goal Pose.

    The pose is in the Fixed Frame, in meters and radians about z.
    """

    tool: str
    x: float
    y: float
    yaw: float


class PointChosen(PageMessage):
    """A point that the user has selected with a Publish Point tool, in the Fixed Frame, meters."""

    tool: str
    x: float
    y: float
    z: float
