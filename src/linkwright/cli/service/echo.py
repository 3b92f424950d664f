"""``linkwright service echo``."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING, Any

from linkwright.cli.lookup import absolute
from linkwright.cli.numbers import unsigned_int
from linkwright.cli.qos import add_subscription_qos_arguments, fitting_profile
from linkwright.cli.service.arguments import add_service_arguments, types_of_service
from linkwright.cli.session import run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "print what clients ask of a service and what it answers, where they tell (service introspection)"

_TRUNCATE = 128


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_service_arguments(parser)
    parser.add_argument("service_type", metavar="TYPE", nargs="?", help="such as std_srvs/srv/SetBool; its own")
    parser.add_argument("--csv", action="store_true", help="print the values separated by commas")
    parser.add_argument("-f", "--full-length", action="store_true", help="do not cut long arrays and texts")
    parser.add_argument(
        "-l",
        "--truncate-length",
        metavar="N",
        type=unsigned_int,
        default=_TRUNCATE,
        help="cut arrays and texts after so many elements (default: %(default)s)",
    )
    parser.add_argument("--no-arr", action="store_true", help="do not print the elements of arrays")
    parser.add_argument("--no-str", action="store_true", help="do not print texts")
    parser.add_argument("--flow-style", action="store_true", help="print lists in brackets, on one line")
    add_subscription_qos_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print events until the user ends it, as ros2 does."""
    name = absolute(arguments.service_name)

    async def job(session: Session) -> int:
        from linkwright.graph.service_introspection import EVENT_TOPIC_SUFFIX
        from linkwright.messages import get_service

        kind = get_service(arguments.service_type or types_of_service(session, arguments)[0])
        topic = name + EVENT_TOPIC_SUFFIX
        if not session.node.get_publishers_info_by_topic(topic):
            print(
                f"nothing is told of '{name}' yet: its server and clients do so after configure_introspection()",
                file=sys.stderr,
            )

        def show(event: Any) -> None:
            sys.stdout.write(_text(event, arguments))

        profile = fitting_profile(session.node, topic, arguments)
        session.node.create_subscription(kind.Event, topic, session.receiver(show), profile)
        return await session.finished() or 0

    return run_in_graph(arguments, job)


def _text(event: Any, arguments: argparse.Namespace) -> str:
    """An event as ros2 prints it: the kind by its name, in YAML."""
    from linkwright.graph.service_introspection import EventType
    from linkwright.messages import to_csv, to_yaml

    length = None if arguments.full_length else arguments.truncate_length
    if arguments.csv:
        return to_csv(event, truncate_length=length, no_arr=arguments.no_arr, no_str=arguments.no_str) + "\n"
    text = to_yaml(
        event,
        truncate_length=length,
        no_arr=arguments.no_arr,
        no_str=arguments.no_str,
        flow_style=arguments.flow_style,
    )
    kind = event.info.event_type
    named = EventType(kind).name if kind in iter(EventType) else str(kind)
    return text.replace(f"event_type: {kind}\n", f"event_type: {named}\n", 1) + "---\n"
