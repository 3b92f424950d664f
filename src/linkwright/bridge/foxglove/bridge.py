"""The node foxglove_bridge: serves the graph to Foxglove and Lichtblick by WebSocket."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import Any

from linkwright.bridge.foxglove.assets import Assets
from linkwright.bridge.foxglove.names import NameFilter
from linkwright.bridge.foxglove.parameters import Parameters, make_parameter_entry
from linkwright.bridge.foxglove.protocol import ENCODING, SUBPROTOCOLS, encode_time
from linkwright.bridge.foxglove.services import Services
from linkwright.bridge.foxglove.session import Session, SharedResources
from linkwright.bridge.foxglove.topics import Channels
from linkwright.bridge.graph_updates import GraphUpdates
from linkwright.bridge.websockets.clients import Client
from linkwright.bridge.websockets.server import ServerOptions, WebSocketServer, make_listen_error, open_listener
from linkwright.diagnostics import phrase
from linkwright.graph import DESCRIPTION_QOS, Graph
from linkwright.messages import String
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

_CAPABILITIES = ("clientPublish", "parameters", "parametersSubscribe", "services", "connectionGraph", "assets")
_MATCH_ALL = [".*"]


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
            origins: list[str] = list(declare("allowed_origins", [""]).value)
            max_queue_bytes = int(declare("send_buffer_limit", 10_000_000).value)
            try:
                self._listener = open_listener(address, port)
            except OSError as error:
                hint = phrase("choose another port with the parameter 'port', or with '--foxglove'")
                raise make_listen_error(self.DEFAULT_NAME, address, port, error, hint) from None
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
        self._identity = str(time.time_ns())
        self._watch_graph(graph)
        server_options = ServerOptions(
            "Foxglove or Lichtblick", protocols=SUBPROTOCOLS, origins=origins, max_queue_bytes=max_queue_bytes
        )
        self._server = WebSocketServer(self._listener, server_options, self._add_client)
        self._server_task = asyncio.get_running_loop().create_task(self._serve())

    def close(self) -> None:
        """Close the connections and the server."""
        self._updates.close()
        for session in list(self._sessions):
            session.close()
        self._resources.parameters.close()
        self._server_task.cancel()
        self._cleanup_task = self._server.close()
        super().close()

    # --- the graph ---------------------------------------------------------------------------------------------

    def _watch_graph(self, graph: Graph) -> None:
        node = self._node
        self._updates = GraphUpdates(graph, node, self._send_updates)
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

    def _send_updates(self) -> None:
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
        await self._server.start()
        self._node.get_logger().info(f"Foxglove and Lichtblick connect to {self._server.address}")

    def _add_client(
        self, client: Client, ip_address: str
    ) -> tuple[Callable[[str | bytes], object], Callable[[], object]]:
        session = Session(self._resources, client)
        self._greet(client)
        self._sessions[session] = None

        def end() -> None:
            self._sessions.pop(session, None)
            session.close()

        return session.receive, end

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
