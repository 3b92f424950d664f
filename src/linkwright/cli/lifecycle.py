"""``linkwright lifecycle``: list managed nodes, and query and change their states."""

from __future__ import annotations

import argparse
import asyncio
import sys
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from linkwright.cli.calls import NoResponseError, call, find_node, list_node_names
from linkwright.cli.names_listing import add_count_argument, print_names
from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.numbers import positive_float
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, did_you_mean, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session


_RESPONSE_TIMEOUT_S = 5.0
_GET_STATE = "lifecycle_msgs/srv/GetState"


def _add_node_arguments(parser: argparse.ArgumentParser, *, optional: bool = False) -> None:
    """Declare the arguments that select a node, and the arguments of the session."""
    add_session_arguments(parser)
    if optional:
        parser.add_argument(
            "node_name", metavar="NODE", nargs="?", help="the node, such as /lc_talker (default: all managed nodes)"
        )
    else:
        parser.add_argument("node_name", metavar="NODE", help="the node, such as /lc_talker")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="consider hidden nodes as well")


def configure_nodes(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``lifecycle nodes``."""
    add_session_arguments(parser)
    parser.add_argument("-a", "--all", action="store_true", help="list hidden nodes as well")
    add_count_argument(parser, "node")


def run_nodes(arguments: argparse.Namespace) -> int:
    """Print the full names of the managed nodes."""

    async def job(session: Session) -> int:
        print_names(find_managed_nodes(session, hidden=arguments.all), arguments)
        return 0

    return run_in_graph(arguments, job, read_only=True)


def configure_get(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``lifecycle get``."""
    _add_node_arguments(parser, optional=True)
    parser.add_argument("--timeout", metavar="SECONDS", type=positive_float, help="the time to wait for each response")


def run_get(arguments: argparse.Namespace) -> int:
    """Print the current state of one or all managed nodes, as ros2 does."""

    async def job(session: Session) -> int:
        hidden = arguments.include_hidden_nodes
        if arguments.node_name is not None:
            node = await find_node(session, arguments.node_name, hidden=hidden)
            node_state = await request_state(session, node, arguments.timeout)
            print(f"{node_state.label} [{node_state.id}]")
            return 0
        nodes = find_managed_nodes(session, hidden=hidden)
        requests = [request_state(session, node, arguments.timeout or _RESPONSE_TIMEOUT_S) for node in nodes]
        status = 0
        for node, node_state in zip(nodes, await asyncio.gather(*requests, return_exceptions=True), strict=True):
            if isinstance(node_state, NoResponseError):
                print(f"Exception while calling service of node '{node}': {node_state}", file=sys.stderr)
                status = 1
            elif isinstance(node_state, BaseException):
                raise node_state
            else:
                print(f"{node}: {node_state.label} [{node_state.id}]")
        return status

    return run_in_graph(arguments, job)


def configure_list(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``lifecycle list``."""
    _add_node_arguments(parser)
    parser.add_argument(
        "-a", "--all", action="store_true", help="list the transitions of all states, not only of the current state"
    )


def run_list(arguments: argparse.Namespace) -> int:
    """Print the transitions of a node that are available now or, with ``--all``, in any state."""

    async def job(session: Session) -> int:
        node = await find_node(session, arguments.node_name, hidden=arguments.include_hidden_nodes)
        for line in format_transitions(await request_transitions(session, node, all_states=arguments.all)):
            print(line)
        return 0

    return run_in_graph(arguments, job)


def configure_set(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``lifecycle set``."""
    _add_node_arguments(parser)
    parser.add_argument(
        "transition", metavar="TRANSITION", help="the transition's name, such as configure, or its number"
    )


def run_set(arguments: argparse.Namespace) -> int:
    """Trigger a transition, and print whether the transition succeeded."""

    async def job(session: Session) -> int:
        node = await find_node(session, arguments.node_name, hidden=arguments.include_hidden_nodes)
        available = [transition.transition for transition in await request_transitions(session, node)]
        requested_transition = next(
            (candidate for candidate in available if arguments.transition in (candidate.label, str(candidate.id))), None
        )
        if requested_transition is None:
            transition_list = "\n".join(f"- {candidate.label} [{candidate.id}]" for candidate in available)
            raise LinkwrightError(
                Diagnostic(
                    "CLI431",
                    phrase(
                        "Unknown transition requested: node '{node}' has no transition '{transition}' in its "
                        "current state",
                        node=node,
                        transition=arguments.transition,
                    ),
                    notes=(Note(phrase("available transitions:\n{transitions}", transitions=transition_list)),),
                    hint=did_you_mean(arguments.transition, [candidate.label for candidate in available]),
                )
            )
        if await trigger_transition(session, node, requested_transition):
            print("Transitioning successful")
            return 0
        print("Transitioning failed", file=sys.stderr)
        return 1

    return run_in_graph(arguments, job)


def find_managed_nodes(session: Session, *, hidden: bool = False) -> list[str]:
    """Return the sorted full names of the managed nodes.

    A managed node is a node with a ``get_state`` service.
    """
    services = dict(session.node.get_service_names_and_types())
    names = dict.fromkeys(list_node_names(session, hidden=hidden))
    return [name for name in names if _GET_STATE in services.get(f"{name}/get_state", ())]


async def request_state(session: Session, node: str, timeout: float | None = None) -> Any:
    """Return the current state of a managed node (lifecycle_msgs/msg/State).

    Raises:
        NoResponseError: the service does not exist, or does not respond within `timeout` seconds.
    """
    from linkwright.messages import get_service

    request = get_service(_GET_STATE).Request()
    return (await call(session, _GET_STATE, f"{node}/get_state", request, timeout=timeout)).current_state


async def request_transitions(session: Session, node: str, *, all_states: bool = False) -> Sequence[Any]:
    """Return a managed node's transitions, as lifecycle_msgs/msg/TransitionDescription.

    These are the transitions available in the current state or, if `all_states` is set, the transitions of all states.
    """
    from linkwright.messages import get_service

    service_type = "lifecycle_msgs/srv/GetAvailableTransitions"
    service = "get_transition_graph" if all_states else "get_available_transitions"
    response = await call(session, service_type, f"{node}/{service}", get_service(service_type).Request())
    descriptions: Sequence[Any] = response.available_transitions
    return descriptions


async def trigger_transition(session: Session, node: str, transition: Any) -> bool:
    """Trigger a transition (lifecycle_msgs/msg/Transition), and return whether it succeeded."""
    from linkwright.messages import get_service

    service_type = "lifecycle_msgs/srv/ChangeState"
    request = get_service(service_type).Request()
    request.transition.id = transition.id
    request.transition.label = transition.label
    return bool((await call(session, service_type, f"{node}/change_state", request)).success)


def format_transitions(descriptions: Sequence[Any]) -> list[str]:
    """Return the lines that ``lifecycle list`` prints for transitions."""
    lines = []
    for description in descriptions:
        lines += [
            f"- {description.transition.label} [{description.transition.id}]",
            f"\tStart: {description.start_state.label}",
            f"\tGoal: {description.goal_state.label}",
        ]
    return lines


VERBS = {
    "get": SubVerb(configure_get, run_get, help="print the state of one managed node or of all"),
    "list": SubVerb(configure_list, run_list, help="list the transitions available to a managed node"),
    "nodes": SubVerb(configure_nodes, run_nodes, help="list the managed nodes"),
    "set": SubVerb(configure_set, run_set, help="trigger a transition of a managed node"),
}

configure = partial(configure_nested, verbs=VERBS)
run = run_nested
