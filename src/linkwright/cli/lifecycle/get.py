"""``linkwright lifecycle get``."""

from __future__ import annotations

import argparse
import asyncio
import sys
from typing import TYPE_CHECKING

from linkwright.cli.calls import NoAnswerError, find_node
from linkwright.cli.lifecycle.arguments import add_node_arguments
from linkwright.cli.lifecycle.transitions import managed_nodes, state
from linkwright.cli.numbers import positive_float
from linkwright.cli.session import run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "print the state of one managed node or of all"

_LONGEST_ANSWER = 5.0


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_node_arguments(parser, optional=True)
    parser.add_argument("--timeout", metavar="SECONDS", type=positive_float, help="wait so long for each answer")


def run(arguments: argparse.Namespace) -> int:
    """Print the states, as ros2 does."""

    async def job(session: Session) -> int:
        hidden = arguments.include_hidden_nodes
        if arguments.node_name is not None:
            node = await find_node(session, arguments.node_name, hidden=hidden)
            found = await state(session, node, arguments.timeout)
            print(f"{found.label} [{found.id}]")
            return 0
        nodes = managed_nodes(session, hidden=hidden)
        asked = [state(session, node, arguments.timeout or _LONGEST_ANSWER) for node in nodes]
        status = 0
        for node, found in zip(nodes, await asyncio.gather(*asked, return_exceptions=True), strict=True):
            if isinstance(found, NoAnswerError):
                print(f"Exception while calling service of node '{node}': {found}", file=sys.stderr)
                status = 1
            elif isinstance(found, BaseException):
                raise found
            else:
                print(f"{node}: {found.label} [{found.id}]")
        return status

    return run_in_graph(arguments, job)
