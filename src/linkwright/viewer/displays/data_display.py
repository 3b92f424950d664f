"""Displays that send pages what they draw, and keep it for pages that open later."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from linkwright.viewer.display_config import DisplayConfig
from linkwright.viewer.displays.base import Stage, ViewerDisplay
from linkwright.viewer.outbox import Payload
from linkwright.viewer.protocol import DataContent, DisplayForgotten, StatusLevel, StatusRow, pack_data
from linkwright.viewer.scaled_data import ScaledData, Shrink

Pose = NDArray[np.float64]
"""x, y, z (metres), qx, qy, qz, qw of a frame in the Fixed Frame; shape (7,)."""


class DataDisplay(ViewerDisplay):
    """A display with content and with status rows that come and go one by one."""

    def __init__(self, stage: Stage, identity: str, config: DisplayConfig) -> None:
        super().__init__(stage, identity, config)
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
        """Have pages draw something; see `pack_data`. It is kept for pages that open later.

        With `shrink` pages whose line is slow are sent as much of it as the line carries.
        """
        pack = partial(pack_data, self.id, key=key, frame=frame, pose=pose, stamp=stamp_ns / 1e9)
        waits_under = f"data {self.id} {key}"
        packed = pack(content) if shrink is None else ScaledData(waits_under, content, shrink, pack)
        self.stage.send_data(waits_under, packed)
        self._replaced(key)  # only now: until then it holds the place of the new one
        self._data[key] = packed

    def forget(self, key: str | None = None) -> None:
        """Have pages draw what was sent under a key no more, or nothing of it all."""
        for each in self._data if key is None else (key,):
            self._replaced(each)
        if key is None:
            self._data.clear()
        else:
            self._data.pop(key, None)
        self.stage.publish(DisplayForgotten(self.id, key))

    def say(self, name: str, level: StatusLevel, text: str) -> None:
        """Set a status row."""
        row = StatusRow(name, level, text)
        if self._rows.get(name) != row:
            self._rows[name] = row
            self.set_status(list(self._rows.values()))

    def unsay(self, name: str | None = None) -> None:
        """Take a status row away, or all."""
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
