"""``linkwright service info``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.lookup import absolute
from linkwright.cli.service.arguments import add_service_arguments, types_of_service
from linkwright.cli.session import run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "say what type a service has and how many serve and call it"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_service_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print what is known of the service, as ros2 does."""
    name = absolute(arguments.service_name)

    async def job(session: Session) -> int:
        types = types_of_service(session, arguments)
        print(f"Type: {types[0] if len(types) == 1 else types}")
        print(f"Clients count: {session.node.count_clients(name)}")
        print(f"Services count: {session.node.count_services(name)}")
        return 0

    return run_in_graph(arguments, job)
