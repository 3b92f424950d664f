"""``linkwright topic info``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.endpoints import endpoint_text
from linkwright.cli.lookup import absolute, unknown
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.diagnostics import phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "say what type a topic has and how many publish and subscribe to it"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", metavar="TOPIC", help="such as /chatter")
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="describe each publisher and subscription: node, type, QoS"
    )


def run(arguments: argparse.Namespace) -> int:
    """Print what is known of the topic, as ros2 does."""
    name = absolute(arguments.topic_name)

    async def job(session: Session) -> int:
        node = session.node
        topics = dict(node.get_topic_names_and_types())
        if name not in topics:
            message = phrase("Unknown topic '{topic_name}'", topic_name=arguments.topic_name)
            raise unknown("CLI411", message, name, topics, phrase("`linkwright topic list` lists them"))
        types = list(topics[name])
        end = "\n\n" if arguments.verbose else "\n"
        print(f"Type: {types[0] if len(types) == 1 else types}", end=end)
        print(f"Publisher count: {node.count_publishers(name)}", end=end)
        if arguments.verbose:
            for each in node.get_publishers_info_by_topic(name):
                print(endpoint_text(each), end=end)
        print(f"Subscription count: {node.count_subscribers(name)}", end=end)
        if arguments.verbose:
            for each in node.get_subscriptions_info_by_topic(name):
                print(endpoint_text(each), end=end)
        return 0

    return run_in_graph(arguments, job)
