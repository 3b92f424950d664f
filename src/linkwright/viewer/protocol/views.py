"""The camera: every page has its own; what they share is the file's view and the saved ones.

The values of a view are named by the path of their property: ``Distance``, ``Focal Point/X``.
"""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.parts import Property, PropertyValue
from linkwright.viewer.protocol.record import record


@record
class View:
    """A view: RViz's class of it (``rviz_default_plugins/Orbit``), its name, and its values."""

    cls: str
    name: str
    values: dict[str, PropertyValue]


@record
class ViewClass:
    """A class of views: its rows, whose ids are names of values, and RViz's defaults, also of rows not shown."""

    cls: str
    properties: list[Property]
    defaults: dict[str, PropertyValue]


@record
class ViewClasses:
    """All classes of views; comes before the first view."""

    classes: list[ViewClass]
    type: Literal["view_classes"] = "view_classes"


@record
class ViewState:
    """The view of a configuration; the page owns the camera from then on.

    `revision` counts the configurations that were opened: a page that comes back keeps its camera while it is the same.
    """

    view: View
    revision: int
    type: Literal["view_state"] = "view_state"


@record
class SavedView:
    """A saved view and its id, which stays while it is renamed or changed."""

    id: str
    view: View


@record
class SavedViews:
    """The saved views, in their order, whenever they change."""

    views: list[SavedView]
    type: Literal["saved_views"] = "saved_views"


@record
class ViewChanged:
    """The camera as the page has it now, at most a few times a second; the last of any page is saved in the file."""

    view: View
    type: Literal["view_changed"] = "view_changed"


@record
class SaveView:
    """Add a view to the saved ones."""

    view: View
    type: Literal["save_view"] = "save_view"


@record
class ChangeSavedView:
    """Give a saved view another name or other values."""

    id: str
    view: View
    type: Literal["change_saved_view"] = "change_saved_view"


@record
class RemoveSavedView:
    """Take a saved view away."""

    id: str
    type: Literal["remove_saved_view"] = "remove_saved_view"
