"""``linkwright doctor hello``: test connections over a topic and by multicast."""

from __future__ import annotations

import argparse
import asyncio
import socket
import sys
from typing import TYPE_CHECKING, Any

from linkwright.cli.multicast import add_ttl_argument
from linkwright.cli.numbers import positive_float
from linkwright.cli.session import run_in_graph
from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized

if TYPE_CHECKING:
    from linkwright.cli.session import Session
    from linkwright.doctor.hello import Greetings


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``doctor hello``."""
    parser.add_argument(
        "-t", "--topic", default="/canyouhearme", help="the topic to publish greetings on (default: %(default)s)"
    )
    parser.add_argument(
        "-ep",
        "--emit-period",
        metavar="SECONDS",
        type=positive_float,
        default=0.1,
        help="time between greetings (default: %(default)s)",
    )
    parser.add_argument(
        "-pp",
        "--print-period",
        metavar="SECONDS",
        type=positive_float,
        default=1.0,
        help="time between tables (default: %(default)s)",
    )
    add_ttl_argument(parser)
    parser.add_argument("-1", "--once", action="store_true", help="send one greeting, print one table and exit")


def run(arguments: argparse.Namespace) -> int:
    """Send greetings and print the senders of received greetings until interrupted."""
    return run_in_graph(arguments, lambda session: _greet(session, arguments))


async def _greet(session: Session, arguments: argparse.Namespace) -> int:
    from linkwright.doctor.hello import Greetings, make_greeting
    from linkwright.messages import String
    from linkwright.wire import multicast

    host = socket.gethostname()
    counts = Greetings(host)
    _warn_if_local_only()
    publisher = session.node.create_publisher(String, arguments.topic, 10)
    session.node.create_subscription(
        String, arguments.topic, session.guard_receiver(lambda message: counts.count_topic_greeting(message.data)), 10
    )
    with multicast.open_receiver() as receiver, multicast.open_sender(arguments.ttl) as sender:
        transport, _ = await session.loop.create_datagram_endpoint(lambda: _Listener(counts), sock=receiver)

        def send_greetings() -> None:
            publisher.publish(String(data=make_greeting(host)))
            counts.published_count += 1
            multicast.send(sender, make_greeting(host).encode())
            counts.sent_count += 1

        def print_table() -> None:
            print(counts.pop_table(arguments.topic, arguments.print_period))

        try:
            send_greetings()
            if arguments.once:
                await session.wait_until_finished(arguments.emit_period)
                print_table()
                return 0
            session.call_every(arguments.emit_period, send_greetings)
            session.call_every(arguments.print_period, print_table)
            return await session.wait_until_finished() or 0
        finally:
            transport.close()


class _Listener(asyncio.DatagramProtocol):
    """Counts the greetings received by multicast."""

    def __init__(self, counts: Greetings) -> None:
        self._counts = counts

    def datagram_received(self, data: bytes, _sender: Any) -> None:
        self._counts.count_multicast_greeting(data.decode(errors="replace"))


def _warn_if_local_only() -> None:
    """Print a warning if the topic stays on this computer, as it does by default."""
    from linkwright.wire.dds.settings import Range, read_settings
    from linkwright.wire.joining import select_middleware
    from linkwright.wire.unsupported_settings import CYCLONE

    if select_middleware() == CYCLONE and read_settings().range in (Range.MACHINE, Range.LOCALHOST, Range.OFF):
        text = phrase(
            "the topic is only visible on this computer: set ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET "
            "on each computer to reach others"
        )
        print(localized(text), file=sys.stderr)
