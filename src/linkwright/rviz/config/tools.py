"""RViz's tools: the properties of each class, and the tools of a .rviz file.

The page implements the mouse actions of each tool, see `frontend/src/scene/tools`. Names, topics and defaults are
the same as in rviz_default_plugins and nav2_rviz_plugins.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, replace

from linkwright.diagnostics import Diagnostic
from linkwright.rviz.config.former_names import get_former_keys, to_modern_class
from linkwright.rviz.config.property_store import PropertyStore
from linkwright.rviz.config.schema import PropertySpec, Schema, topic_spec
from linkwright.rviz.config.yaml_tree import Section, ensure_section, insert_section, new_section, remove_section


@dataclass(frozen=True, slots=True)
class ToolKind:
    """A class of tools.

    Attributes:
        name: the label of its button, as in RViz.
        schema: the declarations of its properties.
        publishes: the type of the messages that the tool publishes on its ``Topic``, or None if it publishes none.
        action: the name and the type of the action to which the tool sends goals, or None.
    """

    name: str
    schema: Schema = ()
    publishes: str | None = None
    action: tuple[str, str] | None = None


def _topic_spec(default: str, description: str) -> PropertySpec:
    """Return the declaration of a topic to publish to, with its QoS.

    The property is a ``string``, because the topic need not exist yet.
    """
    return replace(topic_spec(default=default, description=description), kind="string")


TOOL_KINDS: dict[str, ToolKind] = {
    "rviz_default_plugins/Interact": ToolKind(
        "Interact",
        (
            PropertySpec(
                "Hide Inactive Objects",
                "bool",
                True,
                "Hide the other interactive markers while one is dragged.",
            ),
        ),
    ),
    "rviz_default_plugins/MoveCamera": ToolKind("Move Camera"),
    "rviz_default_plugins/Select": ToolKind("Select"),
    "rviz_default_plugins/FocusCamera": ToolKind("Focus Camera"),
    "rviz_default_plugins/Measure": ToolKind(
        "Measure", (PropertySpec("Line color", "color", "#808000", "The color of the measuring line."),)
    ),
    "rviz_default_plugins/SetInitialPose": ToolKind(
        "2D Pose Estimate",
        (
            _topic_spec("/initialpose", "The topic to publish pose estimates to."),
            PropertySpec("Covariance x", "float", 0.25, "Covariance along x, in square meters.", minimum=0.0),
            PropertySpec("Covariance y", "float", 0.25, "Covariance along y, in square meters.", minimum=0.0),
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
        "2D Goal Pose", (_topic_spec("/goal_pose", "The topic to publish goals to."),), "geometry_msgs/msg/PoseStamped"
    ),
    "rviz_default_plugins/PublishPoint": ToolKind(
        "Publish Point",
        (
            _topic_spec("/clicked_point", "The topic to publish points to."),
            PropertySpec("Single click", "bool", True, "Return to the default tool after one click."),
        ),
        "geometry_msgs/msg/PointStamped",
    ),
    "nav2_rviz_plugins/GoalTool": ToolKind("Nav2 Goal", action=("navigate_to_pose", "nav2_msgs/action/NavigateToPose")),
}
"""The tools of RViz in the order of its default toolbar, followed by the tools of other packages, by class."""

DEFAULT_TOOLS = tuple(cls for cls in TOOL_KINDS if cls.startswith("rviz_default_plugins/"))
"""The classes of the tools that are shown if a file lists no tools."""


def get_tool_name(cls: str) -> str:
    """Return the label of a tool's button.

    As in RViz, an unknown class is labeled with its class name, split into words.
    """
    kind = TOOL_KINDS.get(cls)
    return kind.name if kind else re.sub(r"(?<!^)(?=[A-Z])", " ", cls.rpartition("/")[2])


_MANAGER = "Visualization Manager"
_TOOLS = "Tools"

MAX_TOOLS = 100
"""The maximum number of tools. Each tool may create a publisher, so pages cannot add any number of them."""


@dataclass(frozen=True, slots=True)
class ToolEntry:
    """An entry of ``Tools``.

    Attributes:
        id: an ID that is stable while the file is open.
        cls: the class name of the tool in RViz 2, even if the file contains the RViz 1 name.
        section: the tool's section of the file, which remains unchanged if the class is unknown.
        properties: the values of the tool's properties.
    """

    id: str
    cls: str
    section: Section
    properties: PropertyStore


class ToolsConfig:
    """The ``Tools`` of a file, or RViz's default tools if the file lists none.

    Args:
        document: the file.
        report: called with findings about values that cannot be used.
    """

    def __init__(self, document: Section, report: Callable[[Diagnostic], None]) -> None:
        self._document = document
        self._report = report
        self._count = 0
        self._entries: dict[str, ToolEntry] = {}
        for section in document.sections(_MANAGER, _TOOLS):
            scalar = section.scalar("Class")
            if scalar is not None:
                self._append_entry(scalar.text, section)
        self._is_listed_in_file = bool(self._entries)
        if not self._entries:
            for cls in DEFAULT_TOOLS:
                self._append_entry(cls, self._make_section(cls))

    @property
    def entries(self) -> list[ToolEntry]:
        """The tools, in the order of the toolbar."""
        return list(self._entries.values())

    def find(self, identity: str) -> ToolEntry | None:
        """Return the tool with an ID, or None if there is no such tool."""
        return self._entries.get(identity)

    def add(self, cls: str) -> ToolEntry:
        """Add a tool of a class at the end, write it to the file, and return it.

        Raises:
            ValueError: there is no such class, or there are `MAX_TOOLS` tools already.
        """
        if len(self._entries) >= MAX_TOOLS:
            raise ValueError(f"there are already {MAX_TOOLS} tools, the maximum")
        if cls not in TOOL_KINDS:
            raise ValueError(f"there is no tool class {cls!r}")
        self.write_defaults()
        section = self._make_section(cls)
        insert_section(self._get_manager(), _TOOLS, section)
        return self._append_entry(cls, section)

    def remove(self, identity: str) -> ToolEntry:
        """Remove a tool and return it.

        Raises:
            KeyError: there is no such tool.
        """
        entry = self._entries[identity]
        self.write_defaults()
        del self._entries[identity]
        remove_section(self._get_manager(), _TOOLS, entry.section)
        return entry

    def write_defaults(self) -> None:
        """Write the default tools to the file if it lists no tools.

        Call this before changing a tool.
        """
        if not self._is_listed_in_file:
            for entry in self._entries.values():
                insert_section(self._get_manager(), _TOOLS, entry.section)
        self._is_listed_in_file = True

    def _get_manager(self) -> Section:
        return ensure_section(self._document, _MANAGER)

    def _make_section(self, cls: str) -> Section:
        section = new_section(self._document.source)
        section.put(("Class",), cls, string=True)
        return section

    def _append_entry(self, written_class: str, section: Section) -> ToolEntry:
        """Append a tool to the entries and return it, given its class name of RViz 1 or RViz 2."""
        cls = to_modern_class(written_class)
        self._count += 1
        identity = f"tool-{self._count}"
        schema: Schema = TOOL_KINDS[cls].schema if cls in TOOL_KINDS else ()
        store = PropertyStore(identity, section, lambda: schema, self._report, former=get_former_keys(written_class))
        entry = ToolEntry(identity, cls, section, store)
        self._entries[identity] = entry
        return entry
