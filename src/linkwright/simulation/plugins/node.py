"""The node with the topics and services of a plugin."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from linkwright.graph import Node
from linkwright.graph.endpoints.base import Endpoint
from linkwright.graph.endpoints.command_guard import CommandGuard
from linkwright.graph.qos.profile import QoSProfile
from linkwright.graph.stepped.calls import Calls
from linkwright.graph.stepped.exchange import Exchange
from linkwright.graph.stepped.node import Output, SteppedNode
from linkwright.simulation.plugins.bridged_topics import BridgedTopics, hidden_gz_topic
from linkwright.simulation.plugins.ros_element import override_profile
from linkwright.xmltree import Element

_INVALID_CHARACTERS = re.compile(r"[^A-Za-z0-9_/~]")
_BEFORE_LEADING_DIGIT = re.compile(r"(?<=/)(?=[0-9])")


class PluginNode(SteppedNode):
    """The node of a plugin: a separate node for Gazebo classic, the simulation's node for gz.

    Args:
        node: the ROS node that owns the endpoints.
        exchange: passes messages between the graph and the simulation's thread.
        owned: whether the node belongs only to this plugin, and is destroyed with it.
        qos: overrides of QoS profiles (`NodeDescription.qos`).
        used_conventional_topics: the conventional topic names that are in use; None if topics are published only under
            their own names.
        bridged: for plugins of gz, the topics that a bridge offers with another type; None for other plugins.
        now_ns: returns the simulated time in nanoseconds; by default the time of the node's clock.
        calls: calls the node's callbacks; by default an error in a callback is logged.
    """

    def __init__(
        self,
        node: Node,
        exchange: Exchange,
        *,
        owned: bool,
        qos: Mapping[tuple[str, str], Element],
        used_conventional_topics: set[str] | None,
        bridged: BridgedTopics | None = None,
        now_ns: Callable[[], int] | None = None,
        calls: Calls | None = None,
    ) -> None:
        super().__init__(node, exchange, owned=owned, now_ns=now_ns, calls=calls)
        self._qos = {(node.handle.resolve_topic_name(topic), side): policy for (topic, side), policy in qos.items()}
        self._used_conventional_topics = used_conventional_topics
        self._bridged = bridged
        self._unregister_functions: list[Callable[[], None]] = []
        self._own_conventional_topics: list[str] = []

    def publisher(
        self, msg_type: Any, topic: str, qos: QoSProfile | int = 10, *, conventional_topic: str = ""
    ) -> Output:
        """Create a publisher for a topic.

        Args:
            msg_type: the class of the messages, or the name of the type.
            topic: a relative, absolute or private name. Characters that gz allows and ROS does not are replaced.
            qos: the QoS profile; a number is a depth.
            conventional_topic: for topics of gz, the usual name on robots. The topic is also published under this name
                if the simulation has this option enabled and no other plugin uses the name.
        """
        return self._create_output(msg_type, self._topic_names(topic, conventional_topic), qos)

    def subscribe(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[[Any], object],
        qos: QoSProfile | int = 10,
        *,
        command_guard: CommandGuard | None = None,
        stop_motion: Callable[[], object] | None = None,
        conventional_topic: str = "",
    ) -> None:
        """Subscribe to a topic.

        The arguments are those of `publisher` and of `SteppedNode.subscribe`.
        """
        handle_message = self._make_callback(topic, callback, stop_motion, command_guard)
        self._subscribe_to(msg_type, self._topic_names(topic, conventional_topic), handle_message, qos, command_guard)

    def close(self) -> None:
        """Remove all endpoints of the plugin from the graph."""
        for unregister in self._unregister_functions:
            unregister()
        super().close()
        if self._used_conventional_topics is not None:
            self._used_conventional_topics.difference_update(self._own_conventional_topics)

    def _listen(self, topic: str, create_subscription: Callable[[str], Endpoint]) -> None:
        """Subscribe to a topic, or to its hidden name while a bridge offers another type."""
        bridged = self._bridged
        if bridged is None or bridged.is_bridged(topic):
            create_subscription(topic if bridged is None else hidden_gz_topic(topic))
            return
        subscription = create_subscription(topic)

        def move_to_hidden_topic() -> None:
            self._endpoints.remove(subscription)
            subscription.destroy()
            create_subscription(hidden_gz_topic(topic))

        bridged.add_callback(topic, move_to_hidden_topic)
        self._unregister_functions.append(partial(bridged.remove_callback, topic, move_to_hidden_topic))

    def _topic_names(self, topic: str, conventional_topic: str) -> list[str]:
        topic = to_ros_name(topic)
        names = [topic]
        used = self._used_conventional_topics
        if conventional_topic and used is not None and conventional_topic not in {topic, *used}:
            used.add(conventional_topic)
            self._own_conventional_topics.append(conventional_topic)
            names.append(conventional_topic)
        return names

    def _profile(self, topic: str, side: str, qos: QoSProfile | int) -> QoSProfile:
        profile = QoSProfile.of(qos)
        override = self._qos.get((self._node.handle.resolve_topic_name(topic), side))
        return profile if override is None else override_profile(profile, override)


def to_ros_name(name: str) -> str:
    """Return the name in ROS of a topic or service of gz: characters that only gz allows are replaced."""
    return _BEFORE_LEADING_DIGIT.sub("_", _INVALID_CHARACTERS.sub("_", name))
