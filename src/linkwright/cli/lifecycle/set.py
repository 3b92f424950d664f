"""``linkwright lifecycle set``."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from linkwright.cli.calls import find_node
from linkwright.cli.lifecycle.arguments import add_node_arguments
from linkwright.cli.lifecycle.transitions import change, transitions
from linkwright.cli.session import run_in_graph
from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, did_you_mean, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "have a managed node make a transition"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_node_arguments(parser)
    parser.add_argument("transition", metavar="TRANSITION", help="its name, such as configure, or its number")


def run(arguments: argparse.Namespace) -> int:
    """Make it, and say whether it came about."""

    async def job(session: Session) -> int:
        node = await find_node(session, arguments.node_name, hidden=arguments.include_hidden_nodes)
        available = [each.transition for each in await transitions(session, node)]
        wanted = next((each for each in available if arguments.transition in (each.label, str(each.id))), None)
        if wanted is None:
            listed = "\n".join(f"- {each.label} [{each.id}]" for each in available)
            raise LinkwrightError(
                Diagnostic(
                    "CLI431",
                    phrase(
                        "Unknown transition requested: node '{node}' cannot make '{transition}' now",
                        node=node,
                        transition=arguments.transition,
                    ),
                    notes=(Note(phrase("available ones are:\n{listed}", listed=listed)),),
                    hint=did_you_mean(arguments.transition, [each.label for each in available]),
                )
            )
        if await change(session, node, wanted):
            print("Transitioning successful")
            return 0
        print("Transitioning failed", file=sys.stderr)
        return 1

    return run_in_graph(arguments, job)
