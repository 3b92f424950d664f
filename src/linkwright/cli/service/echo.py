"""``linkwright service echo``."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING, Any

from linkwright.cli.lookup import absolute
from linkwright.cli.qos import add_subscription_qos_arguments, fitting_profile
from linkwright.cli.service.arguments import add_service_arguments, types_of_service
from linkwright.cli.session import run_in_graph
from linkwright.cli.topic.echo_output import EchoFormat, add_format_arguments

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "print what clients ask of a service and what it answers, where they tell (service introspection)"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_service_arguments(parser)
    parser.add_argument("service_type", metavar="TYPE", nargs="?", help="such as std_srvs/srv/SetBool; its own")
    add_format_arguments(parser, "print lists in brackets, on one line")
    add_subscription_qos_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print events until the user ends it, as ros2 does."""
    name = absolute(arguments.service_name)
    form = EchoFormat.of(arguments)

    async def job(session: Session) -> int:
        from linkwright.graph.endpoints.service_introspection import EVENT_TOPIC_SUFFIX
        from linkwright.messages import get_service

        kind = get_service(arguments.service_type or types_of_service(session, arguments)[0])
        topic = name + EVENT_TOPIC_SUFFIX
        if not session.node.get_publishers_info_by_topic(topic):
            print(
                f"nothing is told of '{name}' yet: its server and clients do so after configure_introspection()",
                file=sys.stderr,
            )

        def show(event: Any) -> None:
            sys.stdout.write(_text(event, form))

        profile = fitting_profile(session.node, topic, arguments)
        session.node.create_subscription(kind.Event, topic, session.receiver(show), profile)
        return await session.finished() or 0

    return run_in_graph(arguments, job)


def _text(event: Any, form: EchoFormat) -> str:
    """An event as ros2 prints it: in YAML the kind by its name."""
    from linkwright.graph.endpoints.service_introspection import EventType

    kind = event.info.event_type
    named = EventType(kind).name if kind in iter(EventType) else str(kind)
    return form.text(event).replace(f"event_type: {kind}\n", f"event_type: {named}\n", 1)
