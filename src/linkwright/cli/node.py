"""``linkwright node``: list and describe the nodes of the running graph."""

from __future__ import annotations

import argparse
import sys
from functools import partial
from typing import TYPE_CHECKING

from linkwright.cli.calls import list_node_names
from linkwright.cli.lookup import NamesAndTypes, add_leading_slash, sort_visible_names, unknown_name_error
from linkwright.cli.names_listing import add_count_argument, print_names
from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.diagnostics import phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session


_DISCOVERY_TIMEOUT_S = 1.0
"""Seconds to wait for a node that has not been discovered."""


def configure_list(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``node list``."""
    add_session_arguments(parser)
    parser.add_argument("-a", "--all", action="store_true", help="list hidden nodes as well")
    add_count_argument(parser, "node")


def run_list(arguments: argparse.Namespace) -> int:
    """Print the full names of the nodes."""

    async def job(session: Session) -> int:
        names = list_node_names(session, hidden=arguments.all)
        if len(set(names)) < len(names) and not arguments.count:
            print(
                "WARNING: Be aware that there are nodes in the graph that share an exact name, which can have"
                " unintended side effects.",
                file=sys.stderr,
            )
        print_names(names, arguments)
        return 0

    return run_in_graph(arguments, job, read_only=True)


def configure_info(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``node info``."""
    add_session_arguments(parser)
    parser.add_argument("node_name", metavar="NODE", help="the node, such as /robot_state_publisher")
    parser.add_argument("--include-hidden", action="store_true", help="also show hidden topics, services and actions")


def run_info(arguments: argparse.Namespace) -> int:
    """Print the topics, services and actions of a node, as ros2 does."""
    full_name = add_leading_slash(arguments.node_name)
    hidden = arguments.include_hidden

    async def job(session: Session) -> int:
        await session.wait_until(lambda: full_name in list_node_names(session, hidden=hidden), _DISCOVERY_TIMEOUT_S)
        names = list_node_names(session, hidden=hidden)
        count = names.count(full_name)
        if not count:
            message = phrase("Unable to find node '{node_name}'", node_name=arguments.node_name)
            raise unknown_name_error(
                "CLI423", message, full_name, names, phrase("run `linkwright node list` to list the nodes")
            )
        if count > 1:
            print(
                f"There are {count} nodes in the graph with the exact name '{full_name}'."
                " You are seeing information about only one of them.",
                file=sys.stderr,
            )
        node = session.node
        namespace, _, name = full_name.rpartition("/")
        node_key = (name, namespace or "/")
        print(full_name)
        _print_section("Subscribers", node.get_subscriber_names_and_types_by_node(*node_key), hidden=hidden)
        _print_section("Publishers", node.get_publisher_names_and_types_by_node(*node_key), hidden=hidden)
        _print_section("Service Servers", node.get_service_names_and_types_by_node(*node_key), hidden=hidden)
        _print_section("Service Clients", node.get_client_names_and_types_by_node(*node_key), hidden=hidden)
        _print_section(
            "Action Servers", session.graph.get_action_server_names_and_types_by_node(*node_key), hidden=hidden
        )
        _print_section(
            "Action Clients", session.graph.get_action_client_names_and_types_by_node(*node_key), hidden=hidden
        )
        return 0

    return run_in_graph(arguments, job, read_only=True)


def _print_section(title: str, names_and_types: NamesAndTypes, *, hidden: bool) -> None:
    print(f"  {title}:")
    lines = [f"    {name}: {', '.join(types)}" for name, types in sort_visible_names(names_and_types, hidden=hidden)]
    print("\n".join(lines))


VERBS = {
    "info": SubVerb(
        configure_info, run_info, help="describe a node: its publishers, subscriptions, services, clients and actions"
    ),
    "list": SubVerb(configure_list, run_list, help="list the nodes"),
}

configure = partial(configure_nested, verbs=VERBS)
run = run_nested
