"""``linkwright service``: list and call the services of the running graph."""

from __future__ import annotations

import argparse
import asyncio
import sys
from typing import TYPE_CHECKING, Any

from linkwright.cli.echo_format import EchoFormat, add_format_arguments
from linkwright.cli.lookup import make_absolute, sort_visible_names
from linkwright.cli.names_listing import (
    Kind,
    add_count_argument,
    add_hidden_argument,
    add_types_argument,
    print_names_and_types,
)
from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.numbers import positive_float
from linkwright.cli.qos import add_subscription_qos_arguments, create_fitting_profile
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.values import add_values_arguments, fill_message, parse_values, read_values
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session


_QUIET_WAIT_S = 0.2
"""Seconds to wait for a service before the command prints that it is waiting."""


def add_service_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments for the service and for including hidden services."""
    add_session_arguments(parser)
    parser.add_argument("service_name", metavar="SERVICE", help="the service, such as /add_two_ints")
    add_hidden_argument(parser, "--include-hidden-services", hidden_help="consider hidden services as well")


_SERVICES = Kind(
    lambda session: session.node.get_service_names_and_types(),
    "CLI427",
    lambda service_name: phrase("Unknown service '{service_name}'", service_name=service_name),
    phrase("run `linkwright service list` to list the services"),
)


def configure_list(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``service list``."""
    add_session_arguments(parser)
    add_types_argument(parser, types_help="also print the type of each service")
    add_count_argument(parser, "service")
    add_hidden_argument(parser, "--include-hidden-services", hidden_help="consider hidden services as well")


def run_list(arguments: argparse.Namespace) -> int:
    """Print the names of services, as ros2 does."""

    async def job(session: Session) -> int:
        services = sort_visible_names(
            session.node.get_service_names_and_types(), hidden=arguments.include_hidden_services
        )
        print_names_and_types(services, arguments)
        return 0

    return run_in_graph(arguments, job, read_only=True)


def configure_find(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``service find``."""
    add_session_arguments(parser)
    parser.add_argument("service_type", metavar="TYPE", help="the type, such as std_srvs/srv/SetBool")
    add_count_argument(parser, "service")
    add_hidden_argument(parser, "--include-hidden-services", hidden_help="consider hidden services as well")


def run_find(arguments: argparse.Namespace) -> int:
    """Print the names of the services of a type."""
    return _SERVICES.print_of_type(arguments, arguments.service_type, hidden=arguments.include_hidden_services)


def configure_info(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``service info``."""
    add_service_arguments(parser)


def run_info(arguments: argparse.Namespace) -> int:
    """Print information about a service, as ros2 does."""
    name = make_absolute(arguments.service_name)

    async def job(session: Session) -> int:
        types = _SERVICES.find_types(session, arguments.service_name)
        print(f"Type: {types[0] if len(types) == 1 else types}")
        print(f"Clients count: {session.node.count_clients(name)}")
        print(f"Services count: {session.node.count_services(name)}")
        return 0

    return run_in_graph(arguments, job, read_only=True)


def configure_type(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``service type``."""
    add_service_arguments(parser)


def run_type(arguments: argparse.Namespace) -> int:
    """Print the types of a service, one per line."""
    return _SERVICES.print_types(arguments, arguments.service_name)


def configure_call(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``service call``."""
    add_session_arguments(parser)
    parser.add_argument("service_name", metavar="SERVICE", help="the service, such as /add_two_ints")
    parser.add_argument(
        "service_type", metavar="TYPE", help="the service's type, such as example_interfaces/srv/AddTwoInts"
    )
    add_values_arguments(
        parser, values_help="the request in YAML, such as '{a: 1, b: 2}'; omitted fields keep their defaults"
    )
    parser.add_argument(
        "-r", "--rate", metavar="N", type=positive_float, help="call the service repeatedly, at N hertz"
    )
    parser.add_argument("--timeout", metavar="SECONDS", type=positive_float, help="stop waiting after this time")


def run_call(arguments: argparse.Namespace) -> int:
    """Call a service, and print the request and the response as ros2 does."""
    from linkwright.messages import get_service

    name = make_absolute(arguments.service_name)
    service_class = get_service(arguments.service_type)
    text = read_values(arguments)
    request = service_class.Request()
    fill_message(request, parse_values(text)[0], text)

    async def job(session: Session) -> int:
        client = session.node.create_client(service_class, name)
        if not await session.wait_until(client.service_is_ready, _QUIET_WAIT_S):
            _check_type(session, name, service_class.TYPE_NAME)
            print("waiting for service to become available...")
            if not await session.wait_until(client.service_is_ready, arguments.timeout):
                message = phrase(
                    "service '{name}' did not appear within {timeout} s", name=name, timeout=arguments.timeout
                )
                raise LinkwrightError(Diagnostic("CLI421", message))
        loop = asyncio.get_running_loop()
        while True:
            print(f"requester: making request: {request!r}\n")
            start_time = loop.time()
            response = await session.wait_for_result(client.call_async(request), arguments.timeout)
            if response is None:
                raise LinkwrightError(
                    Diagnostic(
                        "CLI422",
                        phrase(
                            "service '{name}' did not respond within {timeout} s", name=name, timeout=arguments.timeout
                        ),
                    )
                )
            print(f"response:\n{response!r}\n")
            if arguments.rate is None:
                return 0
            await asyncio.sleep(max(0.0, start_time + 1.0 / arguments.rate - loop.time()))

    return run_in_graph(arguments, job)


def _check_type(session: Session, name: str, requested_type: str) -> None:
    """Check that an existing service has the type that the user gave.

    Without this check, the command would wait for a service that never appears.

    Raises:
        LinkwrightError: CLI428, the service has another type.
    """
    from linkwright.graph.endpoints.base import EndpointKind

    servers = [
        endpoint
        for endpoint in session.graph.endpoints()
        if endpoint.kind is EndpointKind.SERVICE and endpoint.name == name
    ]
    types = sorted({server.type_name for server in servers})
    if types and requested_type not in types:
        message = phrase(
            "service '{name}' is of type {types}, not {requested_type}",
            name=name,
            types=", ".join(types),
            requested_type=requested_type,
        )
        raise LinkwrightError(
            Diagnostic("CLI428", message, hint=phrase("call the service with the type {types}", types=types[0]))
        )


def configure_echo(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``service echo``."""
    add_service_arguments(parser)
    parser.add_argument(
        "service_type",
        metavar="TYPE",
        nargs="?",
        help="the type, such as std_srvs/srv/SetBool (default: the service's type)",
    )
    add_format_arguments(parser, flow_help="print lists in brackets, on one line")
    add_subscription_qos_arguments(parser)


def run_echo(arguments: argparse.Namespace) -> int:
    """Print service events until the user interrupts the command, as ros2 does."""
    name = make_absolute(arguments.service_name)
    echo_format = EchoFormat.of(arguments)

    async def job(session: Session) -> int:
        from linkwright.graph.endpoints.service import EVENT_TOPIC_SUFFIX
        from linkwright.messages import get_service

        service_class = get_service(arguments.service_type or _SERVICES.find_types(session, arguments.service_name)[0])
        topic = name + EVENT_TOPIC_SUFFIX
        if not session.node.get_publishers_info_by_topic(topic):
            print(
                f"service '{name}' has no events yet: servers and clients publish them after configure_introspection()",
                file=sys.stderr,
            )

        def show(event: Any) -> None:
            sys.stdout.write(_format_event(event, echo_format))

        profile = create_fitting_profile(session.node, topic, arguments)
        session.node.create_subscription(service_class.Event, topic, session.guard_receiver(show), profile)
        return await session.wait_until_finished() or 0

    return run_in_graph(arguments, job)


def _format_event(event: Any, echo_format: EchoFormat) -> str:
    """Format a service event as YAML with the name of the event's type, as ros2 does."""
    from linkwright.graph.endpoints.service import EventType

    event_type = event.info.event_type
    event_name = EventType(event_type).name if event_type in iter(EventType) else str(event_type)
    return echo_format.format_message(event).replace(f"event_type: {event_type}\n", f"event_type: {event_name}\n", 1)


VERBS = {
    "call": SubVerb(configure_call, run_call, help="call a service"),
    "echo": SubVerb(
        configure_echo,
        run_echo,
        help="print the requests and responses of a service, if service introspection is enabled",
    ),
    "find": SubVerb(configure_find, run_find, help="list the services of a type"),
    "info": SubVerb(
        configure_info, run_info, help="print the type of a service and the numbers of its clients and servers"
    ),
    "list": SubVerb(configure_list, run_list, help="list the services"),
    "type": SubVerb(configure_type, run_type, help="print the type of a service"),
}
run = run_nested


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the subcommands of ``service``."""
    parser.add_argument("--include-hidden-services", action="store_true", help="consider hidden services as well")
    configure_nested(parser, VERBS)
