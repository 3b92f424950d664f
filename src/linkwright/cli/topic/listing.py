"""``linkwright topic list``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING

from linkwright.cli.lookup import visible
from linkwright.cli.names_listing import (
    add_count_argument,
    add_hidden_argument,
    add_types_argument,
    print_names_and_types,
)
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the topics"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    add_types_argument(parser, "topic")
    add_count_argument(parser, "topic")
    add_hidden_argument(parser, "topic")
    parser.add_argument("-v", "--verbose", action="store_true", help="say how many publish and subscribe to each")


def run(arguments: argparse.Namespace) -> int:
    """Print the topics' names, as ros2 does."""

    async def job(session: Session) -> int:
        node = session.node
        topics = visible(node.get_topic_names_and_types(), hidden=arguments.include_hidden_topics)
        if arguments.verbose and topics and not arguments.count:
            publishers = [(name, types, node.count_publishers(name)) for name, types in topics]
            subscribers = [(name, types, node.count_subscribers(name)) for name, types in topics]
            print(_counted("Published", "publisher", publishers))
            print(_counted("Subscribed", "subscriber", subscribers))
        else:
            print_names_and_types(topics, arguments)
        return 0

    return run_in_graph(arguments, job)


def _counted(title: str, kind: str, topics: Sequence[tuple[str, Sequence[str], int]]) -> str:
    lines = [f"{title} topics:"]
    for name, types, count in topics:
        if count:
            lines.append(f" * {name} [{', '.join(types)}] {count} {kind}{'s' if count > 1 else ''}")
    return "\n".join([*lines, ""])
