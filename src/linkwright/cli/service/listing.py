"""``linkwright service list``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.lookup import visible
from linkwright.cli.service.arguments import add_hidden_argument
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the services"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="show the type of each service beside it")
    parser.add_argument("-c", "--count-services", "--count", action="store_true", help="print only how many there are")
    add_hidden_argument(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the services' names, as ros2 does."""

    async def job(session: Session) -> int:
        services = visible(session.node.get_service_names_and_types(), hidden=arguments.include_hidden_services)
        if arguments.count_services:
            print(len(services))
            return 0
        for name, types in services:
            print(f"{name} [{', '.join(types)}]" if arguments.show_types else name)
        return 0

    return run_in_graph(arguments, job)
