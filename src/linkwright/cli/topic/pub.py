"""``linkwright topic pub``: publish messages on a topic."""

from __future__ import annotations

import argparse
import asyncio
import sys
from collections.abc import Callable
from itertools import cycle
from typing import TYPE_CHECKING, Any

from linkwright.cli.lookup import make_absolute
from linkwright.cli.numbers import positive_float, unsigned_int
from linkwright.cli.qos import add_publisher_qos_arguments, create_profile
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.values import add_values_arguments, fill_message, parse_values, read_values

if TYPE_CHECKING:
    from linkwright.cli.session import Session
    from linkwright.graph import Publisher

_KEEP_ALIVE_S = 0.1
_WAITING_NOTICE_PERIOD_S = 1.0
_MUTUAL_DISCOVERY_DELAY_S = 0.15
"""Seconds until a discovered subscription has also discovered the publisher.

Earlier messages may be lost.
"""
_MessageWithStamps = tuple[Any, list[Callable[[Any], None]]]


def configure_pub(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``topic pub``."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", metavar="TOPIC", help="the topic, such as /chatter")
    parser.add_argument("message_type", metavar="TYPE", help="the type, such as std_msgs/msg/String")
    values = add_values_arguments(
        parser,
        values_help="the message in YAML, such as 'data: hello'; omitted fields keep their defaults, and "
        "'header: auto' and 'stamp: now' insert the time of publishing",
    )
    values.add_argument("--yaml-file", metavar="FILE", help="publish the messages of a file, as topic echo prints them")
    parser.add_argument(
        "-r", "--rate", metavar="N", type=positive_float, default=1.0, help="the rate in hertz, default 1"
    )
    parser.add_argument(
        "-p", "--print", metavar="N", type=unsigned_int, default=1, help="print only every N-th message (default: 1)"
    )
    times = parser.add_mutually_exclusive_group()
    times.add_argument("-1", "--once", action="store_true", help="publish one message and exit")
    times.add_argument("-t", "--times", metavar="N", type=unsigned_int, default=0, help="publish N messages and exit")
    parser.add_argument(
        "-w",
        "--wait-matching-subscriptions",
        metavar="N",
        type=unsigned_int,
        help="wait for this many subscriptions before publishing (default: 1 with --once and --times, else 0)",
    )
    parser.add_argument(
        "--max-wait-time-secs",
        metavar="SECONDS",
        type=positive_float,
        help="the maximum time to wait for subscriptions",
    )
    parser.add_argument(
        "--keep-alive",
        metavar="SECONDS",
        type=float,
        default=_KEEP_ALIVE_S,
        help="the time to keep running after the last message (default: %(default)s)",
    )
    parser.add_argument("-n", "--node-name", metavar="NODE", help="the name of the publishing node")
    add_publisher_qos_arguments(parser)


def run_pub(arguments: argparse.Namespace) -> int:
    """Publish messages the requested number of times, or until the user interrupts the command."""
    from linkwright.messages import get_message

    name = make_absolute(arguments.topic_name)
    message_class = get_message(arguments.message_type)
    text = read_values(arguments)
    messages: list[_MessageWithStamps] = []
    for values in parse_values(text):
        message = message_class()
        messages.append((message, fill_message(message, values, text)))
    times = 1 if arguments.once else arguments.times
    if arguments.yaml_file is not None and not times:
        times = len(messages)

    async def job(session: Session) -> int:
        publisher = session.node.create_publisher(message_class, name, create_profile(arguments))
        required_count = arguments.wait_matching_subscriptions
        if required_count is None:
            required_count = 1 if arguments.once or arguments.times else 0
        if not await _wait_for_subscriptions(session, publisher, required_count, arguments.max_wait_time_secs):
            print(f"Timed out waiting for {required_count} matching subscription(s)", file=sys.stderr)
            return 1
        if required_count:
            await asyncio.sleep(_MUTUAL_DISCOVERY_DELAY_S)
        print("publisher: beginning loop")
        await _publish(session, publisher, messages, times, arguments)
        await asyncio.sleep(arguments.keep_alive)
        return 0

    return run_in_graph(arguments, job, node_name=arguments.node_name)


async def _wait_for_subscriptions(
    session: Session, publisher: Publisher[Any], required_count: int, timeout: float | None
) -> bool:
    """Wait for `required_count` subscriptions, and print a line each second.

    Returns:
        Whether the subscriptions matched within `timeout` seconds; a `timeout` of None means no limit.
    """
    waited_seconds = 0.0
    while publisher.get_subscription_count() < required_count:
        if timeout is not None and waited_seconds >= timeout:
            return False
        print(f"Waiting for at least {required_count} matching subscription(s)...")
        step = _WAITING_NOTICE_PERIOD_S if timeout is None else min(_WAITING_NOTICE_PERIOD_S, timeout - waited_seconds)
        await session.wait_until(lambda: publisher.get_subscription_count() >= required_count, step)
        waited_seconds += step
    return True


async def _publish(
    session: Session,
    publisher: Publisher[Any],
    messages_with_stamps: list[_MessageWithStamps],
    times: int,
    arguments: argparse.Namespace,
) -> None:
    clock = session.node.get_clock()
    messages = cycle(messages_with_stamps)
    count = 0

    def publish() -> None:
        nonlocal count
        message, stamp_setters = next(messages)
        if stamp_setters:
            stamp = clock.now().to_msg()
            for set_stamp in stamp_setters:
                set_stamp(stamp)
        count += 1
        if arguments.print and count % arguments.print == 0:
            print(f"publishing #{count}: {message!r}\n")
        publisher.publish(message)
        if count == times:
            session.finish()

    publish()
    if count != times:
        timer = session.node.create_timer(1.0 / arguments.rate, session.guard(publish))
        await session.wait_until_finished()
        session.node.destroy_timer(timer)
