"""``linkwright action send_goal``."""

from __future__ import annotations

import argparse
import asyncio
from typing import TYPE_CHECKING, Any

from linkwright.cli.calls import is_ready
from linkwright.cli.lookup import absolute
from linkwright.cli.numbers import positive_float
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.values import add_values_arguments, fill, parse_values, read_values
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "send a goal to an action server and wait for the result"

_STATUS = {1: "ACCEPTED", 2: "EXECUTING", 3: "CANCELING", 4: "SUCCEEDED", 5: "CANCELED", 6: "ABORTED"}
_LONGEST_CANCEL = 3.0
"""Seconds to wait for the server's word on a goal that is called off with Ctrl-C."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("action_name", metavar="ACTION", help="such as /fibonacci")
    parser.add_argument("action_type", metavar="TYPE", help="such as example_interfaces/action/Fibonacci")
    goal_help = "the goal in YAML, such as '{order: 10}'; fields left out have their defaults"
    add_values_arguments(parser, goal_help, "GOAL")
    parser.add_argument("-f", "--feedback", action="store_true", help="print the feedback")
    parser.add_argument("--timeout", metavar="SECONDS", type=positive_float, help="give up waiting for a server then")


def run(arguments: argparse.Namespace) -> int:
    """Print what becomes of the goal, as ros2 does. Interrupted, the goal is called off."""
    from linkwright.messages import get_action, to_yaml

    name = absolute(arguments.action_name)
    kind = get_action(arguments.action_type)
    text = read_values(arguments)
    goal = kind.Goal()
    fill(goal, parse_values(text)[0], text)

    async def job(session: Session) -> int:
        from linkwright.graph import ActionClient

        client = ActionClient(session.node, kind, name)
        print("Waiting for an action server to become available...")
        if not await is_ready(session, name, client, client.server_is_ready, arguments.timeout):
            raise LinkwrightError(
                Diagnostic(
                    "CLI430",
                    phrase("no server of action '{name}' in {timeout} s", name=name, timeout=arguments.timeout),
                )
            )
        print(f"Sending goal:\n     {to_yaml(goal)}")

        def feedback(message: Any) -> None:
            print(f"Feedback:\n    {to_yaml(message.feedback)}")

        sent = client.send_goal_async(goal, session.guarded(feedback) if arguments.feedback else None)
        handle = await session.answer(sent)
        if handle is None or not handle.accepted:
            print("Goal was rejected.")
            return 1
        print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n")
        try:
            result = await session.answer(handle.get_result_async())
        except asyncio.CancelledError:
            await _call_off(session, handle)
            raise
        if result is None:
            return await session.finished() or 0
        print(f"Result:\n    {to_yaml(result.result)}")
        print(f"Goal finished with status: {_STATUS.get(result.status, 'UNKNOWN')}")
        return 0

    return run_in_graph(arguments, job)


async def _call_off(session: Session, handle: Any) -> None:
    print("Canceling goal...")
    response = await session.answer(handle.cancel_goal_async(), _LONGEST_CANCEL)
    if response is None:
        print("The server does not answer; the goal may go on")
    elif not response.goals_canceling:
        print("Failed to cancel goal")
    else:
        print("Goal canceled.")
