"""The pages that are open, and what each is sent and sends."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING

from linkwright.graph import run_logged
from linkwright.viewer.line import Line
from linkwright.viewer.outbox import TRANSFORMS, Made, Outbox, Payload
from linkwright.viewer.pace import Pace
from linkwright.viewer.protocol import PageMessage, Received, ServerMessage
from linkwright.viewer.scaled_data import ScaledData
from linkwright.viewer.wire import BadMessageError, decode, encode, redundancy_key

if TYPE_CHECKING:
    from aiohttp.web import WebSocketResponse

    from linkwright.graph import Logger

MAXIMUM_PAGES = 32
"""Open at once; more are refused."""

_PATIENCE = 20
"""Messages outside of the protocol that a page may send before it is cut off."""

_QUIET = 0.3
"""Seconds of an idle line after which a page is sent more of what it has only a part of."""

_GENEROSITY = 4
"""So many times as much as a line is given otherwise may be sent over it while it is idle."""


class Page:
    """One open page: its socket and its outbox.

    Args:
        socket: of the page.
        own: by what the page names displays of its own; empty for one that shares those of all.
    """

    def __init__(self, socket: WebSocketResponse, own: str = "") -> None:
        self.outbox = Outbox()
        self.own = own
        self.line = Line()
        self._socket = socket
        self._reduced: dict[str, tuple[ScaledData, int]] = {}
        self._opening: list[Payload] = []
        self._rooms: dict[str, int] = {}
        self._completing: asyncio.TimerHandle | None = None

    def open(self, opening: Iterable[Payload]) -> None:
        """Say what is sent first."""
        self._opening = list(opening)

    def send(self, message: ServerMessage) -> None:
        """Have a message sent to this page only."""
        self.outbox.put(redundancy_key(message), encode(message))

    async def write(self) -> None:
        """Send the opening messages, then whatever comes into the outbox, until the socket is gone."""
        try:
            for payload in self._opening:
                made = self.outbox.make(payload)
                if made is not None:
                    await self._send(made)
            self._opening.clear()
            while True:
                await self._send(await self.outbox.take())
        except ConnectionError:
            pass  # the reading side sees the end too, and tidies up

    def received(self, count: int) -> None:
        """The page says how many messages it has."""
        self.line.received(count)
        self._line_changed()

    def close(self) -> None:
        """Complete nothing any more."""
        if self._completing is not None:
            self._completing.cancel()
            self._completing = None

    async def _send(self, payload: Made | ScaledData) -> None:
        if not isinstance(payload, (str, bytes)):
            payload = await self._fitted(payload)
        size = len(payload)
        began = self.line.sending(size)
        if isinstance(payload, bytes):
            await self._socket.send_bytes(payload)
        else:
            await self._socket.send_str(payload)
        self.line.sent(size, began)
        self._line_changed()

    async def _fitted(self, payload: ScaledData) -> bytes:
        """As much of a content as the line carries; the rest may follow when the line turns out to carry more."""
        room = max(self.line.room, self._rooms.pop(payload.key, 0))
        frame = await payload.fitting(room)
        if frame is payload.whole:
            self._reduced.pop(payload.key, None)
        else:
            self._reduced[payload.key] = (payload, room)
        return frame

    def _line_changed(self) -> None:
        self.outbox.hold(self.line.is_full)
        room = self.line.room
        for key, (payload, was) in list(self._reduced.items()):
            if payload.gone:
                del self._reduced[key]
            elif room >= 2 * was and key not in self.outbox:
                del self._reduced[key]
                self.outbox.put(key, payload)
        if not self.line.is_idle:
            self.close()
        elif self._reduced and self._completing is None:
            self._completing = asyncio.get_running_loop().call_later(_QUIET, self._complete)

    def _complete(self) -> None:
        """Send more of something that comes seldom: it may have been made small while the page was busy with others."""
        self._completing = None
        most = _GENEROSITY * self.line.room
        for key, (payload, was) in self._reduced.items():
            if was < most and key not in self.outbox:
                self._rooms[key] = min(2 * was, most)
                self.outbox.put(key, payload)
                return


class Circle:
    """Pages that are told the same."""

    def __init__(self) -> None:
        self._pages: dict[Page, None] = {}

    def __len__(self) -> int:
        return len(self._pages)

    def __contains__(self, page: Page) -> bool:
        return page in self._pages

    def add(self, page: Page) -> None:
        """Tell a page too, from now on."""
        self._pages[page] = None

    def discard(self, page: Page) -> None:
        """Tell a page no more."""
        self._pages.pop(page, None)

    def publish(self, message: ServerMessage) -> None:
        """Send a message to every page."""
        if self._pages:
            key, text = redundancy_key(message), encode(message)
            for page in self._pages:
                page.outbox.put(key, text)

    def send_data(self, key: str, payload: Payload) -> None:
        """Send what a display draws to every page; what waits under its key is dropped."""
        for page in self._pages:
            page.outbox.put(key, payload)

    def send_transforms(self, frame: bytes) -> None:
        """Send a binary frame to every page."""
        for page in self._pages:
            page.outbox.put(TRANSFORMS, frame)


class Audience(Circle):
    """All open pages.

    Args:
        opening: what a page is sent first, the whole state as it is.
        receive: called with each message of a page.
        gone: called when a page has gone.
        logger: for messages that are none.
    """

    def __init__(
        self,
        opening: Callable[[Page], list[Payload]],
        receive: Callable[[Page, PageMessage], None],
        gone: Callable[[Page], None],
        logger: Logger,
    ) -> None:
        super().__init__()
        self._opening = opening
        self._receive = receive
        self._gone = gone
        self._logger = logger
        self._sockets: set[WebSocketResponse] = set()
        self._expected = 0

    @property
    def is_full(self) -> bool:
        """Whether no more pages may come."""
        return len(self) + self._expected >= MAXIMUM_PAGES

    @contextmanager
    def expecting(self) -> Iterator[None]:
        """Keep a place for a page whose socket is being opened; `attend` takes it."""
        self._expected += 1
        try:
            yield
        finally:
            self._expected -= 1

    async def attend(self, socket: WebSocketResponse, own: str = "") -> None:
        """Serve a page until it goes; `own` is by what it names displays of its own."""
        page = Page(socket, own)
        page.open(self._opening(page))
        self.add(page)
        self._sockets.add(socket)
        writer = asyncio.get_running_loop().create_task(page.write())
        try:
            await self._listen(page, socket)
        finally:
            self.discard(page)
            self._sockets.discard(socket)
            self._gone(page)
            page.close()
            writer.cancel()
            await asyncio.gather(writer, return_exceptions=True)

    async def close(self) -> None:
        """Say goodbye to every page (1001, going away)."""
        goodbyes = (socket.close(code=1001, message=b"the viewer is closing") for socket in list(self._sockets))
        await asyncio.gather(*goodbyes, return_exceptions=True)

    async def _listen(self, page: Page, socket: WebSocketResponse) -> None:
        from aiohttp import WSMsgType

        patience = _PATIENCE
        pace = Pace()
        async for message in socket:
            if message.type is WSMsgType.BINARY:
                await socket.close(code=1003, message=b"pages send text only")
                return
            if message.type is not WSMsgType.TEXT:
                continue
            if (pause := pace.wait()) > 0:
                await asyncio.sleep(pause)
            try:
                decoded = decode(message.data)
            except BadMessageError as error:
                self._logger.warning(f"A page sent what is no message: {error}")
                patience -= 1
                if patience == 0:
                    await socket.close(code=1008, message=b"too many messages outside of the protocol")
                    return
            else:
                if isinstance(decoded, Received):
                    page.received(decoded.count)
                else:
                    run_logged(self._logger, f"'{decoded.type}' of a page", partial(self._receive, page, decoded))
