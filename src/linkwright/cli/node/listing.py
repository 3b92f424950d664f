"""``linkwright node list``."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from linkwright.cli.calls import node_names
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the nodes"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("-a", "--all", action="store_true", help="list hidden nodes as well")
    parser.add_argument("-c", "--count-nodes", "--count", action="store_true", help="print only how many there are")


def run(arguments: argparse.Namespace) -> int:
    """Print the full names of the nodes."""

    async def job(session: Session) -> int:
        names = node_names(session, hidden=arguments.all)
        if arguments.count_nodes:
            print(len(names))
            return 0
        if len(set(names)) < len(names):
            print(
                "WARNING: Be aware that there are nodes in the graph that share an exact name, which can have"
                " unintended side effects.",
                file=sys.stderr,
            )
        for name in names:
            print(name)
        return 0

    return run_in_graph(arguments, job)
