"""The last messages of all topics in memory until a snapshot is requested: rosbag2's snapshot mode."""

from __future__ import annotations

from collections import deque


class LatestMessages:
    """The most recent messages up to a total size; older messages are dropped.

    Args:
        size: the maximum number of bytes; a message that is larger is not stored.
    """

    def __init__(self, size: int) -> None:
        self._room = size
        self._used = 0
        self._kept: deque[tuple[str, int, bytes]] = deque()

    def add(self, topic: str, stamp_ns: int, data: bytes | memoryview) -> None:
        """Store a message; the arguments are those of `BagWriter.write`."""
        content = bytes(data)
        if len(content) > self._room:
            return
        self._kept.append((topic, stamp_ns, content))
        self._used += len(content)
        while self._used > self._room:
            _, _, dropped = self._kept.popleft()
            self._used -= len(dropped)

    def taken(self) -> list[tuple[str, int, bytes]]:
        """Remove and return the messages, oldest first."""
        taken = list(self._kept)
        self._kept.clear()
        self._used = 0
        return taken
