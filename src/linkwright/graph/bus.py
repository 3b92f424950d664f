"""The in-process bus: topics, and the publishers and subscriptions on them."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from itertools import chain
from typing import Any, Generic, TypeVar

from linkwright.graph.executor import Executor, run_logged
from linkwright.graph.log import Logger
from linkwright.graph.qos import DurabilityPolicy, QoSProfile, incompatible_policies
from linkwright.messages import Message

M = TypeVar("M", bound=Message)


class Endpoint(Generic[M]):
    """One side of a topic: what a publisher and a subscription have in common.

    Attributes:
        msg_type: the message class.
        topic_name: the topic's absolute name.
        qos_profile: what is offered or asked for.
        node_name: full name of the node it belongs to.
        logger: that node's logger.
    """

    def __init__(
        self, msg_type: type[M], topic_name: str, qos_profile: QoSProfile, node_name: str, logger: Logger
    ) -> None:
        self.msg_type = msg_type
        self.topic_name = topic_name
        self.qos_profile = qos_profile
        self.node_name = node_name
        self.logger = logger


class Subscription(Endpoint[M]):
    """Receives the messages of a topic; made by ``Node.create_subscription``."""

    def __init__(
        self,
        msg_type: type[M],
        topic_name: str,
        qos_profile: QoSProfile,
        node_name: str,
        logger: Logger,
        callback: Callable[[M], object],
        executor: Executor,
    ) -> None:
        super().__init__(msg_type, topic_name, qos_profile, node_name, logger)
        self._callback = callback
        self._executor = executor
        self._waiting: deque[M] = deque(maxlen=qos_profile.queue_length)

    def enqueue(self, message: M) -> None:
        """Have the callback called with a message. When more wait than the history keeps, the oldest is dropped."""
        self._waiting.append(message)
        self._executor.submit(self._deliver)

    def discard(self) -> None:
        """Drop what waits."""
        self._waiting.clear()

    def _deliver(self) -> None:
        if self._waiting:
            message = self._waiting.popleft()
            run_logged(self.logger, f"callback of topic '{self.topic_name}'", lambda: self._callback(message))


class Publisher(Endpoint[M]):
    """Sends messages to a topic; made by ``Node.create_publisher``."""

    def __init__(
        self, msg_type: type[M], topic_name: str, qos_profile: QoSProfile, node_name: str, logger: Logger
    ) -> None:
        super().__init__(msg_type, topic_name, qos_profile, node_name, logger)
        self._matched: list[Subscription[M]] = []
        self._kept: deque[M] = deque(maxlen=qos_profile.queue_length)

    def publish(self, message: M) -> None:
        """Send a message to every matching subscription, in their order of creation; callbacks run later.

        Raises:
            TypeError: the message is not of the publisher's type.
        """
        if not isinstance(message, self.msg_type):
            raise TypeError(
                f"topic '{self.topic_name}' carries {self.msg_type.TYPE_NAME}, not {type(message).__name__}"
            )
        if self.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL:
            self._kept.append(message)
        for subscription in self._matched:
            subscription.enqueue(message)

    def get_subscription_count(self) -> int:
        """How many subscriptions receive what is published."""
        return len(self._matched)

    def connect(self, subscription: Subscription[M]) -> None:
        """Send to a subscription from now on, and what was kept for late comers, if it wants that, first."""
        self._matched.append(subscription)
        if subscription.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL:
            for message in self._kept:
                subscription.enqueue(message)

    def disconnect(self, subscription: Subscription[M]) -> None:
        """Send to a subscription no longer."""
        if subscription in self._matched:
            self._matched.remove(subscription)

    def disconnect_all(self) -> None:
        """Send to nobody any longer."""
        self._matched.clear()


class Bus:
    """Knows every publisher and subscription of the process and brings those that match together."""

    def __init__(self) -> None:
        self._publishers: dict[str, list[Publisher[Any]]] = {}
        self._subscriptions: dict[str, list[Subscription[Any]]] = {}

    def add_publisher(self, publisher: Publisher[Any]) -> None:
        """Connect a new publisher to the topic's subscriptions."""
        self._publishers.setdefault(publisher.topic_name, []).append(publisher)
        for subscription in self._subscriptions.get(publisher.topic_name, ()):
            _match(publisher, subscription)

    def add_subscription(self, subscription: Subscription[Any]) -> None:
        """Connect a new subscription to the topic's publishers."""
        self._subscriptions.setdefault(subscription.topic_name, []).append(subscription)
        for publisher in self._publishers.get(subscription.topic_name, ()):
            _match(publisher, subscription)

    def remove_publisher(self, publisher: Publisher[Any]) -> None:
        """Take a publisher away; what it sent is still delivered."""
        _take(self._publishers, publisher)
        publisher.disconnect_all()

    def remove_subscription(self, subscription: Subscription[Any]) -> None:
        """Take a subscription away; what waits for it is dropped."""
        _take(self._subscriptions, subscription)
        subscription.discard()
        for publisher in self._publishers.get(subscription.topic_name, ()):
            publisher.disconnect(subscription)

    def topics(self) -> dict[str, list[str]]:
        """Topic names, sorted, and the type names in use on each, sorted."""
        types: dict[str, set[str]] = {}
        endpoints: list[Endpoint[Any]] = [*chain(*self._publishers.values()), *chain(*self._subscriptions.values())]
        for endpoint in endpoints:
            types.setdefault(endpoint.topic_name, set()).add(endpoint.msg_type.TYPE_NAME)
        return {topic: sorted(types[topic]) for topic in sorted(types)}

    def count_publishers(self, topic: str) -> int:
        """How many publishers an absolute topic name has."""
        return len(self._publishers.get(topic, ()))

    def count_subscribers(self, topic: str) -> int:
        """How many subscriptions an absolute topic name has."""
        return len(self._subscriptions.get(topic, ()))


E = TypeVar("E", bound=Endpoint[Any])


def _take(endpoints: dict[str, list[E]], endpoint: E) -> None:
    of_topic = endpoints.get(endpoint.topic_name, [])
    if endpoint in of_topic:
        of_topic.remove(endpoint)
        if not of_topic:
            del endpoints[endpoint.topic_name]


def _match(publisher: Publisher[Any], subscription: Subscription[Any]) -> None:
    topic = publisher.topic_name
    if publisher.msg_type is not subscription.msg_type:
        subscription.logger.warning(
            f"Topic '{topic}' has different types: '{publisher.node_name}' publishes "
            f"{publisher.msg_type.TYPE_NAME}, '{subscription.node_name}' subscribes to "
            f"{subscription.msg_type.TYPE_NAME}. No messages will be received."
        )
        return
    policies = incompatible_policies(publisher.qos_profile, subscription.qos_profile)
    if not policies:
        publisher.connect(subscription)
        return
    last = f"Last incompatible policy: {policies[-1]} ({_sides(publisher, subscription, policies)})"
    subscription.logger.warning(
        f"New publisher discovered on topic '{topic}', offering incompatible QoS. "
        f"No messages will be received from it. {last}"
    )
    publisher.logger.warning(
        f"New subscription discovered on topic '{topic}', requesting incompatible QoS. "
        f"No messages will be sent to it. {last}"
    )


def _sides(publisher: Publisher[Any], subscription: Subscription[Any], policies: list[str]) -> str:
    def terms(qos: QoSProfile) -> str:
        return ", ".join(
            (qos.reliability if policy == "RELIABILITY_QOS_POLICY" else qos.durability).name.lower().replace("_", " ")
            for policy in policies
        )

    return (
        f"'{publisher.node_name}' offers {terms(publisher.qos_profile)}, "
        f"'{subscription.node_name}' requests {terms(subscription.qos_profile)}"
    )
