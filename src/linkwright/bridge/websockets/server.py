"""A WebSocket server on one port, which runs in the event loop of the nodes."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Awaitable, Callable, Collection
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from linkwright.bridge.websockets.clients import Client
from linkwright.bridge.websockets.origins import is_allowed_origin
from linkwright.bridge.websockets.pings import Pings
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, phrase

if TYPE_CHECKING:
    import ssl

    from aiohttp import web

_MAX_CLIENTS = 32


@dataclass(frozen=True, slots=True)
class ServerOptions:
    """The options of a server.

    Attributes:
        clients: the programs that connect, for responses to browsers that open the address.
        path: the path of the address.
        protocols: the subprotocols, one of which a client must support; empty if there are none.
        origins: further origins of web pages that may connect.
        ping_interval: the seconds between pings; None for no pings.
        ping_timeout: the seconds after which a client that sends nothing, not even the answers to pings, is
            disconnected; None for half of `ping_interval`. It has no effect without pings.
        compresses: whether frames are compressed if the client agrees.
        max_message_size: the maximum size of a message, in bytes. A longer one ends the connection.
        max_queue_bytes: the maximum size of the queue of topic messages for a client.
        send_delay: the seconds to wait after each frame.
        tls: the certificate for encrypted connections; None for plain ones.
    """

    clients: str
    path: str = "/"
    protocols: Collection[str] = ()
    origins: Collection[str] = ()
    ping_interval: float | None = 15.0
    ping_timeout: float | None = None
    compresses: bool = False
    max_message_size: int = 16 << 20
    max_queue_bytes: int = 10_000_000
    send_delay: float = 0.0
    tls: ssl.SSLContext | None = None


class WebSocketServer:
    """A server on a listening socket.

    Args:
        listener: the socket, which the server closes.
        options: the options of the server.
        on_client: called with each new client and its IP address; serves the client by returning the function to call
            with each message. The second function that it returns is called at the end of the connection.
        on_refused: called with the origin of a page that may not connect.
    """

    def __init__(
        self,
        listener: socket.socket,
        options: ServerOptions,
        on_client: Callable[[Client, str], tuple[Callable[[str | bytes], object], Callable[[], object]]],
        on_refused: Callable[[str], object] | None = None,
    ) -> None:
        self._listener = listener
        self._options = options
        self._on_client = on_client
        self._on_refused = on_refused
        self._client_count = 0
        self._loop = asyncio.get_running_loop()
        self._runner: web.AppRunner | None = None
        self._server: asyncio.Server | None = None

    @property
    def address(self) -> str:
        """The address that clients connect to."""
        host, port = self._listener.getsockname()[:2]
        scheme = "ws" if self._options.tls is None else "wss"
        path = "" if self._options.path == "/" else self._options.path
        return f"{scheme}://[{host}]:{port}{path}" if ":" in host else f"{scheme}://{host}:{port}{path}"

    async def start(self) -> None:
        """Accept connections."""
        from linkwright.page.http_server import SERVER_LOGGER, web

        application = web.Application()
        application.router.add_get(self._options.path, self._on_connection)
        self._runner = web.AppRunner(
            application, handle_signals=False, access_log=None, logger=SERVER_LOGGER, shutdown_timeout=0.5
        )
        await self._runner.setup()
        serve = cast("web.Server", self._runner.server)
        self._server = await self._loop.create_server(
            serve, sock=self._listener, ssl=self._options.tls, start_serving=False
        )
        await self._server.start_serving()

    def close(self) -> Awaitable[None] | None:
        """Close the listening socket at once, because the event loop may end before a callback runs.

        Returns:
            What waits until all connections are closed; None if the server was not started.
        """
        (self._server or self._listener).close()
        return None if self._runner is None else self._loop.create_task(self._runner.cleanup())

    async def _on_connection(self, request: web.Request) -> web.StreamResponse:
        from linkwright.page.http_server import web

        options = self._options
        origin = request.headers.get("Origin")
        if not is_allowed_origin(origin, options.origins, request.host):
            if self._on_refused is not None:
                self._on_refused(str(origin))
            return web.Response(status=403, text="Pages of other sites may not connect.\n")
        if self._client_count >= _MAX_CLIENTS:
            return web.Response(status=503, text="Too many clients are connected.\n")
        websocket = web.WebSocketResponse(
            protocols=options.protocols,
            heartbeat=options.ping_interval if options.ping_timeout is None else None,
            autoping=options.ping_timeout is None,
            timeout=0.5,
            compress=options.compresses,
            max_msg_size=options.max_message_size,
        )
        if not websocket.can_prepare(request).ok:
            return web.Response(status=426, text=f"Open this address in {options.clients}.\n")
        await websocket.prepare(request)
        if options.protocols and websocket.ws_protocol is None:
            await websocket.close(code=1002, message=b"the client supports none of the subprotocols")
            return websocket
        await self._serve(websocket, str(request.remote or ""))
        return websocket

    async def _serve(self, websocket: web.WebSocketResponse, ip_address: str) -> None:
        from linkwright.page.http_server import web

        client = Client(websocket, self._options.max_queue_bytes, self._options.send_delay)
        receive, end = self._on_client(client, ip_address)
        self._client_count += 1
        pings = Pings(websocket, self._options.ping_interval, self._options.ping_timeout)
        tasks = [self._loop.create_task(client.write()), self._loop.create_task(pings.send())]
        try:
            async for message in websocket:
                pings.on_message()
                if message.type in (web.WSMsgType.TEXT, web.WSMsgType.BINARY):
                    receive(message.data)
                elif message.type is web.WSMsgType.PING:
                    await websocket.pong(message.data)
        finally:
            self._client_count -= 1
            end()
            for task in tasks:
                task.cancel()
            with suppress(asyncio.CancelledError):
                await asyncio.gather(*tasks, return_exceptions=True)


def open_listener(address: str, port: int) -> socket.socket:
    """Return a listening socket.

    Raises:
        OSError: the address or port cannot be used.
    """
    try:
        listener = socket.create_server((address, port), family=socket.AF_INET6 if ":" in address else socket.AF_INET)
    except OverflowError as error:
        raise OSError(str(error)) from None
    listener.setblocking(False)
    return listener


def make_listen_error(node: str, address: str, port: int, error: OSError, hint: Phrase) -> LinkwrightError:
    """Return the error NODE702 for an address or port that a node cannot listen on."""
    message = phrase(
        "{node} cannot listen on port {port} of '{address}': {reason}",
        node=node,
        port=port,
        address=address,
        reason=foreign(error.strerror or str(error)),
    )
    return LinkwrightError(Diagnostic("NODE702", message, hint=hint))
