"""The last messages of all topics, kept until a snapshot is requested: rosbag2's snapshot mode."""

from __future__ import annotations

from collections import deque


class LatestMessages:
    """The last messages in a number of bytes; older ones are dropped.

    Args:
        size: bytes of messages. A message that is longer is not kept.
    """

    def __init__(self, size: int) -> None:
        self._room = size
        self._used = 0
        self._kept: deque[tuple[str, int, bytes]] = deque()

    def add(self, topic: str, stamp_ns: int, data: bytes | memoryview) -> None:
        """Store a message, with the arguments of `BagWriter.write`."""
        content = bytes(data)
        if len(content) > self._room:
            return
        self._kept.append((topic, stamp_ns, content))
        self._used += len(content)
        while self._used > self._room:
            _, _, dropped = self._kept.popleft()
            self._used -= len(dropped)

    def taken(self) -> list[tuple[str, int, bytes]]:
        """The messages from the oldest on, which are not kept any more."""
        taken = list(self._kept)
        self._kept.clear()
        self._used = 0
        return taken
