"""The subscriptions of a client to topics."""

from __future__ import annotations

import asyncio
from collections import deque
from dataclasses import dataclass
from typing import Any

from linkwright.bridge.rosbridge.encodings import CBOR_RAW, COMPRESSIONS, NONE, MessageEncoder, encode_raw
from linkwright.bridge.rosbridge.fragments import split_message
from linkwright.bridge.rosbridge.requests import Request, RequestError, full_type_name
from linkwright.bridge.rosbridge.topic_types import find_topic_type
from linkwright.bridge.websockets.clients import Client
from linkwright.graph import EndpointKind, Node, QoSProfile, Subscription
from linkwright.graph.qos.compatibility import fit_profile
from linkwright.messages import get_message

_QUEUE_DEPTH = 10
_MAX_QUEUE_LENGTH = 10_000


@dataclass(frozen=True, slots=True)
class Settings:
    """How a client wants to receive the messages of a topic.

    Attributes:
        throttle_s: the minimum number of seconds between two messages.
        queue_length: how many messages wait because of `throttle_s`; 0 to drop them.
        fragment_size: the maximum number of characters of a frame; None for the client's general limit.
        compression: the form of the messages.
    """

    throttle_s: float = 0.0
    queue_length: int = 0
    fragment_size: int | None = None
    compression: str = NONE

    @classmethod
    def of(cls, request: Request) -> Settings:
        """Return the settings in a request.

        Raises:
            RequestError: a field is not valid.
        """
        compression = request.read("compression", str, NONE)
        if compression not in COMPRESSIONS:
            raise RequestError(f"compression '{compression[:40]}' is not supported: use {', '.join(COMPRESSIONS)}")
        return cls(
            request.read_count("throttle_rate") / 1000,
            min(request.read_count("queue_length"), _MAX_QUEUE_LENGTH),
            request.read_count("fragment_size") or None,
            compression,
        )

    @classmethod
    def merge(cls, requested: list[Settings]) -> Settings:
        """Return the settings that serve several requests of a client for the same topic."""
        sizes = [settings.fragment_size for settings in requested if settings.fragment_size is not None]
        return cls(
            min(settings.throttle_s for settings in requested),
            min(settings.queue_length for settings in requested),
            min(sizes, default=None),
            max((settings.compression for settings in requested), key=COMPRESSIONS.index),
        )


class TopicSubscription:
    """A client's subscription to a topic, which several requests of the client share.

    Args:
        node: the node that subscribes.
        topic: the name in the client's request.
        type_name: the type that the client expects; None for the type of the topic.
        client: the client that receives the messages.
        encoder: encodes the messages.
        max_size: the maximum number of characters of a frame. Longer messages are sent in fragments.

    Raises:
        RequestError: the topic has another type, or is not known.
        LinkwrightError: the topic's name is not valid, or the type is unknown.
    """

    def __init__(
        self, node: Node, topic: str, type_name: str | None, client: Client, encoder: MessageEncoder, max_size: int
    ) -> None:
        self._node = node
        self._topic = topic
        self._full_name = node.resolve_topic_name(topic)
        self._type_name = find_topic_type(node, self._full_name, type_name and full_type_name(type_name, "msg"))
        get_message(self._type_name)
        self._client = client
        self._encoder = encoder
        self._max_size = max_size
        self._requested: dict[Any, Settings] = {}
        self._settings = Settings()
        self._subscription: Subscription[Any] | None = None
        self._last_sent_s = float("-inf")
        self._waiting: deque[Any] = deque()
        self._timer: asyncio.TimerHandle | None = None
        self._loop = asyncio.get_running_loop()

    @property
    def has_requests(self) -> bool:
        """Whether a request of the client still needs the subscription."""
        return bool(self._requested)

    def check_type(self, type_name: str | None) -> None:
        """Check the type in another request for this topic.

        Raises:
            RequestError: it is not the type of the subscription.
        """
        find_topic_type(self._node, self._full_name, type_name and full_type_name(type_name, "msg"))

    def add(self, identity: Any, settings: Settings) -> None:
        """Add a request, or replace the one with the same ID."""
        self._requested[identity] = settings
        self._update()

    def remove(self, identity: Any) -> None:
        """Remove a request; all of them if the ID is None."""
        if identity is None:
            self._requested.clear()
        else:
            self._requested.pop(identity, None)
        if self._requested:
            self._update()

    def refit(self) -> None:
        """Subscribe again if the publishers of the topic have changed so that another QoS fits them."""
        qos = self._choose_qos()
        current = self._subscription
        if current is not None and (qos.reliability, qos.durability) != (
            current.qos_profile.reliability,
            current.qos_profile.durability,
        ):
            self._subscribe(qos)

    def close(self) -> None:
        """End the subscription."""
        if self._timer is not None:
            self._timer.cancel()
        if self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
            self._subscription = None
        self._encoder.drop(self._topic)

    # --- subscribing -----------------------------------------------------------------------------------------

    def _update(self) -> None:
        settings = Settings.merge(list(self._requested.values()))
        is_other_form = (settings.compression == CBOR_RAW) != (self._settings.compression == CBOR_RAW)
        self._settings = settings
        self._waiting = deque(self._waiting, maxlen=settings.queue_length)
        if self._subscription is None or is_other_form:
            self._waiting.clear()
            self._subscribe(self._choose_qos())

    def _subscribe(self, qos: QoSProfile) -> None:
        if self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
        self._subscription = self._node.create_subscription(
            self._type_name, self._topic, self._receive, qos, raw=self._settings.compression == CBOR_RAW
        )

    def _choose_qos(self) -> QoSProfile:
        offers = [
            endpoint.qos
            for endpoint in self._node.graph.publishers()
            if endpoint.name == self._full_name and endpoint.kind is EndpointKind.PUBLISHER
        ]
        return fit_profile(QoSProfile(depth=_QUEUE_DEPTH), offers).profile

    # --- messages ----------------------------------------------------------------------------------------------

    def _receive(self, message: Any) -> None:
        if self._settings.throttle_s == 0:
            self._send(message)
        elif self._settings.queue_length:
            self._waiting.append(message)
            if self._timer is None:
                self._send_waiting()
        elif self._loop.time() >= self._last_sent_s + self._settings.throttle_s:
            self._send(message)

    def _send_waiting(self) -> None:
        """Send the oldest waiting message if the time for it has come, and wait for the next one."""
        self._timer = None
        due_s = self._last_sent_s + self._settings.throttle_s
        if self._waiting and self._loop.time() >= due_s:
            self._send(self._waiting.popleft())
            due_s = self._last_sent_s + self._settings.throttle_s
        if self._waiting:
            self._timer = self._loop.call_at(due_s, self._send_waiting)

    def _send(self, message: Any) -> None:
        self._last_sent_s = self._loop.time()
        compression = self._settings.compression
        if compression == CBOR_RAW:
            frame: str | bytes = encode_raw(self._topic, bytes(message), self._node.get_clock().now().to_msg())
        else:
            frame = self._encoder.encode(self._topic, message, compression)
        if isinstance(frame, str):
            size = self._max_size if self._settings.fragment_size is None else self._settings.fragment_size
            self._client.send_data(*split_message(frame, size))
        else:
            self._client.send_data(frame)
