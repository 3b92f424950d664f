"""Reasons why a learner's program publishes nothing, derived from the graph of a check."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Phrase, nearest, phrase, quoted_names
from linkwright.learning.checks.not_yet import NotYet

if TYPE_CHECKING:
    from linkwright.graph import Graph

_TEST_NODE_NAME = "test"
_GENERAL_TOPICS = {"/rosout", "/parameter_events", "/clock", "/tf", "/tf_static"}


def expect_published(test: Any, topic: str, type_name: str, messages: Any) -> None:
    """Require a program to have published on a topic.

    Args:
        test: the stepped graph or simulation, before it ends.
        topic: the full name of the topic.
        type_name: the type of its messages, such as ``geometry_msgs/msg/Twist``.
        messages: the recorded messages of the topic.

    Raises:
        NotYet: no message was recorded; the message gives the reason, if it is known.
    """
    if not len(messages):
        raise NotYet(_explain_silence(test, topic, type_name))


def _explain_silence(test: Any, topic: str, type_name: str) -> Phrase:
    silent = phrase("nothing is published on {topic}", topic=topic)
    publishers = _list_types_by_topic(test, published=True)
    types = publishers.get(topic)
    if types is not None and type_name not in types:
        return phrase(
            "{silent}: its messages must have the type {expected}, but the program publishes {actual} there",
            silent=silent,
            expected=type_name,
            actual=min(types),
        )
    if types is not None:
        return phrase("{silent}: {reason}", silent=silent, reason=_explain_idle(test))
    if similar := _find_similar_topic(topic, publishers):
        return phrase("{silent}; the program publishes {similar}", silent=silent, similar=similar)
    if publishers:
        return phrase("{silent}; the program publishes {topics}", silent=silent, topics=", ".join(sorted(publishers)))
    if not test.program_nodes:
        return phrase("{silent}: the program has no node; does main() create one and spin it?", silent=silent)
    return phrase("{silent}: the node has no publisher; call create_publisher in __init__", silent=silent)


def _explain_idle(test: Any) -> Phrase:
    """Return the reason why a program with a publisher does not publish."""
    graph = test.graph
    subscriptions = {
        name: types
        for name, types in _list_types_by_topic(test, published=False).items()
        if name not in _GENERAL_TOPICS
    }
    published = {
        name: {info.topic_type for info in publishers}
        for name, _ in graph.get_topic_names_and_types()
        if (publishers := graph.get_publishers_info_by_topic(name))
    }
    for name, types in sorted(subscriptions.items()):
        other_topics = sorted(topic for topic in published if topic not in subscriptions and types & published[topic])
        if name not in published and other_topics:
            return phrase(
                "the program subscribes to {topic}, but no node publishes it; messages of this type are published "
                "on {other_topic}",
                topic=name,
                other_topic=other_topics[0],
            )
    for name, types in sorted(subscriptions.items()):
        if name in published and not types & published[name]:
            return phrase(
                "the program subscribes to {topic} with the type {actual}, but its messages have the type {expected}",
                topic=name,
                actual=min(types),
                expected=min(published[name]),
            )
    for name in sorted(subscriptions):
        if _is_incompatible(graph, name):
            return phrase(
                "the QoS of the subscription to {topic} is not compatible with that of the publisher", topic=name
            )
    if subscriptions:
        return phrase(
            "the program has a publisher, but does not call publish(); is there a timer, or is the callback of "
            "{topics} called, and does main() spin the node?",
            topics=quoted_names(sorted(subscriptions)),
        )
    return phrase(
        "the program has a publisher, but does not call publish(); is there a timer with a period in seconds, and does "
        "main() spin the node? The lines below rclpy.spin() do not run while the node spins"
    )


def _is_incompatible(graph: Graph, topic: str) -> bool:
    from linkwright.graph.qos.compatibility import QoSCompatibility, qos_check_compatible

    offered = [info for info in graph.get_publishers_info_by_topic(topic) if info.node_name != _TEST_NODE_NAME]
    offered = offered or graph.get_publishers_info_by_topic(topic)
    requested = [info for info in graph.get_subscriptions_info_by_topic(topic) if info.node_name != _TEST_NODE_NAME]
    return any(
        qos_check_compatible(publisher.qos_profile, subscription.qos_profile)[0] is QoSCompatibility.ERROR
        for publisher in offered
        for subscription in requested
    )


def _list_types_by_topic(test: Any, *, published: bool) -> dict[str, set[str]]:
    """Return the types by topic of the publishers or subscriptions of the learner's programs."""
    graph = test.graph
    find = graph.get_publisher_names_and_types_by_node if published else graph.get_subscriber_names_and_types_by_node
    types_by_topic: dict[str, set[str]] = {}
    for name, namespace in test.program_nodes:
        for topic, types in find(name, namespace):
            if topic not in _GENERAL_TOPICS:
                types_by_topic.setdefault(topic, set()).update(types)
    return types_by_topic


def _find_similar_topic(topic: str, topics: dict[str, set[str]]) -> str | None:
    base_name = topic.rpartition("/")[2]
    same_named = [other for other in topics if other.rpartition("/")[2] == base_name]
    return next(iter([*same_named, *nearest(topic, topics, 1)]), None)
