"""The camera: every page has its own; what they share is the file's view and the saved ones.

The values of a view are named by the path of their property: ``Distance``, ``Focal Point/X``.
"""

from __future__ import annotations

from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage
from linkwright.viewer.protocol.parts import Property, PropertyValue


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
    """

    view: View
    revision: int


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
