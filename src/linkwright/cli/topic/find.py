"""``linkwright topic find``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.lookup import visible
from linkwright.cli.names_listing import add_count_argument, add_hidden_argument, print_names
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the topics of a type"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("topic_type", metavar="TYPE", help="such as std_msgs/msg/String")
    add_count_argument(parser, "topic")
    add_hidden_argument(parser, "topic")


def run(arguments: argparse.Namespace) -> int:
    """Print the names of the topics."""

    async def job(session: Session) -> int:
        topics = visible(session.node.get_topic_names_and_types(), hidden=arguments.include_hidden_topics)
        print_names([name for name, types in topics if arguments.topic_type in types], arguments)
        return 0

    return run_in_graph(arguments, job)
