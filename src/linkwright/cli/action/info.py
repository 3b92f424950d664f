"""``linkwright action info``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING

from linkwright.cli.calls import node_names
from linkwright.cli.lookup import absolute
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "say which nodes serve and call an action"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("action_name", metavar="ACTION", help="such as /fibonacci")
    parser.add_argument("-t", "--show-types", action="store_true", help="show the action's type beside each node")
    parser.add_argument("-c", "--count", action="store_true", help="print only how many there are")


def run(arguments: argparse.Namespace) -> int:
    """Print the nodes, as ros2 does."""
    name = absolute(arguments.action_name)

    async def job(session: Session) -> int:
        clients: list[tuple[str, Sequence[str]]] = []
        servers: list[tuple[str, Sequence[str]]] = []
        graph = session.graph
        for full in dict.fromkeys(node_names(session, hidden=True)):
            namespace, _, bare = full.rpartition("/")
            who = (bare, namespace or "/")
            for found, of_node in (
                (clients, graph.get_action_client_names_and_types_by_node(*who)),
                (servers, graph.get_action_server_names_and_types_by_node(*who)),
            ):
                found += [(full, types) for action, types in of_node if action == name]
        print(f"Action: {arguments.action_name}")
        for title, nodes in (("clients", clients), ("servers", servers)):
            print(f"Action {title}: {len(nodes)}")
            for full, types in [] if arguments.count else nodes:
                print(f"    {full} [{', '.join(types)}]" if arguments.show_types else f"    {full}")
        return 0

    return run_in_graph(arguments, job)
