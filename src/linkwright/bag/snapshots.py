"""Keep the last messages of all topics in memory until a snapshot is requested (rosbag2)."""

from __future__ import annotations

from collections import deque


class LatestMessages:
    """The latest messages up to a total size.

    Older messages are dropped.

    Args:
        size: the maximum number of bytes; a single message that is larger is not stored.
    """

    def __init__(self, size: int) -> None:
        self._max_bytes = size
        self._used_bytes = 0
        self._messages: deque[tuple[str, int, bytes]] = deque()

    def add(self, topic: str, stamp_ns: int, data: bytes | memoryview) -> None:
        """Store a message, with the arguments of `BagWriter.write`."""
        content = bytes(data)
        if len(content) > self._max_bytes:
            return
        self._messages.append((topic, stamp_ns, content))
        self._used_bytes += len(content)
        while self._used_bytes > self._max_bytes:
            _, _, dropped = self._messages.popleft()
            self._used_bytes -= len(dropped)

    def take_all(self) -> list[tuple[str, int, bytes]]:
        """Remove and return the messages, oldest first."""
        take = list(self._messages)
        self._messages.clear()
        self._used_bytes = 0
        return take
