"""Topics as channels, and the subscriptions and publications of clients."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from linkwright.bridge.foxglove.names import NameFilter
from linkwright.bridge.foxglove.protocol import ENCODING, SCHEMA_ENCODING, encode_message
from linkwright.bridge.websockets.clients import Client
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import EndpointKind, MessageInfo, Node, Publisher, QoSProfile, Subscription
from linkwright.graph.qos.compatibility import fit_profile
from linkwright.graph.qos.profile import QoSPresetProfiles
from linkwright.messages import deserialize, get_message
from linkwright.messages.schema_text import schema_of

_DEPTH = 100


@dataclass(frozen=True, slots=True)
class Channel:
    """A topic with its type and channel id."""

    channel_id: int
    topic: str
    type_name: str
    schema: str

    def advertisement(self) -> dict[str, Any]:
        """Return the channel as an entry of the protocol's ``advertise`` message."""
        return {
            "id": self.channel_id,
            "topic": self.topic,
            "encoding": ENCODING,
            "schemaName": self.type_name,
            "schema": self.schema,
            "schemaEncoding": SCHEMA_ENCODING,
        }


class Channels:
    """The channels that clients can subscribe to.

    Args:
        node: the node whose graph has the topics.
        name_filter: the filter that topic names must pass.
    """

    def __init__(self, node: Node, name_filter: NameFilter) -> None:
        self._node = node
        self._filter = name_filter
        self._channels: dict[tuple[str, str], Channel] = {}
        self._unknown_types: set[str] = set()
        self._last_id = 0

    def all(self) -> list[Channel]:
        """Return the currently available channels."""
        return list(self._channels.values())

    def get(self, channel_id: int) -> Channel | None:
        """Return the channel with an ID, or None if there is none."""
        return next((channel for channel in self._channels.values() if channel.channel_id == channel_id), None)

    def poll_changes(self) -> tuple[list[Channel], list[int]]:
        """Return the channels that were added since the last call, and the IDs of removed channels."""
        current = {
            (endpoint.name, endpoint.type_name)
            for endpoint in self._node.graph.endpoints()
            if endpoint.kind is EndpointKind.PUBLISHER and self._filter.accepts(endpoint.name)
        }
        removed = [self._channels.pop(key).channel_id for key in list(self._channels) if key not in current]
        added = [
            channel
            for key in sorted(current - self._channels.keys())
            if (channel := self._create_channel(*key)) is not None
        ]
        return added, removed

    def _create_channel(self, topic: str, type_name: str) -> Channel | None:
        try:
            schema = schema_of(type_name)
        except LinkwrightError as error:
            if type_name not in self._unknown_types:
                self._unknown_types.add(type_name)
                self._node.get_logger().warning(f"'{topic}' is not offered: {error.diagnostics[0].message}")
            return None
        self._last_id += 1
        channel = self._channels[topic, type_name] = Channel(self._last_id, topic, type_name, schema)
        return channel


class Forwarding:
    """A subscription that forwards the messages of a channel to a client.

    Args:
        node: the node that subscribes.
        channel: the channel to forward.
        client: the client that receives the messages.
        subscription_id: the client's ID of the subscription.
    """

    def __init__(self, node: Node, channel: Channel, client: Client, subscription_id: int) -> None:
        self.channel = channel
        self._node = node
        self._client = client
        self._subscription_id = subscription_id
        self._subscription: Subscription[Any] = Subscription(
            node.handle, get_message(channel.type_name), channel.topic, self._choose_qos(), self._forward, raw=True
        )
        node.handle.add(self._subscription)

    def close(self) -> None:
        """Stop forwarding."""
        self._node.destroy_subscription(self._subscription)

    def _choose_qos(self) -> QoSProfile:
        offers = [
            endpoint.qos
            for endpoint in self._node.graph.endpoints()
            if endpoint.name == self.channel.topic and endpoint.kind is EndpointKind.PUBLISHER
        ]
        profile = fit_profile(QoSPresetProfiles.get_from_short_key("sensor_data"), offers).profile
        profile.depth = _DEPTH
        return profile

    def _forward(self, data: bytes, info: MessageInfo) -> None:
        stamp = info.source_timestamp or self._node.get_clock().now().nanoseconds
        self._client.send_data(encode_message(self._subscription_id, stamp, bytes(data)))


class Publication:
    """A publisher of the messages of a channel that a client has advertised.

    Args:
        node: the node that publishes.
        channel: the client's advertisement of the channel.

    Raises:
        LinkwrightError: the type is unknown, or the topic's name is not valid.
        ValueError: the encoding is not CDR.
    """

    def __init__(self, node: Node, channel: Mapping[str, Any]) -> None:
        if channel.get("encoding") != ENCODING:
            raise ValueError(f"the encoding '{str(channel.get('encoding'))[:40]}' is not supported: use {ENCODING}")
        self._node = node
        self._class: Any = get_message(_get_full_type(str(channel["schemaName"])))
        self._publisher: Publisher[Any] = node.create_publisher(self._class, str(channel["topic"]), 10)

    def publish(self, data: bytes) -> None:
        """Publish a message.

        Raises:
            LinkwrightError: the bytes are not a message of the type.
        """
        self._publisher.publish(deserialize(data, self._class))

    def close(self) -> None:
        """Stop publishing."""
        self._node.destroy_publisher(self._publisher)


def _get_full_type(name: str) -> str:
    """Return the full name of a message type.

    The short form ``std_msgs/String`` is also accepted.
    """
    return name.replace("/", "/msg/", 1) if name.count("/") == 1 else name
