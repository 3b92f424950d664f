"""The service that a verb is about."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.lookup import absolute, unknown
from linkwright.cli.names_listing import add_hidden_argument
from linkwright.cli.session import add_session_arguments
from linkwright.diagnostics import phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session


def add_service_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the service and how it is looked for."""
    add_session_arguments(parser)
    parser.add_argument("service_name", metavar="SERVICE", help="such as /add_two_ints")
    add_hidden_argument(parser, "service")


def types_of_service(session: Session, arguments: argparse.Namespace) -> list[str]:
    """The types of the service that the command line names.

    Raises:
        LinkwrightError: CLI427, there is no such service.
        InvalidNameError: it is no name.
    """
    name = absolute(arguments.service_name)
    services = dict(session.node.get_service_names_and_types())
    if name not in services:
        nothing = phrase("`linkwright service list` lists them")
        raise unknown(
            "CLI427",
            phrase("Unknown service '{service_name}'", service_name=arguments.service_name),
            name,
            services,
            nothing,
        )
    return list(services[name])
