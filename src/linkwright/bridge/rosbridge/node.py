"""The node rosbridge_websocket, which serves the graph to clients of the rosbridge protocol by WebSocket."""

from __future__ import annotations

import asyncio
import errno
import socket
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import replace
from itertools import zip_longest
from typing import TYPE_CHECKING, Any

from linkwright.bridge.graph_updates import GraphUpdates
from linkwright.bridge.rosbridge.encodings import MessageEncoder
from linkwright.bridge.rosbridge.globs import Globs
from linkwright.bridge.rosbridge.offers import Offers
from linkwright.bridge.rosbridge.publications import Publications
from linkwright.bridge.rosbridge.services import ServiceCalls
from linkwright.bridge.rosbridge.session import Limits, Session, SharedResources
from linkwright.bridge.websockets.clients import Client
from linkwright.bridge.websockets.server import ServerOptions, WebSocketServer, make_listen_error, open_listener
from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.graph import LATCHED_QOS, Graph, ParameterDescriptor, Publisher
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import get_arguments, log_unknown_parameters

if TYPE_CHECKING:
    import ssl

_LOOPBACK = "127.0.0.1"
_SIZE_FACTOR = 4
"""A message of this many times the allowed size ends the connection; smaller ones are answered with a status."""
_MAX_QUEUE_BYTES = 20_000_000
_MIN_RETRY_S = 0.1
_REFUSAL_PERIOD_S = 10.0
_FILE_ORIGIN = "null"
_ROSAPI = "/rosapi/*"
"""The services that clients may always call."""
_ARGUMENTS: Mapping[str, Callable[[str], Any]] = {
    "port": int,
    "address": str,
    "url_path": str,
    "retry_startup_delay": float,
    "fragment_timeout": float,
    "delay_between_messages": float,
    "max_message_size": int,
    "unregister_timeout": float,
    "websocket_ping_interval": float,
    "websocket_ping_timeout": float,
    "topics_glob": str,
    "services_glob": str,
    "params_glob": str,
}
"""The parameters that arguments set, such as ``--port 9091``."""


class RosbridgeWebsocket(SingleNode):
    """The node rosbridge_websocket, with the parameters of the ROS node.

    The server listens on the loopback address unless `address` names another one, because every client that connects
    may publish, call services and set parameters.
    """

    DEFAULT_NAME = "rosbridge_websocket"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, _read_arguments(options), self.DEFAULT_NAME)
        self._sessions: dict[Session, Any] = {}
        self._server: WebSocketServer | None = None
        self._closing: Awaitable[None] | None = None
        with handle_start_errors(self._node):
            self._resources = self._create_resources()
            self._options = self._read_server_options()
            self._port = int(self._declare("port", 9090))
            self._host = str(self._declare("address", "")) or _LOOPBACK
            self._retry_s = float(self._declare("retry_startup_delay", 2.0))
            self._listener = self._listen()
            log_unknown_parameters(self._node)
        self._counts: Publisher[Any] = self._node.create_publisher("std_msgs/msg/Int32", "client_count", LATCHED_QOS)
        self._clients: Publisher[Any] = self._node.create_publisher(
            "rosbridge_msgs/msg/ConnectedClients", "connected_clients", LATCHED_QOS
        )
        self._publish_clients()
        self._updates = GraphUpdates(graph, self._node, self._update)
        graph.publishers()  # starts the discovery of other processes
        self._server_task = asyncio.get_running_loop().create_task(self._serve())

    @property
    def address(self) -> str:
        """The address that clients connect to; empty while the server does not listen."""
        return "" if self._server is None else self._server.address

    def close(self) -> None:
        """Close the connections and the server."""
        self._updates.close()
        for session in list(self._sessions):
            session.close()
        self._sessions.clear()
        self._resources.publications.close_all()
        self._server_task.cancel()
        if self._server is not None:
            self._closing = self._server.close()
        elif self._listener is not None:
            self._listener.close()
        super().close()

    # --- parameters --------------------------------------------------------------------------------------------

    def _declare(self, name: str, default: Any) -> Any:
        return self._node.declare_parameter(name, default, ParameterDescriptor(dynamic_typing=True)).value

    def _create_resources(self) -> SharedResources:
        node = self._node
        bson_only = bool(self._declare("bson_only_mode", False))
        for name in ("call_services_in_new_thread", "send_action_goals_in_new_thread"):
            self._declare(name, True)  # calls and goals never wait for each other here
        self._declare("params_glob", "")

        def read_time() -> Any:
            return node.get_clock().now().to_msg()

        return SharedResources(
            node=node,
            limits=Limits(
                int(self._declare("max_message_size", 10_000_000)), float(self._declare("fragment_timeout", 600))
            ),
            publications=Publications(node, float(self._declare("unregister_timeout", 10.0))),
            calls=ServiceCalls(node, float(self._declare("default_call_service_timeout", 5.0)), read_time),
            encoder=MessageEncoder(bson_only=bson_only),
            topic_globs=Globs(self._declare("topics_glob", "")),
            service_globs=Globs(self._declare("services_glob", ""), (_ROSAPI,)),
            services=Offers("Service"),
            actions=Offers("Action"),
            bson_only=bson_only,
        )

    def _read_server_options(self) -> ServerOptions:
        interval_s = float(self._declare("websocket_ping_interval", 0.0))
        timeout_s = float(self._declare("websocket_ping_timeout", 30.0))
        certificate, key = str(self._declare("certfile", "")), str(self._declare("keyfile", ""))
        return ServerOptions(
            "a program for rosbridge, such as a page with roslibjs",
            path=str(self._declare("url_path", "/")) or "/",
            origins=list(self._declare("allowed_origins", [""])),
            ping_interval=interval_s or None,
            ping_timeout=timeout_s or None,
            compresses=bool(self._declare("use_compression", False)),
            max_message_size=_SIZE_FACTOR * self._resources.limits.message_size,
            max_queue_bytes=_MAX_QUEUE_BYTES,
            send_delay=float(self._declare("delay_between_messages", 0.0)),
            tls=_load_certificate(certificate, key) if certificate and key else None,
        )

    # --- the server --------------------------------------------------------------------------------------------

    def _listen(self) -> socket.socket | None:
        """Open the listening socket, or return None if another program uses the port.

        Raises:
            LinkwrightError: NODE702, the address or port cannot be used.
        """
        try:
            return open_listener(self._host, self._port)
        except OSError as error:
            if error.errno == errno.EADDRINUSE:
                return None
            hint = phrase("choose an address of this machine with the parameter 'address'")
            raise make_listen_error(self.DEFAULT_NAME, self._host, self._port, error, hint) from None

    async def _serve(self) -> None:
        logger = self._node.get_logger()
        while self._listener is None:
            logger.warning(
                f"Unable to start server: port {self._port} of {self._host} is in use. Retrying in {self._retry_s:g} s."
            )
            await asyncio.sleep(max(self._retry_s, _MIN_RETRY_S))
            self._listener = self._listen()
        port = self._listener.getsockname()[1]
        self._server = WebSocketServer(self._listener, self._options, self._add_client, self._on_refused)
        self._node.declare_parameter("actual_port", port)
        await self._server.start()
        logger.info(f"Rosbridge WebSocket server started on port {port}: {self.address}")
        if self._host == _LOOPBACK:
            logger.info("Clients on other machines can connect if the parameter 'address' is '0.0.0.0'.")

    def _add_client(
        self, client: Client, ip_address: str
    ) -> tuple[Callable[[str | bytes], object], Callable[[], object]]:
        session = Session(self._resources, client)
        connected = get_message("rosbridge_msgs/msg/ConnectedClient")(
            ip_address=ip_address, connection_time=self._node.get_clock().now().to_msg()
        )
        self._sessions[session] = connected
        self._publish_clients()
        self._node.get_logger().info(f"Client connected. {len(self._sessions)} clients total.")

        def end() -> None:
            if self._sessions.pop(session, None) is not None:
                session.close()
                self._publish_clients()
                self._node.get_logger().info(f"Client disconnected. {len(self._sessions)} clients total.")

        return session.receive, end

    def _on_refused(self, origin: str) -> None:
        page = "A page that was opened from a file" if origin == _FILE_ORIGIN else f"A page of {origin[:200]}"
        self._node.get_logger().warning(
            f"{page} was refused, because any page could control the robot otherwise. To let it connect, serve it on "
            f"this machine (python -m http.server), or set the parameter allowed_origins:=['{origin[:200]}'].",
            throttle_duration_sec=_REFUSAL_PERIOD_S,
        )

    def _publish_clients(self) -> None:
        self._counts.publish(self._counts.msg_type(data=len(self._sessions)))
        self._clients.publish(self._clients.msg_type(clients=list(self._sessions.values())))

    # --- the graph ---------------------------------------------------------------------------------------------

    def _update(self) -> None:
        self._resources.calls.drop_gone()
        for session in self._sessions:
            session.on_graph_changed()


def _read_arguments(options: NodeOptions) -> NodeOptions:
    """Return the options with the parameters that arguments such as ``--port 9091`` set.

    Raises:
        LinkwrightError: NODE432, an argument is unknown or has no valid value.
    """
    arguments = get_arguments(options)
    parameters: dict[str, Any] = {}
    usage = phrase("usage: {usage}", usage="rosbridge_websocket [--port PORT] [--address ADDRESS] ...")
    for name, value in zip_longest(arguments[::2], arguments[1::2]):
        convert = _ARGUMENTS.get(name.removeprefix("--")) if name.startswith("--") else None
        if convert is None or value is None:
            message = phrase("unexpected argument '{argument}'", argument=name)
            raise LinkwrightError(Diagnostic("NODE432", message, hint=usage))
        try:
            parameters[name.removeprefix("--")] = convert(value)
        except ValueError:
            message = phrase("'{text}' is not a valid value for '{name}'", text=value, name=name)
            raise LinkwrightError(Diagnostic("NODE432", message, hint=usage)) from None
    return replace(options, parameters={**options.parameters, **parameters})


def _load_certificate(certificate: str, key: str) -> ssl.SSLContext:
    """Return the settings for encrypted connections.

    Raises:
        LinkwrightError: NODE704, a file cannot be read, or is not a certificate or key.
    """
    import ssl

    context = ssl.create_default_context(ssl.Purpose.CLIENT_AUTH)
    try:
        context.load_cert_chain(certificate, key)
    except (OSError, ValueError) as error:
        message = phrase(
            "rosbridge_websocket cannot use the certificate '{certificate}' with the key '{key}': {reason}",
            certificate=certificate,
            key=key,
            reason=foreign(getattr(error, "strerror", None) or str(error)),
        )
        raise LinkwrightError(Diagnostic("NODE704", message)) from None
    return context
