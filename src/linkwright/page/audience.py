"""The open pages, the exchange of messages with them, and the lag of the event loop."""

from __future__ import annotations

import asyncio
import math
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics.translation import language as language_of_terminal
from linkwright.diagnostics.translation import language_of
from linkwright.graph import log_failure
from linkwright.page.outbox import (
    MIN_MEASURED_SIZE,
    TRANSFORMS,
    ChunkedFrame,
    ConnectionMeter,
    Outbox,
    Outgoing,
    Payload,
    ScaledData,
)
from linkwright.page.protocol.message import (
    BadMessageError,
    PageMessage,
    ProgramIsLate,
    Received,
    ServerMessage,
    decode,
    encode,
    get_import_path,
    make_redundancy_key,
)

if TYPE_CHECKING:
    from aiohttp.web import Request, WebSocketResponse

    from linkwright.graph import Logger
    from linkwright.page.protocol.voice import SoundBlock


_MEASURE_PERIOD_S = 0.05
"""Seconds between two measurements of the lag."""

_MEASUREMENT_COUNT = 20
"""The number of measurements in the mean."""


class LoopLag:
    """A measurement of the lag of the event loop, from creation until `close`.

    Messages from a page wait for this time before they are read, and messages to a page before they are sent.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._lags: deque[float] = deque(maxlen=_MEASUREMENT_COUNT)
        self._due_time = self._loop.time() + _MEASURE_PERIOD_S
        self._timer = self._loop.call_at(self._due_time, self._measure)

    @property
    def mean(self) -> float:
        """The mean lag over the last second, in seconds, or 0.0 before the first measurement."""
        return sum(self._lags) / len(self._lags) if self._lags else 0.0

    def close(self) -> None:
        """Stop measuring."""
        self._timer.cancel()

    def _measure(self) -> None:
        now = self._loop.time()
        self._lags.append(now - self._due_time)
        self._due_time = now + _MEASURE_PERIOD_S
        self._timer = self._loop.call_at(self._due_time, self._measure)


MAX_PAGES = 32
"""The largest number of open pages, beyond which pages are refused."""

_MAX_INVALID_MESSAGES = 20
"""The number of invalid messages after which a page is disconnected."""

_LAG_FACTOR = 4
"""A page receives a notice that the program is late if the lag times this factor exceeds the round-trip time."""

_QUIET_PERIOD_S = 0.3
"""Seconds for which a connection must be idle before a page receives the full data of reduced content."""


def find_requested_language(request: Request) -> str:
    """Return the language that a page requests, one of `LANGUAGES`.

    The default is the language of the terminal.
    """
    return language_of(request.query.get("language", "")) or language_of_terminal()


class Page:
    """An open page, with its socket and its outbox.

    Args:
        socket: the page's socket.
        configuration_name: the name of the page's own configuration; empty for a page that uses the shared
            configuration.
        is_local: whether the page is open on this machine or connected through a tunnel to it.
        may_be_own_user: returns whether the page's browser or tunnel may run as the user of this program; see
            `peers.may_be_own_user`.
        language: the language of the page's user, one of `LANGUAGES`; None to send texts untranslated.
        origin: the origin of the page, such as ``http://127.0.0.1:7448``.
    """

    def __init__(
        self,
        socket: WebSocketResponse,
        configuration_name: str = "",
        *,
        is_local: bool = False,
        may_be_own_user: Callable[[], bool] = lambda: False,
        language: str | None = None,
        origin: str = "",
    ) -> None:
        self.outbox = Outbox()
        self.origin = origin
        self.language = language
        self.configuration_name = configuration_name
        self.is_local = is_local
        self.may_be_own_user = may_be_own_user
        self.line = ConnectionMeter(asyncio.get_running_loop().time)
        self._socket = socket
        self._reduced: dict[str, tuple[ScaledData, int]] = {}
        self._loop_lag: LoopLag | None = None
        self._has_reported_late = False
        self._opening: list[Payload] = []
        self._completion_timer: asyncio.TimerHandle | None = None
        self._completion: ChunkedFrame | None = None
        self._completion_count = 0

    def open(self, opening: Iterable[Payload]) -> None:
        """Set the messages that are sent first to the page."""
        self._opening = list(opening)

    def send(self, message: ServerMessage) -> None:
        """Send a message only to this page."""
        self.outbox.put(make_redundancy_key(message), encode(message, self.language))

    async def write(self) -> None:
        """Send the opening payloads, then the outbox's payloads, until the connection is lost."""
        try:
            for payload in self._opening:
                content = self.outbox.make(payload)
                if content is not None:
                    await self._send(content)
            self._opening.clear()
            while True:
                await self._send(await self.outbox.take())
        except ConnectionError:
            pass  # the reader also notices this, and cleans up

    def record_acknowledged(self, count: int) -> None:
        """Record that the page has acknowledged its first `count` messages."""
        self.line.record_acknowledged(count)
        self._on_connection_change()

    def close(self) -> None:
        """Cancel scheduled work."""
        if self._loop_lag is not None:
            self._loop_lag.close()
            self._loop_lag = None
        self._cancel_completion()

    def _cancel_completion(self) -> None:
        if self._completion_timer is not None:
            self._completion_timer.cancel()
            self._completion_timer = None

    async def _send(self, payload: Outgoing | ScaledData) -> None:
        if not isinstance(payload, (str, bytes)):
            payload = await self._fit_frame(payload)
        size = len(payload)
        start_time = self.line.sending(size)
        if isinstance(payload, bytes):
            await self._socket.send_bytes(payload)
        else:
            await self._socket.send_str(payload)
        self.line.sent(size, start_time)
        self._on_connection_change()

    async def _fit_frame(self, payload: ScaledData) -> bytes:
        """Return a frame with as much of the content as the connection can carry.

        The full content is sent later, when the connection is idle.
        """
        byte_budget = self.line.room
        frame = await payload.pack_fitting(byte_budget)
        if frame is payload.full_frame:
            self._reduced.pop(payload.key, None)
        else:
            self._reduced[payload.key] = (payload, byte_budget)
        return frame

    def _on_connection_change(self) -> None:
        self.outbox.hold(self.line.is_full)
        self._report_lateness()
        if self._completion is not None and self._completion.done:
            self._end_completion(self._completion)
        byte_budget = self.line.room
        for key, (payload, previous_budget) in list(self._reduced.items()):
            if payload.is_withdrawn:
                del self._reduced[key]
            elif byte_budget >= 2 * previous_budget and key not in self.outbox and not self._is_completing(payload):
                del self._reduced[key]
                self.outbox.put(key, payload)
        if self._completion is not None:
            if self._completion.key not in self.outbox:
                self.outbox.put(self._completion.key, self._completion)
        elif not self.line.is_idle:
            self._cancel_completion()
        elif self._reduced and self._completion_timer is None:
            self._completion_timer = asyncio.get_running_loop().call_later(_QUIET_PERIOD_S, self._start_completion)

    def _report_lateness(self) -> None:
        """Notify the page when this program starts or stops being the reason for reduced data."""
        if self._loop_lag is None and self._reduced:
            self._loop_lag = LoopLag(asyncio.get_running_loop())
        elif self._loop_lag is not None and not self._reduced:
            self._loop_lag.close()
            self._loop_lag = None
        is_late = self._loop_lag is not None and self._loop_lag.mean * _LAG_FACTOR >= (
            self.line.acknowledgment_time or math.inf
        )
        if is_late != self._has_reported_late:
            self._has_reported_late = is_late
            self.send(ProgramIsLate(is_late))

    def _start_completion(self) -> None:
        """Send the full content of a reduced payload in chunks, because the connection is idle."""
        self._completion_timer = None
        for payload, _ in self._reduced.values():
            if payload.key not in self.outbox:
                self._completion_count += 1
                self._completion = ChunkedFrame(payload, self._completion_count, self._compute_chunk_size)
                self.outbox.put(payload.key, self._completion)
                return

    def _is_completing(self, payload: ScaledData) -> bool:
        return self._completion is not None and self._completion.payload is payload

    def _end_completion(self, completion: ChunkedFrame) -> None:
        self._completion = None
        if self._reduced.get(completion.key, (None,))[0] is completion.payload:
            del self._reduced[completion.key]

    def _compute_chunk_size(self) -> int:
        """Return the size of a chunk in bytes.

        At most two chunks are in transit.
        """
        return max(MIN_MEASURED_SIZE, self.line.room // 2)


class PageGroup:
    """A group of pages that receive the same messages."""

    def __init__(self) -> None:
        self._pages: dict[Page, None] = {}

    def __len__(self) -> int:
        return len(self._pages)

    def __contains__(self, page: Page) -> bool:
        return page in self._pages

    def __iter__(self) -> Iterator[Page]:
        return iter(tuple(self._pages))

    def add(self, page: Page) -> None:
        """Add a page to the group."""
        self._pages[page] = None

    def discard(self, page: Page) -> None:
        """Remove a page from the group, if it is a member."""
        self._pages.pop(page, None)

    def publish(self, message: ServerMessage) -> None:
        """Send a message to every page."""
        if self._pages:
            key = make_redundancy_key(message)
            texts = {language: encode(message, language) for language in {page.language for page in self._pages}}
            for page in self._pages:
                page.outbox.put(key, texts[page.language])

    def send_data(self, key: str, payload: Payload) -> None:
        """Send data of a display to every page.

        Data that is still queued under the same key is replaced.
        """
        for page in self._pages:
            page.outbox.put(key, payload)

    def send_transforms(self, frame: bytes) -> None:
        """Send a binary frame to every page."""
        for page in self._pages:
            page.outbox.put(TRANSFORMS, frame)


class Audience(PageGroup):
    """All open pages.

    Args:
        opening: returns the payloads for a new page, which contain the full current state.
        receivers: the functions that handle messages of pages, by the import path of the message class; other messages
            are ignored.
        on_page_closed: called when a page has closed.
        logger: logs invalid messages, and failures to handle a message.
    """

    def __init__(
        self,
        opening: Callable[[Page], list[Payload]],
        receivers: Mapping[str, Callable[[Page, Any], object]],
        on_page_closed: Callable[[Page], None],
        logger: Logger,
    ) -> None:
        super().__init__()
        self._opening = opening
        self._receivers = receivers
        self._on_page_closed = on_page_closed
        self._logger = logger
        self._sockets: set[WebSocketResponse] = set()
        self._reserved_slots = 0

    @property
    def is_full(self) -> bool:
        """Whether the maximum number of pages is open or being opened."""
        return len(self) + self._reserved_slots >= MAX_PAGES

    @contextmanager
    def expecting(self) -> Iterator[None]:
        """Reserve a slot for a page while its socket is opened.

        `attend` then uses the slot.
        """
        self._reserved_slots += 1
        try:
            yield
        finally:
            self._reserved_slots -= 1

    async def attend(self, page: Page, socket: WebSocketResponse) -> None:
        """Serve a page on its socket until the socket closes."""
        page.open(self._opening(page))
        self.add(page)
        self._sockets.add(socket)
        writer = asyncio.get_running_loop().create_task(page.write())
        try:
            await self._listen(page, socket)
        finally:
            self.discard(page)
            self._sockets.discard(socket)
            self._on_page_closed(page)
            page.close()
            writer.cancel()
            await asyncio.gather(writer, return_exceptions=True)

    async def close(self) -> None:
        """Close the connection to every page (1001, going away)."""
        closings = (socket.close(code=1001, message=b"the viewer is closing") for socket in list(self._sockets))
        await asyncio.gather(*closings, return_exceptions=True)

    async def _listen(self, page: Page, socket: WebSocketResponse) -> None:
        from linkwright.page.http_server import web

        remaining_invalid = _MAX_INVALID_MESSAGES
        rate_limit = RateLimit(asyncio.get_running_loop().time)
        async for message in socket:
            if message.type not in (web.WSMsgType.TEXT, web.WSMsgType.BINARY):
                continue
            if (delay := rate_limit.next_delay()) > 0:
                await asyncio.sleep(delay)
            if message.type is web.WSMsgType.BINARY:
                from linkwright.page.protocol.voice import unpack_sound

                sound = unpack_sound(message.data)
                if sound is None:
                    await socket.close(code=1003, message=b"pages send text, and sound in blocks")
                    return
                self._handle_message(page, sound)
                continue
            try:
                decoded = decode(message.data)
            except BadMessageError as error:
                self._logger.warning(f"A page sent an invalid message: {error}")
                remaining_invalid -= 1
                if remaining_invalid == 0:
                    await socket.close(code=1008, message=b"too many messages outside of the protocol")
                    return
            else:
                if isinstance(decoded, Received):
                    page.record_acknowledged(decoded.count)
                else:
                    self._handle_message(page, decoded)

    def _handle_message(self, page: Page, message: PageMessage | SoundBlock) -> None:
        receive = self._receivers.get(get_import_path(type(message)))
        if receive is None:
            return
        try:
            receive(page, message)
        except Exception as error:  # noqa: BLE001 - one message must not affect the page's other messages
            log_failure(self._logger, f"'{type(message).__name__}' of a page", error)


_MAX_RATE_HZ = 1000.0
_MAX_BURST = 4000.0
"""The number of messages that a page may send at once, such as the reports of all meshes of a large robot."""


class RateLimit:
    """A limit on the rate of messages of a page, so that the page cannot block other pages.

    Args:
        clock: returns the time in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._remaining_messages = _MAX_BURST
        self._last_time = clock()

    def next_delay(self) -> float:
        """Return the time in seconds by which the next message must be delayed."""
        now = self._clock()
        self._remaining_messages = (
            min(_MAX_BURST, self._remaining_messages + (now - self._last_time) * _MAX_RATE_HZ) - 1.0
        )
        self._last_time = now
        return max(0.0, -self._remaining_messages / _MAX_RATE_HZ)
