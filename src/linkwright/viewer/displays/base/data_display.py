"""Displays that send pages what they draw, and keep it for pages that open later."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from linkwright.viewer.config.rviz_config import DisplayConfig
from linkwright.viewer.displays.base.display import ViewerDisplay
from linkwright.viewer.displays.base.host import DisplayHost
from linkwright.viewer.protocol.data import DisplayForgotten, pack_data
from linkwright.viewer.protocol.message import DataContent
from linkwright.viewer.protocol.parts import StatusLevel, StatusRow
from linkwright.viewer.web.outbox import Payload, ScaledData, Shrink

Pose = NDArray[np.float64]
"""x, y, z (metres), qx, qy, qz, qw of a frame in the Fixed Frame; shape (7,)."""


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
        """Set a status row."""
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
        """What is drawn now."""
        return list(self._data.values())

    def _replaced(self, key: str) -> None:
        before = self._data.get(key)
        if isinstance(before, ScaledData):
            before.gone = True
