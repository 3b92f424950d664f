"""``linkwright action list``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.names_listing import add_count_argument, add_types_argument, print_names_and_types
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the actions"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    add_types_argument(parser, "action")
    add_count_argument(parser, "action")


def run(arguments: argparse.Namespace) -> int:
    """Print the actions' names, as ros2 does."""

    async def job(session: Session) -> int:
        print_names_and_types(session.node.get_action_names_and_types(), arguments)
        return 0

    return run_in_graph(arguments, job)
