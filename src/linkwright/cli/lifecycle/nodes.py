"""``linkwright lifecycle nodes``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.lifecycle.transitions import managed_nodes
from linkwright.cli.names_listing import add_count_argument, print_names
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the managed nodes"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("-a", "--all", action="store_true", help="list hidden nodes as well")
    add_count_argument(parser, "node")


def run(arguments: argparse.Namespace) -> int:
    """Print the full names of the nodes."""

    async def job(session: Session) -> int:
        print_names(managed_nodes(session, hidden=arguments.all), arguments)
        return 0

    return run_in_graph(arguments, job)
