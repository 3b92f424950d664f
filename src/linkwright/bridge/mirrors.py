"""Mirrors: a bridge's endpoints that represent endpoints of the other network."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any

from linkwright.bridge.outlet import Outlet
from linkwright.bridge.streams import HISTORY_DEPTH, Stream, make_offered_profile
from linkwright.graph.endpoints.base import EndpointInfo, MessageInfo
from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.endpoints.service import Client, Service
from linkwright.graph.endpoints.subscription import Subscription
from linkwright.graph.log.logger import log_failure
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.qos.profile import HistoryPolicy, QoSProfile

MATCH_TIMEOUT_S = 10.0
"""Seconds within which publishers and subscriptions that discovered each other match, even on a busy machine."""

_DISCOVERY_TIMEOUT_S = 1.0
"""Seconds for which a new publisher's messages wait if no matching subscription is known."""

_QUEUE_LENGTH = 100
"""The queue length of a topic without history. The queue of a service holds ten times as many requests."""


class Tap:
    """The bridge's subscription to a stream.

    Args:
        node: the bridge's own node in the network of the stream.
        stream: the stream to subscribe to.
        on_message: called with the tap, each message as bytes, and the message's info.
    """

    def __init__(self, node: NodeHandle, stream: Stream, on_message: Callable[[Tap, bytes, MessageInfo], None]) -> None:
        qos = QoSProfile(
            depth=HISTORY_DEPTH if stream.has_history else _QUEUE_LENGTH,
            history=stream.history,
            reliability=stream.reliability,
            durability=stream.durability,
        )

        def receive(data: bytes, info: MessageInfo) -> None:
            on_message(self, data, info)

        subscription: Subscription[Any] = Subscription(node, stream.type_name, stream.name, qos, receive, raw=True)
        subscription.type_hash = stream.type_hash
        subscription.is_listed = False
        self.stream = stream
        self._subscription = node.add(subscription)

    def has_more(self) -> bool:
        """Return whether received messages are still queued."""
        return self._subscription.has_work()

    def close(self) -> None:
        """Destroy the subscription."""
        self._subscription.destroy()


class MirroredPublisher:
    """A publisher in one network that forwards the messages of a publisher in the other.

    Messages are queued until a subscription is matched, because existing subscriptions have not discovered the
    publisher yet.

    Args:
        node: the bridge's node with the name of the publisher's node.
        info: the publisher in the other network.
        stream: the publisher's stream in the other network.

    Attributes:
        expects_listeners: whether a subscription is known that can receive from the mirror.
    """

    def __init__(self, node: NodeHandle, info: EndpointInfo, stream: Stream) -> None:
        self.info = info
        self.stream = stream
        publisher: Publisher[Any] = Publisher(node, info.type_name, info.name, make_offered_profile(info.qos))
        publisher.type_hash = info.type_hash
        publisher.raw = True
        self._waiting: deque[bytes] | None = deque(maxlen=HISTORY_DEPTH)
        self._created_at = time.monotonic()
        self.expects_listeners = False
        self._publisher = node.add(publisher)
        on_failure = partial(log_failure, node.logger, f"publisher of topic '{info.name}'")
        self._outlet = Outlet(publisher.publish, on_failure) if stream.history is HistoryPolicy.KEEP_ALL else None

    @property
    def gid(self) -> bytes:
        """The GID of the mirror itself."""
        return self._publisher.gid

    def listeners(self) -> int:
        """Return the number of matching subscriptions of other nodes, including other bridges."""
        return self._publisher.get_subscription_count() - len(self._publisher.local_subscriptions())

    @property
    def has_queued_messages(self) -> bool:
        """Whether messages are queued until a subscription is matched."""
        return self._waiting is not None

    def put(self, data: bytes) -> None:
        """Publish a message, or queue it until a subscription is matched."""
        if self._waiting is None:
            self._publish(data)
        else:
            self._waiting.append(data)
            self.process_pending()

    def process_pending(self) -> bool:
        """Publish the queued messages once a subscription is matched, or after a while.

        Returns whether the queue is empty. Messages with history are published immediately.
        """
        if self._waiting is not None and (self.stream.has_history or self.listeners() or self._has_waited()):
            queued_messages, self._waiting = self._waiting, None
            for data in queued_messages:
                self._publish(data)
        return self._waiting is None

    def close(self) -> None:
        """Remove the mirror."""
        if self._outlet is not None:
            self._outlet.close()
        self._publisher.destroy()

    def has_more(self) -> bool:
        """Return whether the publisher's thread still has messages to publish."""
        return self._outlet is not None and self._outlet.has_more()

    def _has_waited(self) -> bool:
        timeout = MATCH_TIMEOUT_S if self.expects_listeners else _DISCOVERY_TIMEOUT_S
        return time.monotonic() >= self._created_at + timeout

    def _publish(self, data: bytes) -> None:
        if self._outlet is None:
            self._publisher.publish(data)
        else:
            self._outlet.put(data)


class MirroredService:
    """A service in one network that forwards requests to a service of the other network.

    Args:
        node: the bridge's node with the name of the service's node.
        home: the bridge's own node in the service's network, which calls the service.
        info: the service.
    """

    def __init__(self, node: NodeHandle, home: NodeHandle, info: EndpointInfo) -> None:
        self.info = info
        self._node = node
        self._qos = QoSProfile(10 * _QUEUE_LENGTH)
        client: Client[Any, Any] = Client(home, info.type_name, info.name, self._qos, raw=True)
        client.type_hash = info.type_hash
        client.is_listed = False
        self._client = home.add(client)
        self._service: Service[Any, Any] | None = None

    def process_pending(self) -> bool:
        """Offer the service if its server is ready, and return whether it is offered."""
        if self._service is None and self._client.service_is_ready():
            service: Service[Any, Any] = Service(
                self._node,
                self.info.type_name,
                self.info.name,
                self._qos,
                self._forward_request,
                replying=True,
                raw=True,
            )
            service.type_hash = self.info.type_hash
            self._service = self._node.add(service)
        return self._service is not None

    def close(self) -> None:
        """Remove the service.

        The network notifies clients that wait for a response.
        """
        if self._service is not None:
            self._service.destroy()
        self._client.destroy()

    def _forward_request(self, request: Any, reply: Callable[[Any], None]) -> None:
        self._client.call_async(request).add_done_callback(partial(_forward_response, reply))


def _forward_response(reply: Callable[[Any], None], future: Any) -> None:
    response = future.result()
    if response is not None:
        reply(response)
