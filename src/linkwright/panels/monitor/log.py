"""The log console, the counterpart of ``rqt_console`` for ``/rosout``."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from typing import Any

from linkwright.graph import MessageInfo
from linkwright.page.audience import Page
from linkwright.page.protocol.message import ServerMessage, encode
from linkwright.page.protocol.monitor import LogLine, LogLines, WatchLog
from linkwright.panels.monitor.topic_tap import Paced, TopicTap
from linkwright.panels.page_feature import FeatureHost, PageFeature

_TOPIC = "/rosout"
_PERIOD = 0.1
_MOST_WAITING = 1000
"""Records that wait for one page; of more only the newest are sent."""

_KEPT = 1000
"""Past records for a page that starts to watch."""


class _Reader:
    """The log records that are queued for one page; the message is created when the outbox sends it."""

    key = "log_lines"

    def __init__(self, past: Iterable[LogLine]) -> None:
        self._waiting = deque(past, maxlen=_MOST_WAITING)
        self._missed = 0

    def __len__(self) -> int:
        return len(self._waiting)

    def add(self, line: LogLine) -> None:
        """Queue a record, and drop the oldest one if too many are queued."""
        if len(self._waiting) == _MOST_WAITING:
            self._missed += 1
        self._waiting.append(line)

    def since(self, seen: int) -> tuple[str | None, int]:
        """Return a message with all queued records; see `Changes`."""
        if not self._waiting:
            return None, seen
        message = LogLines(list(self._waiting), self._missed)
        self._waiting.clear()
        self._missed = 0
        return encode(message), seen


class LogFeature(PageFeature):
    """Stores the latest records of ``/rosout`` while any page is open, and sends them to pages."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._readers: dict[Page, _Reader] = {}
        self._watching: set[Page] = set()
        self._past: deque[LogLine] = deque(maxlen=_KEPT)
        self._tap: TopicTap | None = None
        self._turn = Paced(self._send, _PERIOD)

    def opening(self) -> list[ServerMessage]:
        """Subscribe for the first page; no messages are returned."""
        if self._tap is None:
            self._tap = TopicTap(self.context, _TOPIC, self._receive)
        return []

    def receive(self, page: Page, message: WatchLog) -> None:
        """Start, pause or stop sending records to a page; records that arrive in a pause are sent after it."""
        if not message.watched:
            self._watching.discard(page)
            return
        self._watching.add(page)
        if page not in self._readers:
            self._readers[page] = _Reader(self._past)
        self._turn.ask()

    def page_closed(self, page: Page) -> None:
        """Discard the page's records, and unsubscribe after the last page has closed."""
        self._watching.discard(page)
        self._readers.pop(page, None)
        if len(self.context.pages) == 0:
            self.close()

    def close(self) -> None:
        """Unsubscribe."""
        self._readers.clear()
        self._watching.clear()
        self._past.clear()
        self._turn.cancel()
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
        self._past.append(line)
        for reader in self._readers.values():
            reader.add(line)
        self._turn.ask()

    def _send(self) -> None:
        for page in self._watching:
            reader = self._readers[page]
            if len(reader):
                page.outbox.put(reader.key, reader)
