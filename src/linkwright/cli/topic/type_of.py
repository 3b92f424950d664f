"""``linkwright topic type``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.lookup import absolute, unknown, visible
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.diagnostics import phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "print the type of a topic"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", metavar="TOPIC", help="such as /chatter")


def run(arguments: argparse.Namespace) -> int:
    """Print the types in use on the topic, a line each."""
    name = absolute(arguments.topic_name)

    async def job(session: Session) -> int:
        topics = dict(visible(session.node.get_topic_names_and_types(), hidden=arguments.include_hidden_topics))
        if name not in topics:
            raise unknown(
                "CLI411",
                phrase("Unknown topic '{name}'", name=name),
                name,
                topics,
                phrase("`linkwright topic list` lists them"),
            )
        for each in topics[name]:
            print(each)
        return 0

    return run_in_graph(arguments, job)
