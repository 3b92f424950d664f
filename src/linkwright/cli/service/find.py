"""``linkwright service find``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.lookup import visible
from linkwright.cli.service.arguments import add_hidden_argument
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the services of a type"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("service_type", metavar="TYPE", help="such as std_srvs/srv/SetBool")
    parser.add_argument("-c", "--count-services", "--count", action="store_true", help="print only how many there are")
    add_hidden_argument(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the names of the services."""

    async def job(session: Session) -> int:
        services = visible(session.node.get_service_names_and_types(), hidden=arguments.include_hidden_services)
        names = [name for name, types in services if arguments.service_type in types]
        for line in [len(names)] if arguments.count_services else names:
            print(line)
        return 0

    return run_in_graph(arguments, job)
