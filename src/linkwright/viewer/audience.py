"""The pages that are open, and what each is sent and sends."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from linkwright.viewer.outbox import TRANSFORMS, Outbox
from linkwright.viewer.protocol import PageMessage, ServerMessage
from linkwright.viewer.wire import BadMessageError, decode, encode, redundancy_key

if TYPE_CHECKING:
    from aiohttp.web import WebSocketResponse

    from linkwright.graph import Logger

MAXIMUM_PAGES = 32
"""Open at once; more are refused."""

_PATIENCE = 20
"""Messages outside of the protocol that a page may send before it is cut off."""


class Page:
    """One open page: its socket and its outbox."""

    def __init__(self, socket: WebSocketResponse, opening: Iterable[str | bytes]) -> None:
        self.outbox = Outbox()
        self._socket = socket
        self._opening = list(opening)

    def send(self, message: ServerMessage) -> None:
        """Have a message sent to this page only."""
        self.outbox.put(redundancy_key(message), encode(message))

    async def write(self) -> None:
        """Send the opening messages, then whatever comes into the outbox, until the socket is gone."""
        try:
            for payload in self._opening:
                await self._send(payload)
            self._opening.clear()
            while True:
                await self._send(await self.outbox.take())
        except ConnectionError:
            pass  # the reading side sees the end too, and tidies up

    async def _send(self, payload: str | bytes) -> None:
        if isinstance(payload, bytes):
            await self._socket.send_bytes(payload)
        else:
            await self._socket.send_str(payload)


class Audience:
    """All open pages.

    Args:
        opening: what a page is sent first, the whole state as it is.
        receive: called with each message of a page.
        logger: for messages that are none.
    """

    def __init__(
        self,
        opening: Callable[[], list[str | bytes]],
        receive: Callable[[Page, PageMessage], None],
        logger: Logger,
    ) -> None:
        self._opening = opening
        self._receive = receive
        self._logger = logger
        self._pages: dict[Page, WebSocketResponse] = {}

    def __len__(self) -> int:
        return len(self._pages)

    @property
    def is_full(self) -> bool:
        """Whether no more pages may come."""
        return len(self._pages) >= MAXIMUM_PAGES

    def publish(self, message: ServerMessage) -> None:
        """Send a message to every page."""
        if self._pages:
            key, text = redundancy_key(message), encode(message)
            for page in self._pages:
                page.outbox.put(key, text)

    def send_transforms(self, frame: bytes) -> None:
        """Send a binary frame to every page."""
        for page in self._pages:
            page.outbox.put(TRANSFORMS, frame)

    async def attend(self, socket: WebSocketResponse) -> None:
        """Serve a page until it goes."""
        page = Page(socket, self._opening())
        self._pages[page] = socket
        writer = asyncio.get_running_loop().create_task(page.write())
        try:
            await self._listen(page, socket)
        finally:
            del self._pages[page]
            writer.cancel()
            await asyncio.gather(writer, return_exceptions=True)

    async def close(self) -> None:
        """Say goodbye to every page (1001, going away)."""
        sockets = list(self._pages.values())
        await asyncio.gather(
            *(socket.close(code=1001, message=b"the viewer is closing") for socket in sockets), return_exceptions=True
        )

    async def _listen(self, page: Page, socket: WebSocketResponse) -> None:
        from aiohttp import WSMsgType

        patience = _PATIENCE
        async for message in socket:
            if message.type is WSMsgType.BINARY:
                await socket.close(code=1003, message=b"pages send text only")
                return
            if message.type is not WSMsgType.TEXT:
                continue
            try:
                decoded = decode(message.data)
            except BadMessageError as error:
                self._logger.warning(f"A page sent what is no message: {error}")
                patience -= 1
                if patience == 0:
                    await socket.close(code=1008, message=b"too many messages outside of the protocol")
                    return
            else:
                self._receive(page, decoded)
