"""Displays that show the last messages of a topic, as many as a property says."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from linkwright.viewer.config.rviz_config import DisplayConfig
from linkwright.viewer.config.schema import Path
from linkwright.viewer.displays.base.data_display import Pose
from linkwright.viewer.displays.base.host import DisplayHost
from linkwright.viewer.displays.base.topic_display import TopicDisplay
from linkwright.viewer.protocol.message import DataContent

_MESSAGE = "Message"
_INVALID = "Message contained invalid floating point values (nans or infs)"


@dataclass(slots=True)
class _Shown:
    content: DataContent
    frame: str
    pose: Pose | None
    stamp_ns: int


class RecentDisplay(TopicDisplay):
    """Shows what `content` makes of each of the last messages, each where its frame was at its time.

    A subclass says how many with the property at `LENGTH` (0 for all of them); without one it is a single message.
    """

    LENGTH: ClassVar[Path | None] = None

    IN_FIXED_FRAME: ClassVar[bool] = False
    """Whether contents are in the Fixed Frame already."""

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._shown: deque[_Shown] = deque()
        self._number = 0

    def content(self, message: Any) -> DataContent | None:
        """What pages draw of a message, in the frame of `frame_of`; None for nothing new."""
        raise NotImplementedError

    def take(self, message: Any, pose: Pose | None) -> None:
        """Show a message, and drop the oldest one."""
        assert pose is not None
        content = self.content(message)
        if content is None:
            return
        frame, stamp_ns = self.frame_of(message)
        if self.IN_FIXED_FRAME:
            frame, pose = "", None
        self._shown.append(_Shown(content, frame, pose, stamp_ns))
        length = self._length()
        if length and len(self._shown) > length:
            self._shown.popleft()
        self._send(self._shown[-1])

    def changed(self, path: Path) -> None:
        """Show as many messages as are asked for."""
        super().changed(path)
        if path == self.LENGTH:
            length = self._length()
            kept = list(self._shown)[-length:]
            self.reset()
            for each in kept:
                self._shown.append(each)
                self._send(each)

    def reset(self) -> None:
        """Forget all of them."""
        self._shown.clear()
        self._number = 0
        super().reset()

    def refuse(self, text: str) -> None:
        """Show what is wrong with the last message."""
        self.say(_MESSAGE, "error", text)

    def accept(self) -> None:
        """Clear what the status said of the previous message."""
        self.unsay(_MESSAGE)

    def is_finite(self, *numbers: ArrayLike) -> bool:
        """Whether all are finite; the status says so if not."""
        if all(np.isfinite(each).all() for each in numbers):
            self.accept()
            return True
        self.refuse(_INVALID)
        return False

    def _send(self, shown: _Shown) -> None:
        length = self._length()
        key = str(self._number % length if length else self._number)
        self._number += 1
        self.send(shown.content, key=key, frame=shown.frame, pose=shown.pose, stamp_ns=shown.stamp_ns)

    def _length(self) -> int:
        return 1 if self.LENGTH is None else int(self.properties.number(*self.LENGTH))
