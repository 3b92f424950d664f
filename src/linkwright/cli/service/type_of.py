"""``linkwright service type``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.service.arguments import add_service_arguments, types_of_service
from linkwright.cli.session import run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "print the type of a service"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_service_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the types of the service, a line each."""

    async def job(session: Session) -> int:
        print("\n".join(types_of_service(session, arguments)))
        return 0

    return run_in_graph(arguments, job)
