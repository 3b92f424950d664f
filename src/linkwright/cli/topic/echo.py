"""``linkwright topic echo``: print the messages of a topic."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING, Any

from linkwright.cli.echo_format import SEPARATOR, EchoFormat, add_format_arguments, parse_field_path, select_field
from linkwright.cli.lookup import find_message_class, make_absolute
from linkwright.cli.numbers import positive_float
from linkwright.cli.qos import add_subscription_qos_arguments, create_fitting_profile
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.topic.filters import compile_filter

if TYPE_CHECKING:
    from linkwright.cli.session import Session
    from linkwright.graph.endpoints.base import MessageInfo

_CLEAR_SEQUENCE = "\x1b[H\x1b[2J\x1b[3J"


def configure_echo(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``topic echo``."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", metavar="TOPIC", help="the topic, such as /chatter")
    parser.add_argument(
        "message_type",
        metavar="TYPE",
        nargs="?",
        help="the type, such as std_msgs/msg/String (default: the topic's type)",
    )
    add_format_arguments(parser, flow_help="print each message on one line")
    parser.add_argument(
        "--field", metavar="NAMES", help="print only this part of each message, such as pose.pose.position"
    )
    parser.add_argument(
        "--lost-messages",
        action="store_true",
        help="accepted for compatibility with ros2; lost messages are always reported",
    )
    parser.add_argument("--no-lost-messages", action="store_true", help="do not report lost messages")
    parser.add_argument("--raw", action="store_true", help="print the serialized bytes")
    parser.add_argument(
        "--filter", metavar="EXPR", help="print only messages 'm' that satisfy this expression, such as 'm.data > 3'"
    )
    parser.add_argument("--once", action="store_true", help="exit after the first message")
    parser.add_argument("--timeout", metavar="SECONDS", type=positive_float, help="exit after this time")
    parser.add_argument(
        "-i",
        "--include-message-info",
        action="store_true",
        help="print the metadata of each message, such as the time of sending",
    )
    parser.add_argument("--clear", action="store_true", help="clear the terminal before each message")
    add_subscription_qos_arguments(parser)


def run_echo(arguments: argparse.Namespace) -> int:
    """Print messages until the user interrupts the command."""
    name = make_absolute(arguments.topic_name)
    matches_filter = None if arguments.filter is None else compile_filter(arguments.filter)
    field = () if arguments.raw else parse_field_path(arguments.field)
    echo_format = EchoFormat.of(arguments, field, message_info=arguments.include_message_info)

    async def job(session: Session) -> int:
        from linkwright.graph.endpoints.event_types import SubscriptionEventCallbacks

        message_type = await find_message_class(session, name, arguments.message_type, raw=arguments.raw)
        if not arguments.raw:
            select_field(message_type(), echo_format.field)
        write = sys.stdout.write

        def show(message: Any, info: MessageInfo) -> None:
            if matches_filter is not None and not matches_filter(select_field(message, echo_format.field)):
                return
            text = echo_format.format_message(message, info)
            write(_CLEAR_SEQUENCE + text if arguments.clear else text)
            if arguments.once:
                session.finish()

        events = SubscriptionEventCallbacks(
            message_lost=None
            if arguments.no_lost_messages
            else session.guard(lambda event: write(format_lost_event(event)))
        )
        session.node.create_subscription(
            message_type,
            name,
            session.guard_receiver(show),
            create_fitting_profile(session.node, name, arguments),
            raw=arguments.raw,
            event_callbacks=events,
        )
        return await session.wait_until_finished(arguments.timeout) or 0

    return run_in_graph(arguments, job)


def format_lost_event(event: Any) -> str:
    """Return the text that reports lost messages, given an rclpy ``QoSMessageLostInfo``."""
    return (
        "A message was lost!!!\n"
        f"\ttotal count change:{event.total_count_change}\n"
        f"\ttotal count: {event.total_count}{SEPARATOR}"
    )
