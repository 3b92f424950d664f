"""The session of one client: its requests, subscriptions and publications."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Coroutine
from dataclasses import dataclass, field
from typing import Any

from linkwright.bridge.foxglove.assets import AssetRefusedError, Assets
from linkwright.bridge.foxglove.connections import Connections, find_connections, make_connection_update
from linkwright.bridge.foxglove.names import NameFilter
from linkwright.bridge.foxglove.parameters import Parameters, ParameterSubscription
from linkwright.bridge.foxglove.protocol import (
    BadFrameError,
    ClientMessage,
    ServiceRequest,
    StatusLevel,
    encode_asset,
    encode_asset_error,
    encode_service_response,
    make_status,
    read_frame,
)
from linkwright.bridge.foxglove.services import CallFailedError, Services
from linkwright.bridge.foxglove.topics import Channels, Forwarding, Publication
from linkwright.bridge.websockets.clients import Client
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import Node

_MAX_TASKS = 64
"""The maximum number of pending requests of one client."""

_MAX_CHANNELS = 1000


@dataclass(slots=True)
class SharedResources:
    """The channels, services, parameters and assets that sessions share."""

    node: Node
    channels: Channels
    services: Services
    parameters: Parameters
    assets: Assets
    publishable: NameFilter


@dataclass(slots=True, eq=False)
class Session:
    """The session of one client, which handles its requests.

    Attributes:
        watches_connections: whether the client is notified of changes to the connection graph.
        parameters: the parameters whose changes are sent to the client.
    """

    resources: SharedResources
    client: Client
    watches_connections: bool = False
    parameters: ParameterSubscription = field(default_factory=ParameterSubscription)
    _sent_connections: Connections | None = None
    _forwardings: dict[int, Forwarding] = field(default_factory=dict)
    _publications: dict[int, Publication] = field(default_factory=dict)
    _tasks: set[asyncio.Task[None]] = field(default_factory=set)

    def receive(self, message: str | bytes) -> None:
        """Handle a message of the client.

        An error is sent back to the client.
        """
        try:
            if isinstance(message, bytes):
                self._handle_frame(read_frame(message))
            else:
                self._handle_operation(json.loads(message))
        except LinkwrightError as error:
            self._send_status(error.diagnostics[0].message)
        except BadFrameError as error:
            self._send_status(str(error))
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            self._send_status(f"the message does not follow the protocol: {type(error).__name__}: {str(error)[:200]}")

    def on_graph_changed(self, removed_channels: list[int]) -> None:
        """Remove subscriptions to channels that no longer exist, and update the connection graph."""
        for subscription_id, forwarding in list(self._forwardings.items()):
            if forwarding.channel.channel_id in removed_channels:
                self._forwardings.pop(subscription_id).close()
        self.send_connections()

    def send_connections(self) -> None:
        """Send the latest changes to the connection graph, if the client subscribed to it."""
        if self.watches_connections:
            current = find_connections(self.resources.node)
            if current != self._sent_connections:
                self.client.send(make_connection_update(self._sent_connections, current))
                self._sent_connections = current

    def close(self) -> None:
        """Remove all subscriptions, publications and requests of the client."""
        for task in self._tasks:
            task.cancel()
        for forwarding in self._forwardings.values():
            forwarding.close()
        for publication in self._publications.values():
            publication.close()
        self._forwardings.clear()
        self._publications.clear()

    # --- messages ----------------------------------------------------------------------------------------------

    def _handle_frame(self, frame: ClientMessage | ServiceRequest) -> None:
        if isinstance(frame, ServiceRequest):
            self._run(self._call(frame))
        elif frame.channel in self._publications:
            self._publications[frame.channel].publish(frame.data)
        else:
            self._send_status(f"channel {frame.channel} was not advertised")

    def _handle_operation(self, request: dict[str, Any]) -> None:
        match request["op"]:
            case "subscribe":
                for subscription in request["subscriptions"]:
                    self._subscribe(int(subscription["id"]), int(subscription["channelId"]))
            case "unsubscribe":
                for subscription_id in request["subscriptionIds"]:
                    if subscription_id in self._forwardings:
                        self._forwardings.pop(subscription_id).close()
            case "advertise":
                for channel in request["channels"]:
                    self._advertise(int(channel["id"]), channel)
            case "unadvertise":
                for channel_id in request["channelIds"]:
                    if channel_id in self._publications:
                        self._publications.pop(channel_id).close()
            case "getParameters":
                self._run(self._send_parameters([str(name) for name in request["parameterNames"]], request.get("id")))
            case "setParameters":
                self._run(self._set_parameters(list(request["parameters"]), request.get("id")))
            case "subscribeParameterUpdates":
                self.parameters.add(map(str, request["parameterNames"]))
            case "unsubscribeParameterUpdates":
                self.parameters.remove(map(str, request["parameterNames"]))
            case "subscribeConnectionGraph":
                self.watches_connections, self._sent_connections = True, None
                self.send_connections()
            case "unsubscribeConnectionGraph":
                self.watches_connections = False
            case "fetchAsset":
                self._run(self._fetch(str(request["uri"]), int(request["requestId"])))
            case operation:
                self._send_status(f"unknown operation '{str(operation)[:40]}'")

    def _subscribe(self, subscription_id: int, channel_id: int) -> None:
        channel = self.resources.channels.get(channel_id)
        if channel is None:
            self._send_status(f"there is no channel {channel_id}")
        elif subscription_id in self._forwardings:
            self._send_status(f"subscription {subscription_id} already exists")
        elif any(forwarding.channel is channel for forwarding in self._forwardings.values()):
            self._send_status(f"the client is already subscribed to '{channel.topic}'", StatusLevel.WARNING)
        else:
            self._forwardings[subscription_id] = Forwarding(self.resources.node, channel, self.client, subscription_id)

    def _advertise(self, channel_id: int, channel: dict[str, Any]) -> None:
        topic = str(channel["topic"])
        if channel_id in self._publications or len(self._publications) >= _MAX_CHANNELS:
            self._send_status(
                f"channel {channel_id} cannot be advertised: it already is, or there are too many channels"
            )
        elif not self.resources.publishable.accepts(self.resources.node.resolve_topic_name(topic)):
            self._send_status(f"clients may not publish on '{topic}'")
        else:
            self._publications[channel_id] = Publication(self.resources.node, channel)

    # --- requests ----------------------------------------------------------------------------------------------

    def _run(self, request: Coroutine[Any, Any, None]) -> None:
        if len(self._tasks) >= _MAX_TASKS:
            request.close()
            self._send_status("too many requests at once")
            return
        task = asyncio.get_running_loop().create_task(request)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _call(self, request: ServiceRequest) -> None:
        try:
            response = await self.resources.services.call(request)
        except CallFailedError as error:
            failure = {"serviceId": request.service, "callId": request.call, "message": str(error)}
            self.client.send({"op": "serviceCallFailure", **failure})
            return
        self.client.send(encode_service_response(request.service, request.call, response))

    async def _send_parameters(self, names: list[str], identity: str | None) -> None:
        values = await self.resources.parameters.get(names)
        message: dict[str, Any] = {"op": "parameterValues", "parameters": values}
        if identity is not None:
            message["id"] = identity
        self.client.send(message)

    async def _set_parameters(self, parameters: list[dict[str, Any]], identity: str | None) -> None:
        try:
            await self.resources.parameters.set(parameters)
        except (ValueError, TypeError, AttributeError, LinkwrightError) as error:
            self._send_status(f"a parameter was not set: {str(error)[:200]}")
        if identity is not None:
            await self._send_parameters([str(parameter.get("name", "")) for parameter in parameters], identity)

    async def _fetch(self, uri: str, request: int) -> None:
        try:
            data = await asyncio.to_thread(self.resources.assets.read, uri)
        except AssetRefusedError as error:
            self.client.send(encode_asset_error(request, str(error)))
            return
        self.client.send(encode_asset(request, data))

    def _send_status(self, text: str, level: StatusLevel = StatusLevel.ERROR) -> None:
        self.client.send(make_status(level, text))
