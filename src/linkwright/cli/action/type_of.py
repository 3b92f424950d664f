"""``linkwright action type``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.lookup import absolute, unknown
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.diagnostics import phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "print the type of an action"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("action_name", metavar="ACTION", help="such as /fibonacci")


def run(arguments: argparse.Namespace) -> int:
    """Print the types of the action, a line each."""
    name = absolute(arguments.action_name)

    async def job(session: Session) -> int:
        found = dict(session.node.get_action_names_and_types())
        if name not in found:
            nothing = phrase("`linkwright action list` lists them")
            raise unknown(
                "CLI429",
                phrase("Unknown action '{action_name}'", action_name=arguments.action_name),
                name,
                found,
                nothing,
            )
        for each in found[name]:
            print(each)
        return 0

    return run_in_graph(arguments, job)
