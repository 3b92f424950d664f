"""``linkwright action list``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the actions"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="show the type of each action beside it")
    parser.add_argument("-c", "--count-actions", "--count", action="store_true", help="print only how many there are")


def run(arguments: argparse.Namespace) -> int:
    """Print the actions' names, as ros2 does."""

    async def job(session: Session) -> int:
        found = session.node.get_action_names_and_types()
        if arguments.count_actions:
            print(len(found))
            return 0
        for name, types in found:
            print(f"{name} [{', '.join(types)}]" if arguments.show_types else name)
        return 0

    return run_in_graph(arguments, job)
