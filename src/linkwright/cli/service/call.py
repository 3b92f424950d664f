"""``linkwright service call``."""

from __future__ import annotations

import argparse
import asyncio
from typing import TYPE_CHECKING

from linkwright.cli.calls import is_ready
from linkwright.cli.lookup import absolute
from linkwright.cli.numbers import positive_float
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.values import add_values_arguments, fill, parse_values, read_values
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "call a service"

_AT_ONCE = 0.2
"""Seconds within which a service may appear before it is said that it is waited for."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("service_name", metavar="SERVICE", help="such as /add_two_ints")
    parser.add_argument("service_type", metavar="TYPE", help="such as example_interfaces/srv/AddTwoInts")
    add_values_arguments(parser, "the request in YAML, such as '{a: 1, b: 2}'; fields left out have their defaults")
    parser.add_argument("-r", "--rate", metavar="N", type=positive_float, help="call again and again, at N hertz")
    parser.add_argument("--timeout", metavar="SECONDS", type=positive_float, help="give up waiting after so long")


def run(arguments: argparse.Namespace) -> int:
    """Print the request and the response, as ros2 does."""
    from linkwright.messages import get_service

    name = absolute(arguments.service_name)
    kind = get_service(arguments.service_type)
    text = read_values(arguments)
    request = kind.Request()
    fill(request, parse_values(text)[0], text)

    async def job(session: Session) -> int:
        client = session.node.create_client(kind, name)
        if not await is_ready(session, name, client, client.service_is_ready, _AT_ONCE):
            _check_type(session, name, kind.TYPE_NAME)
            print("waiting for service to become available...")
            if not await is_ready(session, name, client, client.service_is_ready, arguments.timeout):
                message = phrase("service '{name}' did not appear in {timeout} s", name=name, timeout=arguments.timeout)
                raise LinkwrightError(Diagnostic("CLI421", message))
        loop = asyncio.get_running_loop()
        while True:
            print(f"requester: making request: {request!r}\n")
            began = loop.time()
            response = await session.answer(client.call_async(request), arguments.timeout)
            if response is None:
                raise LinkwrightError(
                    Diagnostic(
                        "CLI422",
                        phrase("service '{name}' did not answer in {timeout} s", name=name, timeout=arguments.timeout),
                    )
                )
            print(f"response:\n{response!r}\n")
            if arguments.rate is None:
                return 0
            await asyncio.sleep(max(0.0, began + 1.0 / arguments.rate - loop.time()))

    return run_in_graph(arguments, job)


def _check_type(session: Session, name: str, asked: str) -> None:
    """A service that is there with another type will never be ready; say so instead of waiting."""
    from linkwright.graph.endpoints.info import EndpointKind

    servers = [each for each in session.graph.endpoints() if each.kind is EndpointKind.SERVICE and each.name == name]
    types = sorted({each.type_name for each in servers})
    if types and asked not in types:
        message = phrase(
            "service '{name}' is of type {types}, not {asked}", name=name, types=", ".join(types), asked=asked
        )
        raise LinkwrightError(Diagnostic("CLI428", message, hint=phrase("call it with {types}", types=types[0])))
