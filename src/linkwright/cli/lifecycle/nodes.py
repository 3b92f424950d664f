"""``linkwright lifecycle nodes``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.lifecycle.transitions import managed_nodes
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the managed nodes"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("-a", "--all", action="store_true", help="list hidden nodes as well")
    parser.add_argument("-c", "--count-nodes", "--count", action="store_true", help="print only how many there are")


def run(arguments: argparse.Namespace) -> int:
    """Print the full names of the nodes."""

    async def job(session: Session) -> int:
        names = managed_nodes(session, hidden=arguments.all)
        for line in [len(names)] if arguments.count_nodes else names:
            print(line)
        return 0

    return run_in_graph(arguments, job)
