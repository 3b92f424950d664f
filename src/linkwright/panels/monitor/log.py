"""The log console, the counterpart of ``rqt_console`` for ``/rosout``."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from typing import Any

from linkwright.graph import MessageInfo
from linkwright.page.audience import Page
from linkwright.page.protocol.message import ServerMessage, encode
from linkwright.page.protocol.monitor import LogLine, LogLines, WatchLog
from linkwright.panels.monitor.topic_tap import RateLimiter, TopicTap
from linkwright.panels.page_feature import FeatureHost, PageFeature

_TOPIC = "/rosout"
_SEND_PERIOD_S = 0.1
_MAX_QUEUED = 1000
"""The largest number of queued records for a page. If there are more, only the newest are sent."""

_MAX_PAST_RECORDS = 1000
"""The number of past records that a page receives when it starts to watch."""


class _PageQueue:
    """The log records that are queued for one page.

    The message is created when the outbox sends it.
    """

    key = "log_lines"

    def __init__(self, past_lines: Iterable[LogLine]) -> None:
        self._waiting = deque(past_lines, maxlen=_MAX_QUEUED)
        self._dropped_count = 0

    def __len__(self) -> int:
        return len(self._waiting)

    def add(self, line: LogLine) -> None:
        """Queue a record, and drop the oldest one if too many are queued."""
        if len(self._waiting) == _MAX_QUEUED:
            self._dropped_count += 1
        self._waiting.append(line)

    def since(self, seen: int) -> tuple[str | None, int]:
        """Return a message with all queued records. See `Changes`."""
        if not self._waiting:
            return None, seen
        message = LogLines(list(self._waiting), self._dropped_count)
        self._waiting.clear()
        self._dropped_count = 0
        return encode(message), seen


class LogFeature(PageFeature):
    """The feature that sends the latest records of ``/rosout`` to pages.

    The records are stored while any page is open.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._queues: dict[Page, _PageQueue] = {}
        self._watching_pages: set[Page] = set()
        self._past_lines: deque[LogLine] = deque(maxlen=_MAX_PAST_RECORDS)
        self._tap: TopicTap | None = None
        self._sender = RateLimiter(self._send, _SEND_PERIOD_S)

    def opening_messages(self) -> list[ServerMessage]:
        """Subscribe if this is the first page, and return no messages."""
        if self._tap is None:
            self._tap = TopicTap(self.context, _TOPIC, self._receive)
        return []

    def receive(self, page: Page, message: WatchLog) -> None:
        """Start, pause or resume sending records to a page.

        Records that arrive during a pause are sent after it.
        """
        if not message.watched:
            self._watching_pages.discard(page)
            return
        self._watching_pages.add(page)
        if page not in self._queues:
            self._queues[page] = _PageQueue(self._past_lines)
        self._sender.request()

    def remove_page(self, page: Page) -> None:
        """Discard the page's records, and unsubscribe after the last page has closed."""
        self._watching_pages.discard(page)
        self._queues.pop(page, None)
        if len(self.context.pages) == 0:
            self.close()

    def close(self) -> None:
        """Unsubscribe, and discard all records."""
        self._queues.clear()
        self._watching_pages.clear()
        self._past_lines.clear()
        self._sender.cancel()
        if self._tap is not None:
            self._tap.close()
            self._tap = None

    def _receive(self, message: Any, _: MessageInfo) -> None:
        line = LogLine(
            level=message.level,
            node=message.name,
            message=message.msg,
            time=message.stamp.nanoseconds * 1e-9,
            file=message.file,
            function=message.function,
            line=message.line,
        )
        self._past_lines.append(line)
        for queue in self._queues.values():
            queue.add(line)
        self._sender.request()

    def _send(self) -> None:
        for page in self._watching_pages:
            queue = self._queues[page]
            if len(queue):
                page.outbox.put(queue.key, queue)
