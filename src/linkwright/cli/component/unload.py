"""``linkwright component unload``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.cli.component.containers import find_container, unload
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "take nodes out of a running container"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("container_node_name", metavar="CONTAINER", help="such as /ComponentManager")
    parser.add_argument(
        "component_uid", metavar="NUMBER", type=int, nargs="+", help="the node's number, as `component list` tells"
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="print only the numbers")


def run(arguments: argparse.Namespace) -> int:
    """Unload them."""

    async def job(session: Session) -> int:
        container = await find_container(session, arguments.container_node_name)
        for uid in arguments.component_uid:
            await unload(session, container, uid)
            print(uid if arguments.quiet else f"Unloaded component {uid} from '{container}' container node")
        return 0

    return run_in_graph(arguments, job)
