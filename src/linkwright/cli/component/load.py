"""``linkwright component load``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.component.containers import add_component_arguments, find_container, load
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "load a component into a running container"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("container_node_name", metavar="CONTAINER", help="such as /ComponentManager")
    add_component_arguments(parser)
    parser.add_argument("-q", "--quiet", action="store_true", help="print only the number and name of the node")


def run(arguments: argparse.Namespace) -> int:
    """Load it, and print the node's number and name."""

    async def job(session: Session) -> int:
        container = await find_container(session, arguments.container_node_name)
        uid, name = await load(session, container, arguments)
        if arguments.quiet:
            print(f"{uid}  {name}")
        else:
            print(f"Loaded component {uid} into '{container}' container node as '{name}'")
        return 0

    return run_in_graph(arguments, job)
