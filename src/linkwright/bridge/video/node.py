"""The node web_video_server: shows the images of topics to browsers by HTTP.

Source: web_video_server 2 for ROS 2 (parameters, defaults, addresses, their queries, log messages). Deliberate
differences: the server listens on the loopback address unless ``address`` names another one, and pages of other sites
cannot read images; the streams ``vp8``, ``vp9`` and ``h264`` are missing; depths are scaled from the minimum to the
maximum of an image; a snapshot can be a PNG; a request that cannot be answered gets a sentence that says why.
"""

from __future__ import annotations

import asyncio
import errno
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

from linkwright.bridge.video.frames import Frame
from linkwright.bridge.video.pages import write_list, write_viewer
from linkwright.bridge.video.requests import (
    MISSING_STREAM_TYPES,
    MJPEG,
    PNG,
    QOS_PROFILES,
    ROS_COMPRESSED,
    STREAM_TYPES,
    BadQueryError,
    ImageRequest,
)
from linkwright.bridge.video.streams import ImageStream, find_image_topics, find_source
from linkwright.bridge.websockets.origins import is_allowed_origin
from linkwright.bridge.websockets.server import make_listen_error, open_listener
from linkwright.diagnostics import install_hint, phrase
from linkwright.diagnostics.translation import localized
from linkwright.graph import Graph
from linkwright.images import BadImageError
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import invalid_value_error, log_unknown_parameters
from linkwright.page.access import Gate, create_token

if TYPE_CHECKING:
    from linkwright.page.http_server import web

_LOOPBACK = "127.0.0.1"
_BOUNDARY = "boundarydonotcross"
_HEADERS = {
    "Server": "web_video_server",
    "Cache-Control": "no-cache, no-store, must-revalidate, max-age=0",
    "Pragma": "no-cache",
}
_ERROR_PERIOD_S = 40.0


class WebVideoServer(SingleNode):
    """The node web_video_server, with the parameters of the ROS node.

    Raises:
        LinkwrightError: ``default_stream_type`` is unknown (NODE433), a parameter has another type (GRAPH201), or the
            address or port cannot be used (NODE702).
    """

    DEFAULT_NAME = "web_video_server"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            declare = self._node.declare_parameter
            port: int = declare("port", 8080).value
            self._is_verbose: bool = declare("verbose", True).value
            self._host: str = declare("address", _LOOPBACK).value
            for name, default in (("server_threads", 1), ("ros_threads", 2)):
                declare(name, default)  # all requests are answered in the event loop, which needs no threads
            publish_rate_hz: float = declare("publish_rate", -1.0).value
            self._default_type = self._read_default_type()
            log_unknown_parameters(self._node)
            try:
                self._listener = open_listener(self._host, port)
            except OSError as error:
                hint = phrase("choose an address of this machine with the parameter 'address'")
                if error.errno == errno.EADDRINUSE:
                    hint = phrase("choose another port with the parameter 'port'")
                raise make_listen_error(self.DEFAULT_NAME, self._host, port, error, hint) from None
        self._gate = Gate(self._host, create_token())
        self._period_s = 1.0 / publish_rate_hz if publish_rate_hz > 0 else None
        self._request_tasks: set[asyncio.Task[Any]] = set()
        self._runner: web.AppRunner | None = None
        self._server: asyncio.Server | None = None
        graph.publishers()  # starts the discovery of other processes
        self._server_task = asyncio.get_running_loop().create_task(self._serve())

    @property
    def address(self) -> str:
        """The address of the list of topics."""
        host, port = self._listener.getsockname()[:2]
        return f"http://[{host}]:{port}/" if ":" in host else f"http://{host}:{port}/"

    def close(self) -> None:
        """Close the connections and the server."""
        self._server_task.cancel()
        for task in self._request_tasks:  # aiohttp logs an error for those that last until the event loop ends
            task.cancel()
        (self._server or self._listener).close()
        if self._runner is not None:
            self._cleanup_task = asyncio.get_running_loop().create_task(self._runner.cleanup())
        super().close()

    def _read_default_type(self) -> str:
        name = "default_stream_type"
        value: str = self._node.declare_parameter(name, MJPEG).value
        if value in MISSING_STREAM_TYPES:
            warning = phrase("streams of type '{type}' are not supported: '{other}' is used", type=value, other=MJPEG)
            self._node.get_logger().warning(localized(warning))
            return MJPEG
        if value not in STREAM_TYPES:
            raise invalid_value_error(name, value, self._node.get_name(), STREAM_TYPES)
        return value

    async def _serve(self) -> None:
        from linkwright.page.http_server import SERVER_LOGGER, web

        application = web.Application()
        for path, handler in (
            ("/", self._on_list),
            ("/stream", self._on_stream),
            ("/stream_viewer", self._on_viewer),
            ("/snapshot", self._on_snapshot),
        ):
            application.router.add_get(path, self._make_handler(handler), allow_head=False)
        self._runner = web.AppRunner(
            application,
            handle_signals=False,
            handler_cancellation=True,  # ends a stream without images when its client leaves
            access_log=None,
            logger=SERVER_LOGGER,
            shutdown_timeout=0.5,
        )
        await self._runner.setup()
        serve = cast("web.Server", self._runner.server)
        self._server = await asyncio.get_running_loop().create_server(serve, sock=self._listener, start_serving=False)
        await self._server.start_serving()
        logger = self._node.get_logger()
        host, port = self._listener.getsockname()[:2]
        logger.info(f"Waiting For connections on {host}:{port}")
        if self._host == _LOOPBACK:
            logger.info("Browsers on other machines can connect if the parameter 'address' is '0.0.0.0'.")

    # --- requests ----------------------------------------------------------------------------------------------

    def _make_handler(
        self, handler: Callable[[web.Request], Awaitable[web.StreamResponse]]
    ) -> Callable[[web.Request], Awaitable[web.StreamResponse]]:
        async def handle(request: web.Request) -> web.StreamResponse:
            if self._host == _LOOPBACK and not self._gate.accepts_host(request.host):
                return self._refuse(f"this server does not answer to the name '{request.host[:200]}'", 403)
            task = asyncio.current_task()
            assert task is not None
            self._request_tasks.add(task)
            if self._is_verbose:
                self._node.get_logger().info(f"Handling Request: {request.path_qs}")
            try:
                return await handler(request)
            except BadQueryError as error:
                return self._refuse(str(error), 400)
            except BadImageError as error:
                return self._refuse(str(error), 500)
            except ModuleNotFoundError:
                return self._refuse(f"JPEG and PNG files need Pillow; {install_hint('image')}", 500)
            finally:
                self._request_tasks.discard(task)

        return handle

    def _refuse(self, reason: str, status: int) -> web.Response:
        from linkwright.page.http_server import web

        self._node.get_logger().warning(f"Error Handling Request: {reason}", throttle_duration_sec=_ERROR_PERIOD_S)
        return web.Response(status=status, text=f"{reason}\n", headers=_HEADERS)

    async def _on_list(self, request: web.Request) -> web.StreamResponse:
        from linkwright.page.http_server import web

        text = write_list(find_image_topics(self._node))
        return web.Response(text=text, content_type="text/html", headers=_HEADERS)

    async def _on_viewer(self, request: web.Request) -> web.StreamResponse:
        from linkwright.page.http_server import web

        topic = ImageRequest.of(request.query, self._default_type).topic
        return web.Response(text=write_viewer(topic, request.query_string), content_type="text/html", headers=_HEADERS)

    async def _on_snapshot(self, request: web.Request) -> web.StreamResponse:
        from linkwright.page.http_server import web

        query = dict(request.query)
        query["type"] = PNG if query.get("type") == PNG else MJPEG
        stream = self._open_stream(ImageRequest.of(query, MJPEG))
        try:
            frame, stamp = await stream.next()
        finally:
            stream.close()
        headers = {**_make_headers(request), "X-Timestamp": f"{stamp:.6f}"}
        return web.Response(body=frame.data, content_type=frame.content_type, headers=headers)

    async def _on_stream(self, request: web.Request) -> web.StreamResponse:
        from linkwright.page.http_server import web

        stream = self._open_stream(ImageRequest.of(request.query, self._default_type))
        try:
            frame, stamp = await stream.next()
            content_type = f"multipart/x-mixed-replace;boundary={_BOUNDARY}"
            response = web.StreamResponse(headers={**_make_headers(request), "Content-Type": content_type})
            await response.prepare(request)
            await response.write(f"--{_BOUNDARY}\r\n".encode())
            with suppress(ConnectionError):
                while True:
                    await response.write(_make_part(frame, stamp))
                    frame, stamp = await self._next_good(stream)
            return response
        finally:
            stream.close()

    async def _next_good(self, stream: ImageStream) -> tuple[Frame, float]:
        """Wait for the next image of a stream that can be shown."""
        while True:
            try:
                return await stream.next(self._period_s)
            except BadImageError as error:  # noqa: PERF203 - encoding an image takes longer
                self._node.get_logger().error(str(error), throttle_duration_sec=_ERROR_PERIOD_S)
                stream.skip()

    def _open_stream(self, request: ImageRequest) -> ImageStream:
        """Subscribe to the topic of a request.

        Raises:
            BadQueryError: there is no such topic.
        """
        logger = self._node.get_logger()
        source = find_source(self._node, request)
        if source is None and request.type == ROS_COMPRESSED:
            logger.warning(f"Could not find compressed image topic for {request.topic}, falling back to mjpeg")
            request = replace(request, type=MJPEG)
            source = find_source(self._node, request)
        if source is None:
            raise BadQueryError(f"No topic '{request.topic}' has images; see {self.address} for those that have")
        logger.info(f"Streaming topic {source.topic} with QoS profile {request.qos_name}")
        if request.qos_name not in QOS_PROFILES:
            logger.error(f"Invalid QoS profile {request.qos_name} specified. Using default profile.")
        return ImageStream(self._node, source, request)


def _make_part(frame: Frame, stamp: float) -> bytes:
    """Return a part of a stream, with the boundary after it."""
    header = (
        f"Content-Type: {frame.content_type}\r\nX-Timestamp: {stamp:.6f}\r\nContent-Length: {len(frame.data)}\r\n\r\n"
    )
    return b"".join([header.encode(), frame.data, f"\r\n--{_BOUNDARY}\r\n".encode()])


def _make_headers(request: web.Request) -> dict[str, str]:
    """Return the headers of a response with images, which pages of this machine may read."""
    origin = request.headers.get("Origin")
    if origin is None or not is_allowed_origin(origin, host=request.host):
        return _HEADERS
    return {**_HEADERS, "Access-Control-Allow-Origin": origin, "Vary": "Origin"}
