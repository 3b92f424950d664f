"""``linkwright service list``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.lookup import visible
from linkwright.cli.names_listing import (
    add_count_argument,
    add_hidden_argument,
    add_types_argument,
    print_names_and_types,
)
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the services"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    add_types_argument(parser, "service")
    add_count_argument(parser, "service")
    add_hidden_argument(parser, "service")


def run(arguments: argparse.Namespace) -> int:
    """Print the services' names, as ros2 does."""

    async def job(session: Session) -> int:
        services = visible(session.node.get_service_names_and_types(), hidden=arguments.include_hidden_services)
        print_names_and_types(services, arguments)
        return 0

    return run_in_graph(arguments, job)
