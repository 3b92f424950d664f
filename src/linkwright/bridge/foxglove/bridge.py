"""The node foxglove_bridge: serves the graph to Foxglove and Lichtblick by WebSocket."""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, cast

from linkwright.bridge.foxglove.assets import Assets
from linkwright.bridge.foxglove.clients import Client
from linkwright.bridge.foxglove.names import NameFilter
from linkwright.bridge.foxglove.origins import is_allowed_origin
from linkwright.bridge.foxglove.parameters import Parameters, make_parameter_entry
from linkwright.bridge.foxglove.protocol import ENCODING, SUBPROTOCOLS, encode_time
from linkwright.bridge.foxglove.services import Services
from linkwright.bridge.foxglove.session import Session, SharedResources
from linkwright.bridge.foxglove.topics import Channels
from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.graph import DESCRIPTION_QOS, Graph
from linkwright.messages import String
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

if TYPE_CHECKING:
    from aiohttp import web

_CAPABILITIES = ("clientPublish", "parameters", "parametersSubscribe", "services", "connectionGraph", "assets")
_MATCH_ALL = [".*"]
_MAX_CLIENTS = 32
_MAX_MESSAGE_SIZE = 16 << 20
_UPDATE_DELAY_S = 0.1
"""Seconds for which changes to the graph are collected before clients are notified."""


class FoxgloveBridge(SingleNode):
    """The node foxglove_bridge, with the supported subset of the ROS node's parameters.

    The server binds the loopback address unless `address` names another one, because every client that connects may
    publish, call services and set parameters.
    """

    DEFAULT_NAME = "foxglove_bridge"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            declare = self._node.declare_parameter
            port, address = int(declare("port", 8765).value), str(declare("address", "127.0.0.1").value)
            filters = {
                name: NameFilter(name, list(declare(name, _MATCH_ALL).value))
                for name in ("topic_whitelist", "service_whitelist", "param_whitelist", "client_topic_whitelist")
            }
            self._origins: Sequence[str] = list(declare("allowed_origins", [""]).value)
            self._max_queue_bytes = int(declare("send_buffer_limit", 10_000_000).value)
            self._listener = _listen(address, port)
        self._resources = SharedResources(
            node=self._node,
            channels=Channels(self._node, filters["topic_whitelist"]),
            services=Services(self._node, filters["service_whitelist"]),
            parameters=Parameters(self._node, filters["param_whitelist"]),
            assets=Assets(),
            publishable=filters["client_topic_whitelist"],
        )
        self._capabilities = list(_CAPABILITIES)
        self._sessions: dict[Session, None] = {}
        self._loop = asyncio.get_running_loop()
        self._runner: web.AppRunner | None = None
        self._server: asyncio.Server | None = None
        self._update_timer: asyncio.TimerHandle | None = None
        self._identity = str(time.time_ns())
        self._watch_graph(graph)
        self._server_task = self._loop.create_task(self._serve())

    @property
    def address(self) -> str:
        """The address that clients connect to."""
        host, port = self._listener.getsockname()[:2]
        return f"ws://[{host}]:{port}" if ":" in host else f"ws://{host}:{port}"

    def close(self) -> None:
        """Close the connections and the server."""
        self._graph.unwatch(self._on_graph_change)
        if self._update_timer is not None:
            self._update_timer.cancel()
        for session in list(self._sessions):
            session.close()
        self._resources.parameters.close()
        self._server_task.cancel()
        (self._server or self._listener).close()  # not in a callback, which may not run before the loop ends
        if self._runner is not None:
            self._cleanup_task = self._loop.create_task(self._runner.cleanup())
        super().close()

    # --- the graph ---------------------------------------------------------------------------------------------

    def _watch_graph(self, graph: Graph) -> None:
        self._graph = graph
        node = self._node
        graph.watch(self._on_graph_change)
        node.create_subscription(
            String,
            "/robot_description",
            lambda message: self._resources.assets.allow_packages_in(message.data),
            DESCRIPTION_QOS,
        )
        node.create_subscription(
            "rcl_interfaces/msg/ParameterEvent", "/parameter_events", self._on_parameter_event, 100
        )
        if node.get_parameter("use_sim_time").value:
            self._capabilities.append("time")
            node.create_subscription("rosgraph_msgs/msg/Clock", "/clock", self._on_clock, 10)
        self._resources.channels.poll_changes()
        self._resources.services.poll_changes()

    def _on_graph_change(self) -> None:
        with suppress(RuntimeError):  # the event loop was closed
            self._loop.call_soon_threadsafe(self._schedule_update)

    def _schedule_update(self) -> None:
        if self._update_timer is None and not self._node.handle.is_destroyed:
            self._update_timer = self._loop.call_later(_UPDATE_DELAY_S, self._send_updates)

    def _send_updates(self) -> None:
        self._update_timer = None
        channels, removed_channels = self._resources.channels.poll_changes()
        services, removed_services = self._resources.services.poll_changes()
        messages: list[dict[str, Any]] = []
        if removed_channels:
            messages.append({"op": "unadvertise", "channelIds": removed_channels})
        if channels:
            messages.append({"op": "advertise", "channels": [channel.advertisement() for channel in channels]})
        if removed_services:
            messages.append({"op": "unadvertiseServices", "serviceIds": removed_services})
        if services:
            messages.append({"op": "advertiseServices", "services": [service.advertisement() for service in services]})
        for session in self._sessions:
            for message in messages:
                session.client.send(message)
            session.on_graph_changed(removed_channels)

    def _on_parameter_event(self, event: Any) -> None:
        from linkwright.graph.parameters.files import plain_value

        watching = [session for session in self._sessions if session.parameters]
        if not watching:
            return
        entries = [
            make_parameter_entry(f"{event.node}.{new_parameter.name}", plain_value(new_parameter.value))
            for new_parameter in (*event.new_parameters, *event.changed_parameters)
        ]
        for session in watching:
            client_entries = [parameter for parameter in entries if parameter["name"] in session.parameters]
            if client_entries:
                session.client.send({"op": "parameterValues", "parameters": client_entries})

    def _on_clock(self, message: Any) -> None:
        frame = encode_time(message.clock.nanoseconds)
        for session in self._sessions:
            session.client.send_data(frame)

    # --- the network -------------------------------------------------------------------------------------------

    async def _serve(self) -> None:
        from linkwright.page.http_server import SERVER_LOGGER, web

        application = web.Application()
        application.router.add_get("/", self._on_connection)
        self._runner = web.AppRunner(
            application, handle_signals=False, access_log=None, logger=SERVER_LOGGER, shutdown_timeout=0.5
        )
        await self._runner.setup()
        serve = cast("web.Server", self._runner.server)
        self._server = await self._loop.create_server(serve, sock=self._listener, start_serving=False)
        await self._server.start_serving()
        self._node.get_logger().info(f"Foxglove and Lichtblick connect to {self.address}")

    async def _on_connection(self, request: web.Request) -> web.StreamResponse:
        from linkwright.page.http_server import web

        if not is_allowed_origin(request.headers.get("Origin"), self._origins):
            return web.Response(status=403, text="Pages of other sites may not connect.\n")
        if len(self._sessions) >= _MAX_CLIENTS:
            return web.Response(status=503, text="Too many clients are connected.\n")
        websocket = web.WebSocketResponse(
            protocols=SUBPROTOCOLS, heartbeat=15.0, timeout=0.5, compress=False, max_msg_size=_MAX_MESSAGE_SIZE
        )
        if not websocket.can_prepare(request).ok:
            return web.Response(status=426, text="Open this address in Foxglove or Lichtblick.\n")
        await websocket.prepare(request)
        if websocket.ws_protocol is None:
            await websocket.close(code=1002, message=b"the client supports none of the subprotocols")
            return websocket
        client = Client(websocket, self._max_queue_bytes)
        session = Session(self._resources, client)
        self._greet(client)
        self._sessions[session] = None
        writer = asyncio.get_running_loop().create_task(client.write())
        try:
            async for message in websocket:
                if message.type in (web.WSMsgType.TEXT, web.WSMsgType.BINARY):
                    session.receive(message.data)
        finally:
            self._sessions.pop(session, None)
            session.close()
            writer.cancel()
            await asyncio.gather(writer, return_exceptions=True)
        return websocket

    def _greet(self, client: Client) -> None:
        client.send(
            {
                "op": "serverInfo",
                "name": "linkwright",
                "capabilities": self._capabilities,
                "supportedEncodings": [ENCODING],
                "metadata": {"ROS_DISTRO": "jazzy"},
                "sessionId": self._identity,
            }
        )
        client.send(
            {"op": "advertise", "channels": [channel.advertisement() for channel in self._resources.channels.all()]}
        )
        client.send(
            {
                "op": "advertiseServices",
                "services": [offered_service.advertisement() for offered_service in self._resources.services.all()],
            }
        )


def _listen(address: str, port: int) -> socket.socket:
    """Open a listening socket.

    Raises:
        LinkwrightError: NODE702, the address or port cannot be used.
    """
    try:
        listener = socket.create_server((address, port), family=socket.AF_INET6 if ":" in address else socket.AF_INET)
    except (OSError, OverflowError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        message = phrase(
            "foxglove_bridge cannot listen on port {port} of '{address}': {reason}",
            port=port,
            address=address,
            reason=foreign(reason),
        )
        hint = phrase("choose another port with the parameter 'port', or with '--foxglove'")
        raise LinkwrightError(Diagnostic("NODE702", message, hint=hint)) from None
    listener.setblocking(False)
    return listener
