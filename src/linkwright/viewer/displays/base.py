"""What every display has: an enable box, properties, status rows, and what it is told."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from linkwright.diagnostics import Diagnostic
from linkwright.graph import Node
from linkwright.urdf import DescriptionLibrary
from linkwright.viewer.former_names import former_keys
from linkwright.viewer.frame_history import FrameHistory
from linkwright.viewer.frame_view import FrameView
from linkwright.viewer.mesh_files import MeshFolders
from linkwright.viewer.outbox import Payload
from linkwright.viewer.property_store import Path, PropertyStore, Schema
from linkwright.viewer.protocol import (
    Display,
    DisplayProperties,
    DisplayStatus,
    PropertyChanged,
    ServerMessage,
    StatusLevel,
    StatusRow,
)
from linkwright.viewer.rviz_config import DisplayConfig
from linkwright.viewer.schema import FIXED_FRAME
from linkwright.viewer.time_control import TimeControl
from linkwright.viewer.yaml_tree import Memory
from linkwright.workspace import PackageFinder

_RANK: dict[StatusLevel, int] = {"ok": 0, "warn": 1, "error": 2}


def worst(rows: list[StatusRow]) -> StatusLevel:
    """The level that a display's own row shows: the worst of its status rows."""
    return max((row.level for row in rows), key=_RANK.__getitem__, default="ok")


@dataclass(slots=True)
class Stage:
    """What displays work with.

    Attributes:
        node: the viewer's node, to subscribe and to log with.
        library: reads descriptions, each once for the whole process.
        finder: finds packages.
        meshes: the folders that pages may read from.
        publish: sends a message to every page.
        send_data: sends what a display draws to every page; what waits under the same key is dropped.
        history: where frames were, to place messages with.
        robot_changed: told of a new robot, with the frames that only the one before had.
        report: shows a finding in the terminal.
        frames: the frames now.
        time: how time goes.
    """

    node: Node
    library: DescriptionLibrary
    finder: PackageFinder
    meshes: MeshFolders
    publish: Callable[[ServerMessage], None]
    send_data: Callable[[str, Payload], None]
    history: FrameHistory
    robot_changed: Callable[[set[str]], None]
    report: Callable[[Diagnostic], None]
    frames: FrameView
    time: TimeControl


class ViewerDisplay:
    """A display of the Displays panel.

    A class of display says its RViz class and its properties, and overrides what it must know of: start and stop,
    values set, frames changed.

    Args:
        stage: what it works with.
        identity: its id in the page, stable for its life.
        config: its entry of the .rviz file.
    """

    CLASS: ClassVar[str]
    SCHEMA: ClassVar[Schema] = ()
    SUPPORTED: ClassVar[bool] = True
    TOPIC: ClassVar[Path] = ("Topic",)
    """The property that takes the topic when a display is added for one."""

    def __init__(self, stage: Stage, identity: str, config: DisplayConfig) -> None:
        self.stage = stage
        self.id = identity
        self.config = config
        self.properties = PropertyStore(
            identity,
            config.section,
            self.schema,
            stage.report,
            frames=self._reference_frames,
            former=former_keys(config.written_class),
        )
        self.status: list[StatusRow] = []

    @classmethod
    def messages_shown(cls) -> tuple[str, ...]:
        """The types of the topics that it can be added for."""
        message: str = getattr(cls, "MESSAGE", "")
        return (message,) if message else ()

    @classmethod
    def topic_value(cls, topic: str) -> str:
        """The value of the property `TOPIC` that shows a topic."""
        return topic

    @property
    def enabled(self) -> bool:
        """Whether it is drawn: its box and those of the groups around it are on."""
        return self.config.enabled

    def schema(self) -> Schema:
        """The properties as they are now."""
        return self.SCHEMA

    def row(self) -> Display:
        """The display as the page shows it."""
        return Display(
            id=self.id,
            cls=self.config.cls,
            name=self.config.name,
            group=self.config.group.identity if self.config.group else None,
            enabled=self.config.checked,
            supported=self.SUPPORTED,
            level=worst(self.status),
            status=self.status,
            properties=self.properties.rows(),
        )

    def set_property(self, path: Path, value: object) -> None:
        """Take a value from a page, tell all pages, and act on it.

        Raises:
            ValueError: when the property takes no such value.
        """
        taken = self.properties.set(path, value)
        self.changed(path)
        if self.properties.is_condition(path):
            self.publish_properties()
        self.stage.publish(PropertyChanged(self.property_id(path), taken))

    def set_checked(self, value: bool) -> None:
        """Take a new state of the enable box, and tell all pages; `enabled_changed` comes after."""
        self.config.checked = value
        self.stage.publish(PropertyChanged(f"{self.id}/Enabled", value))

    def recall(self, memories: Sequence[Memory]) -> None:
        """Have the file say of properties what it said, tell all pages, and act on it."""
        for path in self.properties.recall(memories):
            self.changed(path)
        self.properties.recall(memories)  # what was set together with a property was recalled with it
        self.recalled()
        self.publish_properties()

    def property_id(self, path: Path) -> str:
        """The id of one of its properties."""
        return self.properties.identity(path)

    def publish_properties(self) -> None:
        """Send the property rows anew."""
        self.stage.publish(DisplayProperties(self.id, self.properties.rows()))

    def set_status(self, rows: list[StatusRow]) -> None:
        """Show status rows, none while the display is off; pages hear of it only when they differ."""
        if not self.enabled:
            rows = []
        if rows != self.status:
            self.status = rows
            self.stage.publish(DisplayStatus(self.id, worst(rows), rows))

    def _reference_frames(self) -> list[str]:
        return [FIXED_FRAME, *sorted(self.stage.frames.names)]

    def start(self) -> None:
        """Begin: subscribe, read files."""

    def stop(self) -> None:
        """End for good."""

    def changed(self, path: Path) -> None:
        """A property has a new value."""

    def recalled(self) -> None:
        """Values are what they were, and `changed` was called for each: what follows from them may follow anew."""

    def enabled_changed(self) -> None:
        """Its enable box was set, or that of a group around it."""
        self.frames_changed()

    def arranged(self, displays: Sequence[ViewerDisplay]) -> None:
        """Displays came, went, moved or have other names: these there are now, each group before what is in it."""

    def frames_changed(self) -> None:
        """Frames came or went, or can be placed now or no more, or the Fixed Frame is another."""

    def receive(self, message: Any) -> None:
        """Take what a page says of this display alone: how a mesh loaded, what was done to a marker."""

    def time_changed(self) -> None:
        """Time stands still, goes on, or is led by other messages."""

    def time_reset(self) -> None:
        """Time begins anew: what messages said before counts no more."""

    def messages(self) -> list[ServerMessage]:
        """What a page must be told that opens now, besides its row."""
        return []

    def data(self) -> list[Payload]:
        """What a page must be sent that opens now, to draw what others do."""
        return []
