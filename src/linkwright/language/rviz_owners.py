"""The displays, tools, views and options of an RViz configuration, and their properties."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

from linkwright.language.yaml_outline import YamlEntry
from linkwright.loading.extensions import EntryPoint, extensions
from linkwright.rviz.config.former_names import to_modern_class
from linkwright.rviz.config.rviz_config import GLOBAL_OPTIONS
from linkwright.rviz.config.schema import PropertySpec, Schema
from linkwright.rviz.config.tools import TOOL_KINDS
from linkwright.rviz.config.views import VIEW_SCHEMAS

DISPLAY_ENTRY_POINTS = "linkwright.displays"
_LIST_KEYS = ("Displays", "Tools", "Panels", "Saved")
PANEL_NAMES = ("Displays", "Selection", "Tool Properties", "Views", "Time", "Transformation")
OPTIONS = "Global Options"
_DISPLAY_PROPERTIES: Schema = (
    PropertySpec("Class", "string", "", "The class."),
    PropertySpec("Name", "string", "", "The name in the panel."),
    PropertySpec("Enabled", "bool", True, "Whether the display is drawn."),
    PropertySpec("Value", "bool", True, "The same as Enabled."),
)
_TOP_PROPERTIES: Schema = (
    PropertySpec("Panels", "group", description="The panels of the window."),
    PropertySpec("Visualization Manager", "group", description="The displays, tools, views and options."),
    PropertySpec("Window Geometry", "group", description="The size and layout of the window."),
)
_WINDOW_PROPERTIES: Schema = (
    PropertySpec("Height", "int", 846, "The height of the window, in pixels."),
    PropertySpec("Width", "int", 1200, "The width of the window, in pixels."),
    PropertySpec("X", "int", 0, "The left edge of the window, in pixels."),
    PropertySpec("Y", "int", 0, "The upper edge of the window, in pixels."),
    PropertySpec("Hide Left Dock", "bool", False, "Whether the panels on the left are hidden."),
    PropertySpec("Hide Right Dock", "bool", False, "Whether the panels on the right are hidden."),
    PropertySpec("QMainWindow State", "string", "", "The layout of the panels, as Qt writes it."),
    PropertySpec("collapsed", "bool", False, "Whether the panel is hidden."),
    *(PropertySpec(name, "group", description="Whether the panel is hidden.") for name in PANEL_NAMES),
)
_PANEL_PROPERTIES: Schema = (
    PropertySpec("Class", "string", "", "The class."),
    PropertySpec("Name", "string", "", "The name of the panel."),
    PropertySpec("Help Height", "int", 78, "The height of the help, in pixels."),
    PropertySpec("Property Tree Widget", "group", description="The rows that are open, and the width of the columns."),
    PropertySpec("Tree Height", "int", 549, "The height of the tree, in pixels."),
    PropertySpec("Expanded", "group", description="The open rows."),
    PropertySpec("Splitter Ratio", "float", 0.5, "The width of the first column, from 0 to 1."),
    PropertySpec("Experimental", "bool", False, "Whether the panel shows experimental settings."),
    PropertySpec("SyncMode", "int", 0, "How displays are synchronized: 0 for off, 1 for exact, 2 for approximate."),
    PropertySpec("SyncSource", "string", "", "The display that the time follows."),
)
_LINK_PROPERTIES: Schema = (
    PropertySpec("Alpha", "float", 1.0, "Opacity: 0 is invisible.", minimum=0.0, maximum=1.0),
    PropertySpec("Show Axes", "bool", False, "Draw the axes of the link's frame."),
    PropertySpec("Show Trail", "bool", False, "Draw the way of the link's frame."),
    PropertySpec("Value", "bool", True, "Whether it is drawn."),
)
_FRAME_PROPERTIES: Schema = (
    PropertySpec("Frames", "group", description="The frames that are drawn."),
    PropertySpec("Tree", "group", description="The tree of the frames."),
)
_MANAGER_PROPERTIES: Schema = (
    PropertySpec("Displays", "group", description="The displays, in the order in which they are drawn."),
    PropertySpec(OPTIONS, "group", description="The Fixed Frame, the background and the frame rate."),
    PropertySpec("Tools", "group", description="The tools of the toolbar."),
    PropertySpec("Views", "group", description="The current view and the saved ones."),
    PropertySpec("Transformation", "group", description="The plugin that transforms between frames."),
    *_DISPLAY_PROPERTIES,
)


@dataclass(frozen=True, slots=True)
class ConfigOwner:
    """The display, tool, view or options that a position in a configuration belongs to.

    Attributes:
        role: ``Displays``, ``Tools``, ``Views``, ``Panels`` or ``Global Options``, or empty outside of these.
        entry: the entry of the display, tool or view.
        keys: the keys from the entry to the position.
    """

    role: str
    entry: YamlEntry
    keys: tuple[str, ...] = ()

    @property
    def class_name(self) -> str:
        """The class name in RViz 2, or empty if it is missing."""
        class_entry = self.entry.child("Class")
        return "" if class_entry is None else to_modern_class(class_entry.scalar)

    @property
    def schema(self) -> Schema:
        """The properties at the position."""
        if self.role == "Displays" and self.keys[-2:-1] in (("Links",), ("Frames",)):
            return _LINK_PROPERTIES if self.keys[-2] == "Links" else _LINK_PROPERTIES[-1:]
        if self.role == "Displays" and self.keys[-1:] == ("Frames",):
            return (PropertySpec("All Enabled", "bool", True, "Whether all frames are drawn."),)
        specs = self._specs
        for key in self.keys if self.role != "Panels" else ():
            specs = next((spec.children for spec in specs if spec.name == key), ())
        return specs

    @property
    def _specs(self) -> Schema:
        if self.role == OPTIONS:
            return GLOBAL_OPTIONS
        if self.role == "Displays":
            return (*_DISPLAY_PROPERTIES[:2], *display_schema(self.class_name), *_DISPLAY_PROPERTIES[2:])
        if self.role == "Tools":
            tool = TOOL_KINDS.get(self.class_name)
            return (_DISPLAY_PROPERTIES[0], *(() if tool is None else tool.schema))
        if self.role == "Views":
            value = PropertySpec("Value", "string", "", "The class and the package of the view.")
            return (*_DISPLAY_PROPERTIES[:2], *VIEW_SCHEMAS.get(self.class_name, ()), value)
        if self.role == "Panels":
            return _PANEL_PROPERTIES
        if self.entry.parent is None:
            return _TOP_PROPERTIES
        if self.entry.key == "Visualization Manager":
            return _MANAGER_PROPERTIES
        if "Window Geometry" in self.entry.path:
            return _WINDOW_PROPERTIES
        return (PropertySpec("Current", "group"), PropertySpec("Saved", "group")) if self.entry.key == "Views" else ()

    def spec(self, key: str) -> PropertySpec | None:
        """Return the property that a key at the position sets, or None.

        The value of a property with children has the key ``Value``.
        """
        if key == "Value" and self.keys and self.keys[-2:-1] not in (("Links",), ("Frames",)):
            return ConfigOwner(self.role, self.entry, self.keys[:-1]).spec(self.keys[-1])
        return next((spec for spec in self.schema if spec.name == key), None)


def owner_of(entry: YamlEntry) -> ConfigOwner:
    """Return the display, tool, view or group that the content of an entry belongs to."""
    keys: list[str] = []
    current = entry
    while current.parent is not None:
        parent = current.parent
        if current.is_item and parent.key in _LIST_KEYS:
            return ConfigOwner("Views" if parent.key == "Saved" else parent.key, current, tuple(reversed(keys)))
        if current.key == "Current" and parent.key == "Views":
            return ConfigOwner("Views", current, tuple(reversed(keys)))
        if current.key == OPTIONS:
            return ConfigOwner(OPTIONS, current, tuple(reversed(keys)))
        if current.key:
            keys.append(current.key)
        current = parent
    return ConfigOwner("", entry)


def display_class(name: str) -> Any:
    """Return the class of a display, or None if it cannot be imported."""
    entry = extensions(DISPLAY_ENTRY_POINTS).get(name)
    return None if entry is None else _load(entry)


@cache
def _load(entry: EntryPoint) -> Any:
    try:
        return entry.load()
    except Exception:  # noqa: BLE001  # a display of another package may fail in any way
        return None


def load_displays() -> None:
    """Import the classes of displays. The first import is slow."""
    for name in extensions(DISPLAY_ENTRY_POINTS):
        display_class(name)


def display_schema(name: str) -> Schema:
    """Return the properties of a display class, or an empty tuple if it is unknown."""
    schema: Schema = getattr(display_class(name), "SCHEMA", ())
    return (*schema, *_FRAME_PROPERTIES) if name == "rviz_default_plugins/TF" else schema
