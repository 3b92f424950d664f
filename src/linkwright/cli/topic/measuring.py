"""``linkwright topic hz``, ``bw`` and ``delay``: measure rate, bandwidth and delay."""

from __future__ import annotations

import argparse
import struct
import sys
import time
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from linkwright.cli.lookup import find_message_class, make_absolute
from linkwright.cli.numbers import positive_int
from linkwright.cli.qos import add_subscription_qos_arguments, create_fitting_profile
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.topic.filters import compile_filter
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from linkwright.cli.session import Session
    from linkwright.cli.topic.rates import RateWindow

_RATE_WINDOW_LENGTH = 10_000
_DELAY_WINDOW_LENGTH = 10_000
_STAMP_FORMATS = {0: struct.Struct(">iI"), 1: struct.Struct("<iI")}
"""The `struct` formats of a stamp, by the byte order in the second byte of the CDR header."""
_CDR_HEADER_LENGTH = 4
_SIZE_WINDOW_LENGTH = 100
_REPORT_PERIOD_S = 1.0


def configure_hz(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``topic hz``."""
    add_session_arguments(parser)
    parser.add_argument(
        "topic_name",
        metavar="TOPIC",
        nargs="+",
        help="the topics, such as /chatter; several topics are printed as a table",
    )
    _add_window_argument(parser, _RATE_WINDOW_LENGTH)
    parser.add_argument(
        "--filter", metavar="EXPR", help="count only messages 'm' that satisfy this expression, such as 'm.data > 3'"
    )
    parser.add_argument("--wall-time", action="store_true", help="use the computer's clock, not /clock")
    add_subscription_qos_arguments(parser)


def run_hz(arguments: argparse.Namespace) -> int:
    """Print the rate of a topic each second until the user interrupts the command.

    Messages are deserialized only if there is a filter.
    """
    names = list(dict.fromkeys(map(make_absolute, arguments.topic_name)))
    matches_filter = None if arguments.filter is None else compile_filter(arguments.filter)

    async def job(session: Session) -> int:
        from linkwright.cli.topic.rates import RateWindow, format_rate, format_rate_table

        windows = {name: RateWindow(arguments.window) for name in names}
        # Use the node's clock only with simulated time, because reading this clock takes longer than counting a
        # message.
        clock = session.node.get_clock()
        now_ns = clock.now_ns if arguments.use_sim_time and not arguments.wall_time else time.monotonic_ns

        def count(window: RateWindow, message: Any) -> None:
            if matches_filter is not None and not matches_filter(message):
                return
            if window.add(now_ns()):
                print("time has reset, resetting counters", file=sys.stderr)

        for name, window in windows.items():
            message_type = await find_message_class(session, name, wait=True, raw=matches_filter is None)
            _subscribe(session, arguments, message_type, name, partial(count, window), raw=matches_filter is None)
            if len(names) > 1:
                print(f"Subscribed to [{name}]")

        def format_report() -> str | None:
            spreads = {name: window.pop_spread() for name, window in windows.items()}
            measured_spreads = {name: spread for name, spread in spreads.items() if spread is not None}
            if len(names) > 1:
                return format_rate_table(measured_spreads) if measured_spreads else "no new messages"
            return format_rate(measured_spreads[names[0]]) if measured_spreads else None

        return await _report_until_finished(session, format_report)

    return run_in_graph(arguments, job)


def configure_delay(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``topic delay``."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", metavar="TOPIC", help="a topic whose messages have a header")
    _add_window_argument(parser, _DELAY_WINDOW_LENGTH)
    add_subscription_qos_arguments(parser)


def run_delay(arguments: argparse.Namespace) -> int:
    """Print the delay of a topic's messages each second until the user interrupts the command."""
    name = make_absolute(arguments.topic_name)

    async def job(session: Session) -> int:
        from linkwright.cli.topic.rates import DelayWindow

        message_type = await find_message_class(session, name, wait=True)
        fields = message_type.get_fields_and_field_types()
        if fields.get("header") != "std_msgs/Header":
            message = phrase(
                "msg does not have header: topic '{name}' carries {type_name}",
                name=name,
                type_name=message_type.TYPE_NAME,
            )
            hint = phrase("only messages with a std_msgs/Header have a time stamp")
            raise LinkwrightError(Diagnostic("CLI413", message, hint=hint))
        # If the header is the first field, its stamp can be read from the bytes without deserializing the rest.
        raw = next(iter(fields)) == "header"
        window = DelayWindow(arguments.window)
        clock = session.node.get_clock()

        def count(message: Any) -> None:
            if raw:
                seconds, nanoseconds = _STAMP_FORMATS[message[1] & 1].unpack_from(message, _CDR_HEADER_LENGTH)
            else:
                seconds, nanoseconds = message.header.stamp.sec, message.header.stamp.nanosec
            window.add(clock.now_ns(), seconds * NANOSECONDS_PER_SECOND + nanoseconds)

        _subscribe(session, arguments, message_type, name, count, raw=raw)
        return await _report_until_finished(session, window.format_report)

    return run_in_graph(arguments, job)


def configure_bw(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``topic bw``."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", metavar="TOPIC", help="the topic, such as /camera/image_raw")
    _add_window_argument(parser, _SIZE_WINDOW_LENGTH)
    add_subscription_qos_arguments(parser)


def run_bw(arguments: argparse.Namespace) -> int:
    """Print the bandwidth of a topic each second until the user interrupts the command.

    Messages are not deserialized.
    """
    name = make_absolute(arguments.topic_name)

    async def job(session: Session) -> int:
        from linkwright.cli.topic.rates import BandwidthWindow

        message_type = await find_message_class(session, name, wait=True, raw=True)
        window = BandwidthWindow(arguments.window)

        def count(data: bytes) -> None:
            window.add(time.monotonic_ns(), len(data))

        _subscribe(session, arguments, message_type, name, count, raw=True)
        print(f"Subscribed to [{name}]")
        return await _report_until_finished(session, lambda: window.format_report(time.monotonic_ns()))

    return run_in_graph(arguments, job)


def _add_window_argument(parser: argparse.ArgumentParser, default: int) -> None:
    """Declare the option ``--window``, the number of messages in the window."""
    parser.add_argument(
        "-w",
        "--window",
        metavar="N",
        type=positive_int,
        default=default,
        help="the number of messages to measure over (default: %(default)s)",
    )


def _subscribe(
    session: Session,
    arguments: argparse.Namespace,
    message_type: Any,
    name: str,
    callback: Callable[..., object],
    *,
    raw: bool,
) -> None:
    """Subscribe to a topic with the requested QoS, or else with the QoS of its publishers.

    Args:
        session: the session of the command.
        arguments: the parsed options of `add_subscription_qos_arguments`.
        message_type: the class of the messages.
        name: the absolute name of the topic.
        callback: receives each message, and its metadata if the callback has a second parameter; its exceptions end the
            command.
        raw: whether the callback receives serialized messages.
    """
    profile = create_fitting_profile(session.node, name, arguments)
    session.node.create_subscription(message_type, name, session.guard_receiver(callback), profile, raw=raw)


async def _report_until_finished(session: Session, format_report: Callable[[], str | None]) -> int:
    """Print the report each second, unless it is None, until the command ends.

    Returns:
        The exit status.
    """

    def report() -> None:
        line = format_report()
        if line is not None:
            print(line)

    session.call_every(_REPORT_PERIOD_S, report)
    return await session.wait_until_finished() or 0
