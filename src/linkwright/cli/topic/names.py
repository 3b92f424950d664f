"""``linkwright topic list``, ``info``, ``find`` and ``type``: list and describe topics."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from linkwright.cli.lookup import make_absolute, sort_visible_names
from linkwright.cli.names_listing import (
    Kind,
    add_count_argument,
    add_hidden_argument,
    add_types_argument,
    print_names_and_types,
)
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.diagnostics import phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session
    from linkwright.graph import QoSProfile

_TOPICS = Kind(
    lambda session: session.node.get_topic_names_and_types(),
    "CLI411",
    lambda topic_name: phrase("Unknown topic '{topic_name}'", topic_name=topic_name),
    phrase("run `linkwright topic list` to list the topics"),
)

_INFINITE_DURATION_NS = 0x7FFFFFFF_FFFFFFFF
"""The smallest infinite duration in nanoseconds (rmw: 9223372036.854775807 s)."""


def configure_list(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``topic list``."""
    add_session_arguments(parser)
    add_types_argument(parser, types_help="also print the type of each topic")
    add_count_argument(parser, "topic")
    add_hidden_argument(parser, "--include-hidden-topics", hidden_help="consider hidden topics as well")
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="print the numbers of publishers and subscriptions of each topic"
    )


def run_list(arguments: argparse.Namespace) -> int:
    """Print the topic names, as ros2 does."""

    async def job(session: Session) -> int:
        node = session.node
        topics = sort_visible_names(node.get_topic_names_and_types(), hidden=arguments.include_hidden_topics)
        if arguments.verbose and topics and not arguments.count:
            publishers = [(name, types, node.count_publishers(name)) for name, types in topics]
            subscribers = [(name, types, node.count_subscribers(name)) for name, types in topics]
            print(_format_endpoint_counts("Published", "publisher", publishers))
            print(_format_endpoint_counts("Subscribed", "subscriber", subscribers))
        else:
            print_names_and_types(topics, arguments)
        return 0

    return run_in_graph(arguments, job, read_only=True)


def _format_endpoint_counts(title: str, kind: str, topics: Sequence[tuple[str, Sequence[str], int]]) -> str:
    lines = [f"{title} topics:"]
    for name, types, count in topics:
        if count:
            lines.append(f" * {name} [{', '.join(types)}] {count} {kind}{'s' if count > 1 else ''}")
    return "\n".join([*lines, ""])


def configure_info(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``topic info``."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", metavar="TOPIC", help="the topic, such as /chatter")
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="describe each publisher and subscription: node, type, QoS"
    )


def run_info(arguments: argparse.Namespace) -> int:
    """Print information about a topic, as ros2 does."""
    name = make_absolute(arguments.topic_name)

    async def job(session: Session) -> int:
        node = session.node
        types = _TOPICS.find_types(session, arguments.topic_name)
        end = "\n\n" if arguments.verbose else "\n"
        print(f"Type: {types[0] if len(types) == 1 else types}", end=end)
        print(f"Publisher count: {node.count_publishers(name)}", end=end)
        if arguments.verbose:
            for endpoint in node.get_publishers_info_by_topic(name):
                print(format_endpoint(endpoint), end=end)
        print(f"Subscription count: {node.count_subscribers(name)}", end=end)
        if arguments.verbose:
            for endpoint in node.get_subscriptions_info_by_topic(name):
                print(format_endpoint(endpoint), end=end)
        return 0

    return run_in_graph(arguments, job, read_only=True)


def configure_find(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``topic find``."""
    add_session_arguments(parser)
    parser.add_argument("topic_type", metavar="TYPE", help="the type, such as std_msgs/msg/String")
    add_count_argument(parser, "topic")
    add_hidden_argument(parser, "--include-hidden-topics", hidden_help="consider hidden topics as well")


def run_find(arguments: argparse.Namespace) -> int:
    """Print the names of the topics of a type."""
    return _TOPICS.print_of_type(arguments, arguments.topic_type, hidden=arguments.include_hidden_topics)


def configure_type(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``topic type``."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", metavar="TOPIC", help="the topic, such as /chatter")


def run_type(arguments: argparse.Namespace) -> int:
    """Print the types of a topic, one per line."""
    return _TOPICS.print_types(arguments, arguments.topic_name, hidden=arguments.include_hidden_topics)


def format_endpoint(info: Any) -> str:
    """Return several lines that describe an endpoint (rclpy ``TopicEndpointInfo``).

    The type hash is included only if the endpoint's process announces it. Humble does not announce type hashes.
    """
    lines = [
        f"Node name: {info.node_name}",
        f"Node namespace: {info.node_namespace}",
        f"Topic type: {info.topic_type}",
    ]
    if str(info.topic_type_hash or ""):
        lines.append(f"Topic type hash: {info.topic_type_hash}")
    lines += [
        f"Endpoint type: {info.endpoint_type.name}",
        f"GID: {'.'.join(f'{byte:02x}' for byte in info.endpoint_gid)}",
        "QoS profile:",
        *format_qos_lines(info.qos_profile),
    ]
    return "\n".join(lines)


def format_qos_lines(qos: QoSProfile) -> list[str]:
    """Return one output line for each policy of a QoS profile."""
    history = qos.history.name
    if history == "KEEP_LAST":
        history = f"{history} ({qos.depth})"
    return [
        f"  Reliability: {qos.reliability.name}",
        f"  History (Depth): {history}",
        f"  Durability: {qos.durability.name}",
        f"  Lifespan: {_format_duration(qos.lifespan)}",
        f"  Deadline: {_format_duration(qos.deadline)}",
        f"  Liveliness: {qos.liveliness.name}",
        f"  Liveliness lease duration: {_format_duration(qos.liveliness_lease_duration)}",
    ]


def _format_duration(duration: Any) -> str:
    nanoseconds = duration.nanoseconds
    if nanoseconds == 0 or nanoseconds >= _INFINITE_DURATION_NS:
        return "Infinite"
    return f"{nanoseconds} nanoseconds"
