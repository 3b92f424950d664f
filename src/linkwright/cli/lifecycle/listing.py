"""``linkwright lifecycle list``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.calls import find_node
from linkwright.cli.lifecycle.arguments import add_node_arguments
from linkwright.cli.lifecycle.transitions import transition_lines, transitions
from linkwright.cli.session import run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the transitions that a managed node can make"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_node_arguments(parser)
    parser.add_argument("-a", "--all", action="store_true", help="list those of all its states, not of this one")


def run(arguments: argparse.Namespace) -> int:
    """Print the transitions, as ros2 does."""

    async def job(session: Session) -> int:
        node = await find_node(session, arguments.node_name, hidden=arguments.include_hidden_nodes)
        for line in transition_lines(await transitions(session, node, every=arguments.all)):
            print(line)
        return 0

    return run_in_graph(arguments, job)
