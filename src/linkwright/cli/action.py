"""``linkwright action``: list and describe actions of the running graph, and send goals."""

from __future__ import annotations

import argparse
import asyncio
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from linkwright.cli.calls import list_node_names
from linkwright.cli.lookup import make_absolute
from linkwright.cli.names_listing import Kind, add_count_argument, add_types_argument, print_names_and_types
from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.numbers import positive_float
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.values import add_values_arguments, fill_message, parse_values, read_values
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session


_STATUS_NAMES = {1: "ACCEPTED", 2: "EXECUTING", 3: "CANCELING", 4: "SUCCEEDED", 5: "CANCELED", 6: "ABORTED"}
_CANCEL_TIMEOUT_S = 3.0
"""Seconds to wait for the server's response when Ctrl-C cancels a goal."""


def configure_list(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``action list``."""
    add_session_arguments(parser)
    add_types_argument(parser, types_help="also print the type of each action")
    add_count_argument(parser, "action")


def run_list(arguments: argparse.Namespace) -> int:
    """Print the names of the actions, as ros2 does."""

    async def job(session: Session) -> int:
        print_names_and_types(session.node.get_action_names_and_types(), arguments)
        return 0

    return run_in_graph(arguments, job, read_only=True)


def configure_info(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``action info``."""
    add_session_arguments(parser)
    parser.add_argument("action_name", metavar="ACTION", help="the action, such as /fibonacci")
    parser.add_argument("-t", "--show-types", action="store_true", help="also print the action's type for each node")
    parser.add_argument("-c", "--count", action="store_true", help="print only the number of results")


def run_info(arguments: argparse.Namespace) -> int:
    """Print the nodes that use an action, as ros2 does."""
    name = make_absolute(arguments.action_name)

    async def job(session: Session) -> int:
        clients: list[tuple[str, Sequence[str]]] = []
        servers: list[tuple[str, Sequence[str]]] = []
        graph = session.graph
        for full_name in dict.fromkeys(list_node_names(session, hidden=True)):
            namespace, _, base_name = full_name.rpartition("/")
            node_key = (base_name, namespace or "/")
            for endpoints, node_actions in (
                (clients, graph.get_action_client_names_and_types_by_node(*node_key)),
                (servers, graph.get_action_server_names_and_types_by_node(*node_key)),
            ):
                endpoints += [(full_name, types) for action, types in node_actions if action == name]
        print(f"Action: {arguments.action_name}")
        for title, nodes in (("clients", clients), ("servers", servers)):
            print(f"Action {title}: {len(nodes)}")
            for full_name, types in [] if arguments.count else nodes:
                print(f"    {full_name} [{', '.join(types)}]" if arguments.show_types else f"    {full_name}")
        return 0

    return run_in_graph(arguments, job, read_only=True)


def configure_type(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``action type``."""
    add_session_arguments(parser)
    parser.add_argument("action_name", metavar="ACTION", help="the action, such as /fibonacci")


def run_type(arguments: argparse.Namespace) -> int:
    """Print the types of the action, one per line."""
    actions = Kind(
        lambda session: session.node.get_action_names_and_types(),
        "CLI429",
        lambda action_name: phrase("Unknown action '{action_name}'", action_name=action_name),
        phrase("run `linkwright action list` to list the actions"),
    )
    return actions.print_types(arguments, arguments.action_name)


def configure_send_goal(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``action send_goal``."""
    add_session_arguments(parser)
    parser.add_argument("action_name", metavar="ACTION", help="the action, such as /fibonacci")
    parser.add_argument(
        "action_type", metavar="TYPE", help="the action's type, such as example_interfaces/action/Fibonacci"
    )
    add_values_arguments(
        parser,
        values_help="the goal in YAML, such as '{order: 10}'; omitted fields keep their defaults",
        metavar="GOAL",
    )
    parser.add_argument("-f", "--feedback", action="store_true", help="print the feedback")
    parser.add_argument(
        "--timeout", metavar="SECONDS", type=positive_float, help="stop waiting for a server after this time"
    )


def run_send_goal(arguments: argparse.Namespace) -> int:
    """Send a goal and print its progress as ros2 does.

    Ctrl-C cancels the goal.
    """
    from linkwright.messages import get_action, to_yaml

    name = make_absolute(arguments.action_name)
    action_class = get_action(arguments.action_type)
    text = read_values(arguments)
    goal = action_class.Goal()
    fill_message(goal, parse_values(text)[0], text)

    async def job(session: Session) -> int:
        from linkwright.graph import ActionClient

        client = ActionClient(session.node, action_class, name)
        print("Waiting for an action server to become available...")
        if not await session.wait_until(client.server_is_ready, arguments.timeout):
            raise LinkwrightError(
                Diagnostic(
                    "CLI430",
                    phrase(
                        "no server of action '{name}' appeared within {timeout} s", name=name, timeout=arguments.timeout
                    ),
                )
            )
        print(f"Sending goal:\n     {to_yaml(goal)}")

        def print_feedback(message: Any) -> None:
            print(f"Feedback:\n    {to_yaml(message.feedback)}")

        goal_future = client.send_goal_async(goal, session.guard(print_feedback) if arguments.feedback else None)
        handle = await session.wait_for_result(goal_future)
        if handle is None or not handle.accepted:
            print("Goal was rejected.")
            return 1
        print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n")
        try:
            result = await session.wait_for_result(handle.get_result_async())
        except asyncio.CancelledError:
            await _cancel(session, handle)
            raise
        if result is None:
            return await session.wait_until_finished() or 0
        print(f"Result:\n    {to_yaml(result.result)}")
        print(f"Goal finished with status: {_STATUS_NAMES.get(result.status, 'UNKNOWN')}")
        return 0

    return run_in_graph(arguments, job)


async def _cancel(session: Session, handle: Any) -> None:
    print("Canceling goal...")
    response = await session.wait_for_result(handle.cancel_goal_async(), _CANCEL_TIMEOUT_S)
    if response is None:
        print("The server does not respond; the goal may still be active")
    elif not response.goals_canceling:
        print("Failed to cancel goal")
    else:
        print("Goal canceled.")


VERBS = {
    "info": SubVerb(configure_info, run_info, help="list the nodes that serve and call an action"),
    "list": SubVerb(configure_list, run_list, help="list the actions"),
    "send_goal": SubVerb(
        configure_send_goal, run_send_goal, help="send a goal to an action server and wait for the result"
    ),
    "type": SubVerb(configure_type, run_type, help="print the type of an action"),
}

configure = partial(configure_nested, verbs=VERBS)
run = run_nested
