"""``linkwright topic delay``."""

from __future__ import annotations

import argparse
import struct
from typing import TYPE_CHECKING, Any

from linkwright.cli.lookup import absolute, topic_type
from linkwright.cli.qos import add_subscription_qos_arguments
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.topic.measuring import add_window_argument, report_until_finished, subscribe
from linkwright.cli.topic.rates import DelayWindow
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "measure how old messages are when they come, by the stamp in their header"

_WINDOW = 10_000
_STAMP = {0: struct.Struct(">iI"), 1: struct.Struct("<iI")}
"""Seconds and nanoseconds, by the second byte of the CDR header, which tells the order of bytes."""
_CDR_HEADER = 4
_SECOND = 1_000_000_000


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", metavar="TOPIC", help="a topic whose messages have a header")
    add_window_argument(parser, _WINDOW)
    add_subscription_qos_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the delay each second until the user ends it."""
    name = absolute(arguments.topic_name)

    async def job(session: Session) -> int:
        kind = await topic_type(session, name, wait=True)
        fields = kind.get_fields_and_field_types()
        if fields.get("header") != "std_msgs/Header":
            message = phrase(
                "msg does not have header: topic '{name}' carries {type_name}", name=name, type_name=kind.TYPE_NAME
            )
            hint = phrase("only messages with a std_msgs/Header say when they were made")
            raise LinkwrightError(Diagnostic("CLI413", message, hint=hint))
        # Where the header comes first its stamp is read from the bytes, and the rest is left alone.
        raw = next(iter(fields)) == "header"
        window = DelayWindow(arguments.window)
        clock = session.node.get_clock()

        def count(message: Any) -> None:
            if raw:
                seconds, nanoseconds = _STAMP[message[1] & 1].unpack_from(message, _CDR_HEADER)
            else:
                seconds, nanoseconds = message.header.stamp.sec, message.header.stamp.nanosec
            window.add(clock.now_ns(), seconds * _SECOND + nanoseconds)

        subscribe(session, arguments, kind, name, count, raw=raw)
        return await report_until_finished(session, window.text)

    return run_in_graph(arguments, job)
