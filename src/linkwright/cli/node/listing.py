"""``linkwright node list``."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from linkwright.cli.calls import node_names
from linkwright.cli.names_listing import add_count_argument, print_names
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the nodes"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("-a", "--all", action="store_true", help="list hidden nodes as well")
    add_count_argument(parser, "node")


def run(arguments: argparse.Namespace) -> int:
    """Print the full names of the nodes."""

    async def job(session: Session) -> int:
        names = node_names(session, hidden=arguments.all)
        if len(set(names)) < len(names) and not arguments.count:
            print(
                "WARNING: Be aware that there are nodes in the graph that share an exact name, which can have"
                " unintended side effects.",
                file=sys.stderr,
            )
        print_names(names, arguments)
        return 0

    return run_in_graph(arguments, job)
