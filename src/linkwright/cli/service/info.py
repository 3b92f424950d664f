"""``linkwright service info``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.lookup import absolute, unknown
from linkwright.cli.service.arguments import add_hidden_argument
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "say what type a service has and how many serve and call it"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("service_name", metavar="SERVICE", help="such as /add_two_ints")
    add_hidden_argument(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print what is known of the service, as ros2 does."""
    name = absolute(arguments.service_name)

    async def job(session: Session) -> int:
        services = dict(session.node.get_service_names_and_types())
        if name not in services:
            nothing = "`linkwright service list` lists them"
            raise unknown("CLI427", f"Unknown service '{arguments.service_name}'", name, services, nothing)
        types = list(services[name])
        print(f"Type: {types[0] if len(types) == 1 else types}")
        print(f"Clients count: {session.node.count_clients(name)}")
        print(f"Services count: {session.node.count_services(name)}")
        return 0

    return run_in_graph(arguments, job)
