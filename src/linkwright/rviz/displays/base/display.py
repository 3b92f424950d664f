"""The base classes of all displays: check box, properties, status rows, content and events."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from linkwright.page.audience import PageGroup
from linkwright.page.outbox import Payload, ScaledData, Shrink
from linkwright.page.protocol.configuration import (
    Display,
    DisplayProperties,
    DisplayStatus,
    PropertyChanged,
    StatusLevel,
    StatusRow,
)
from linkwright.page.protocol.message import DataContent, DisplayForgotten, ServerMessage, pack_data
from linkwright.rviz.config.former_names import get_former_keys
from linkwright.rviz.config.property_store import PropertyStore
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import FIXED_FRAME, Path, Schema
from linkwright.rviz.config.yaml_tree import SavedEntry
from linkwright.rviz.context import ViewerContext
from linkwright.rviz.frames.stream import FrameView, TimeControl


class DisplayHost(Protocol):
    """The interface of the visualization for the displays that it contains.

    Attributes:
        context: the viewer's node, files and pages.
        pages: the pages that show the display.
        frames: the current frames.
        time: whether time is paused, and its synchronization.
    """

    context: ViewerContext
    pages: PageGroup
    frames: FrameView
    time: TimeControl

    def on_robot_changed(self, removed_frames: set[str]) -> None:
        """Handle a new robot of a display.

        `removed_frames` contains the frames that only the previous robot had.
        """

    def on_fading_changed(self) -> None:
        """Handle a change to a TF display's frame timeout or check box."""


Pose = NDArray[np.float64]
"""The pose of a frame in the Fixed Frame: x, y, z in meters, qx, qy, qz, qw, shape (7,)."""

_LEVEL_RANK: dict[StatusLevel, int] = {"ok": 0, "warn": 1, "error": 2}


def find_worst_level(rows: list[StatusRow]) -> StatusLevel:
    """Return the most severe level of status rows.

    The display's own row has this level.
    """
    return max((row.level for row in rows), key=_LEVEL_RANK.__getitem__, default="ok")


class ViewerDisplay:
    """A display of the Displays panel.

    A subclass sets its RViz class and its properties, and overrides methods that handle events, such as starting and
    stopping, new property values, and changed frames.

    Args:
        host: the visualization that contains the display.
        identity: the ID of the display in pages, which never changes.
        config: the display's entry in the .rviz file.
    """

    CLASS: ClassVar[str]
    SCHEMA: ClassVar[Schema] = ()
    SUPPORTED: ClassVar[bool] = True
    DRAWN_AS: ClassVar[str] = ""
    """The RViz class that the page draws for this class, or empty if the page can draw this class itself."""
    TOPIC: ClassVar[Path] = ("Topic",)
    """The property that is set to the topic when the display is added for a topic."""

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self.host = host
        self.context = host.context
        self.pages = host.pages
        self.id = identity
        self.config = config
        self.properties = PropertyStore(
            identity,
            config.section,
            self.schema,
            host.context.report,
            frames=self._reference_frames,
            former=get_former_keys(config.written_class),
        )
        self.status: list[StatusRow] = []

    @classmethod
    def shown_message_types(cls) -> tuple[str, ...]:
        """Return the message types of the topics that the display can show."""
        message: str = getattr(cls, "MESSAGE", "")
        return (message,) if message else ()

    @classmethod
    def topic_value(cls, topic: str) -> str:
        """Return the value of the property `TOPIC` that shows a topic."""
        return topic

    @property
    def enabled(self) -> bool:
        """Whether the check boxes of the display and of all enclosing groups are on."""
        return self.config.enabled

    def schema(self) -> Schema:
        """Return the declarations of the display's current properties."""
        return self.SCHEMA

    def row(self) -> Display:
        """Return the display's row for the Displays panel of pages."""
        return Display(
            id=self.id,
            cls=self.config.cls,
            drawing=self.DRAWN_AS or self.config.cls,
            name=self.config.name,
            group=self.config.group.identity if self.config.group else None,
            enabled=self.config.checked,
            supported=self.SUPPORTED,
            level=find_worst_level(self.status),
            status=self.status,
            properties=self.properties.rows(),
        )

    def set_property(self, path: Path, value: object) -> None:
        """Set a property to a value from a page, apply the value, and send it to all pages.

        Raises:
            ValueError: the property does not accept the value.
        """
        accepted_value = self.properties.set(path, value)
        self.on_property_changed(path)
        if self.properties.is_condition(path):
            self.publish_properties()
        self.pages.publish(PropertyChanged(self.property_id(path), accepted_value))

    def set_checked(self, value: bool) -> None:
        """Set the check box, and send its value to all pages.

        The caller must then call `on_enabled_changed`.
        """
        self.config.checked = value
        self.pages.publish(PropertyChanged(f"{self.id}/Enabled", value))

    def restore(self, saved_entries: Sequence[SavedEntry]) -> None:
        """Restore and apply previous values of properties, and send all property rows to the pages."""
        for path in self.properties.restore(saved_entries):
            self.on_property_changed(path)
        self.properties.restore(saved_entries)  # `on_property_changed` may have set further properties
        self.on_properties_restored()
        self.publish_properties()

    def property_id(self, path: Path) -> str:
        """Return the ID of the property at a path."""
        return self.properties.identity(path)

    def publish_properties(self) -> None:
        """Send all property rows of the display to the pages."""
        self.pages.publish(DisplayProperties(self.id, self.properties.rows()))

    def set_status(self, rows: list[StatusRow]) -> None:
        """Set the status rows, and send them to the pages if they changed.

        A disabled display has no status rows.
        """
        if not self.enabled:
            rows = []
        if rows != self.status:
            self.status = rows
            self.pages.publish(DisplayStatus(self.id, find_worst_level(rows), rows))

    def _reference_frames(self) -> list[str]:
        return [FIXED_FRAME, *sorted(self.host.frames.names)]

    def start(self) -> None:
        """Start the display, for example by subscribing and reading files."""

    def stop(self) -> None:
        """Stop the display permanently."""

    def on_property_changed(self, path: Path) -> None:
        """Handle a property's new value."""

    def on_properties_restored(self) -> None:
        """Update derived state after `on_property_changed` was called for every restored value."""

    def on_enabled_changed(self) -> None:
        """Handle a change to the check box of the display or of a group that contains the display."""
        self.on_frames_changed()

    def on_displays_rearranged(self, displays: Sequence[ViewerDisplay]) -> None:
        """Handle a change to the list of displays: one was added, removed, moved or renamed.

        Args:
            displays: all displays, each group before its contents.
        """

    def on_frames_changed(self) -> None:
        """Handle a change to the frames, their known poses, or the Fixed Frame."""

    def receive(self, message: Any) -> None:
        """Handle a page's message for this display, such as a mesh status or a marker action."""

    def on_time_changed(self) -> None:
        """Handle a pause or resume of the viewer's time, or a change of the synchronization source."""

    def on_time_reset(self) -> None:
        """Handle a reset of time: discard all earlier messages."""

    def messages(self) -> list[ServerMessage]:
        """Return the messages for a newly opened page, in addition to the display's row."""
        return []

    def data(self) -> list[Payload]:
        """Return the content that a newly opened page needs to draw the display."""
        return []


class DataDisplay(ViewerDisplay):
    """A display that sends content under keys, and adds and removes status rows one by one."""

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._rows: dict[str, StatusRow] = {}
        self._data: dict[str, bytes | ScaledData] = {}

    def send(
        self,
        content: DataContent,
        *,
        key: str = "",
        frame: str = "",
        pose: Pose | None = None,
        stamp_ns: int = 0,
        shrink: Shrink | None = None,
    ) -> None:
        """Send content for pages to draw (see `pack_data`), and store it for pages that open later.

        The content replaces the content that was sent before under the same key. If `shrink` is not None, it reduces
        the content for pages with a slow connection.
        """
        pack = partial(pack_data, self.id, key=key, frame=frame, pose=pose, stamp=stamp_ns / 1e9)
        queue_key = f"data {self.id} {key}"
        packed = pack(content) if shrink is None else ScaledData(queue_key, content, shrink, pack)
        self.pages.send_data(queue_key, packed)
        self._mark_replaced(key)  # after `send_data`, which replaces the content in the queue
        self._data[key] = packed

    def remove_content(self, key: str | None = None) -> None:
        """Remove the content sent under a key, or all content, from the display and the pages."""
        for data_key in self._data if key is None else (key,):
            self._mark_replaced(data_key)
        if key is None:
            self._data.clear()
        else:
            self._data.pop(key, None)
        self.pages.publish(DisplayForgotten(self.id, key))

    def set_status_row(self, name: str, level: StatusLevel, text: str) -> None:
        """Add or replace a status row.

        Pages translate a `Phrase` into their own language.
        """
        row = StatusRow(name, level, text)
        if self._rows.get(name) != row:
            self._rows[name] = row
            self.set_status(list(self._rows.values()))

    def delete_status_row(self, name: str | None = None) -> None:
        """Remove a status row, or all rows."""
        if name is None:
            self._rows.clear()
            self.set_status([])
        elif self._rows.pop(name, None) is not None:
            self.set_status(list(self._rows.values()))

    def data(self) -> list[Payload]:
        """Return the content that is currently drawn."""
        return list(self._data.values())

    def _mark_replaced(self, key: str) -> None:
        previous_data = self._data.get(key)
        if isinstance(previous_data, ScaledData):
            previous_data.is_withdrawn = True
