"""``linkwright component list``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.component.containers import containers, find_container, held_nodes
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "list the containers and the nodes in them"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("container_node_name", metavar="CONTAINER", nargs="?", help="only this one's nodes")
    parser.add_argument("--containers-only", action="store_true", help="list only the containers")


def run(arguments: argparse.Namespace) -> int:
    """Print them, as ros2 does."""

    async def job(session: Session) -> int:
        if arguments.container_node_name is not None:
            container = await find_container(session, arguments.container_node_name)
            for uid, name in [] if arguments.containers_only else await held_nodes(session, container):
                print(f"{uid}  {name}")
            return 0
        for container in containers(session):
            print(container)
            for uid, name in [] if arguments.containers_only else await held_nodes(session, container):
                print(f"  {uid}  {name}")
        return 0

    return run_in_graph(arguments, job)
