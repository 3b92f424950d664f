"""The base of all displays: an enable box, properties, status rows, content, and the events that it handles."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from linkwright.viewer.config.former_names import former_keys
from linkwright.viewer.config.property_store import PropertyStore
from linkwright.viewer.config.rviz_config import DisplayConfig
from linkwright.viewer.config.schema import FIXED_FRAME, Path, Schema
from linkwright.viewer.config.yaml_tree import Memory
from linkwright.viewer.context import ViewerContext
from linkwright.viewer.frames.stream import FrameView, TimeControl
from linkwright.viewer.protocol.binary import DisplayForgotten, pack_data
from linkwright.viewer.protocol.displays import (
    Display,
    DisplayProperties,
    DisplayStatus,
    PropertyChanged,
    StatusLevel,
    StatusRow,
)
from linkwright.viewer.protocol.message import DataContent, ServerMessage
from linkwright.viewer.web.audience import PageGroup
from linkwright.viewer.web.outbox import Payload, ScaledData, Shrink


class DisplayHost(Protocol):
    """A visualization, as its displays see it.

    Attributes:
        context: the viewer's node, files and pages.
        pages: the pages that see the display.
        frames: the frames now.
        time: whether time stands still, and what leads it.
    """

    context: ViewerContext
    pages: PageGroup
    frames: FrameView
    time: TimeControl

    def robot_changed(self, gone: set[str]) -> None:
        """A display has another robot; `gone` are the frames that only the one before had."""


Pose = NDArray[np.float64]
"""x, y, z (metres), qx, qy, qz, qw of a frame in the Fixed Frame; shape (7,)."""

_RANK: dict[StatusLevel, int] = {"ok": 0, "warn": 1, "error": 2}


def worst(rows: list[StatusRow]) -> StatusLevel:
    """The level that a display's own row shows: the worst of its status rows."""
    return max((row.level for row in rows), key=_RANK.__getitem__, default="ok")


class ViewerDisplay:
    """A display of the Displays panel.

    A class of display says its RViz class and its properties, and overrides what it must know of: start and stop,
    values set, frames changed.

    Args:
        host: the visualization that it is part of.
        identity: its id in the page, stable for its life.
        config: its entry of the .rviz file.
    """

    CLASS: ClassVar[str]
    SCHEMA: ClassVar[Schema] = ()
    SUPPORTED: ClassVar[bool] = True
    DRAWN_AS: ClassVar[str] = ""
    """The RViz class whose drawing the page uses, for a display of a package that brings none; its own where empty."""
    TOPIC: ClassVar[Path] = ("Topic",)
    """The property that takes the topic when a display is added for one."""

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
            drawing=self.DRAWN_AS or self.config.cls,
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
        self.pages.publish(PropertyChanged(self.property_id(path), taken))

    def set_checked(self, value: bool) -> None:
        """Take a new state of the enable box, and tell all pages; `enabled_changed` comes after."""
        self.config.checked = value
        self.pages.publish(PropertyChanged(f"{self.id}/Enabled", value))

    def recall(self, memories: Sequence[Memory]) -> None:
        """Restore what the file had for some properties, tell all pages, and act on it."""
        for path in self.properties.recall(memories):
            self.changed(path)
        self.properties.recall(memories)  # what was set together with a property was recalled with it
        self.recalled()
        self.publish_properties()

    def property_id(self, path: Path) -> str:
        """The id of one of its properties."""
        return self.properties.identity(path)

    def publish_properties(self) -> None:
        """Send the property rows again."""
        self.pages.publish(DisplayProperties(self.id, self.properties.rows()))

    def set_status(self, rows: list[StatusRow]) -> None:
        """Show status rows, none while the display is off; pages hear of it only when they differ."""
        if not self.enabled:
            rows = []
        if rows != self.status:
            self.status = rows
            self.pages.publish(DisplayStatus(self.id, worst(rows), rows))

    def _reference_frames(self) -> list[str]:
        return [FIXED_FRAME, *sorted(self.host.frames.names)]

    def start(self) -> None:
        """Begin: subscribe, read files."""

    def stop(self) -> None:
        """End for good."""

    def changed(self, path: Path) -> None:
        """A property has a new value."""

    def recalled(self) -> None:
        """Values were restored and `changed` was called for each: update what depends on them."""

    def enabled_changed(self) -> None:
        """The display's enable box, or that of a group around it, was set."""
        self.frames_changed()

    def arranged(self, displays: Sequence[ViewerDisplay]) -> None:
        """Displays were added, removed, moved or renamed; these there are now, each group before its content."""

    def frames_changed(self) -> None:
        """Frames appeared, disappeared, or gained or lost their transform; or the Fixed Frame has changed."""

    def receive(self, message: Any) -> None:
        """Handle a message about this display alone: how a mesh loaded, what was done to a marker."""

    def time_changed(self) -> None:
        """Time was paused or resumed, or follows another source."""

    def time_reset(self) -> None:
        """Time was reset: forget earlier messages."""

    def messages(self) -> list[ServerMessage]:
        """Messages for a page that opens now, besides the display's row."""
        return []

    def data(self) -> list[Payload]:
        """Content for a page that opens now, so that it draws what the others do."""
        return []


class DataDisplay(ViewerDisplay):
    """A display with content and with status rows that come and go one by one."""

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
        """Send pages something to draw; see `pack_data`. It is kept for pages that open later.

        With `shrink` pages whose line is slow are sent as much of it as the line carries.
        """
        pack = partial(pack_data, self.id, key=key, frame=frame, pose=pose, stamp=stamp_ns / 1e9)
        waits_under = f"data {self.id} {key}"
        packed = pack(content) if shrink is None else ScaledData(waits_under, content, shrink, pack)
        self.pages.send_data(waits_under, packed)
        self._replaced(key)  # only now, because until then the new one has its place
        self._data[key] = packed

    def forget(self, key: str | None = None) -> None:
        """Remove what was sent under a key from pages, or all of it."""
        for each in self._data if key is None else (key,):
            self._replaced(each)
        if key is None:
            self._data.clear()
        else:
            self._data.pop(key, None)
        self.pages.publish(DisplayForgotten(self.id, key))

    def say(self, name: str, level: StatusLevel, text: str) -> None:
        """Set a status row; a text that is a phrase is said in the language of each page."""
        row = StatusRow(name, level, text)
        if self._rows.get(name) != row:
            self._rows[name] = row
            self.set_status(list(self._rows.values()))

    def unsay(self, name: str | None = None) -> None:
        """Remove a status row, or all."""
        if name is None:
            self._rows.clear()
            self.set_status([])
        elif self._rows.pop(name, None) is not None:
            self.set_status(list(self._rows.values()))

    def data(self) -> list[Payload]:
        """The content drawn now."""
        return list(self._data.values())

    def _replaced(self, key: str) -> None:
        before = self._data.get(key)
        if isinstance(before, ScaledData):
            before.gone = True
