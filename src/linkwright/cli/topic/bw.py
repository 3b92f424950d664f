"""``linkwright topic bw``."""

from __future__ import annotations

import argparse
import time
from typing import TYPE_CHECKING

from linkwright.cli.lookup import absolute, topic_type
from linkwright.cli.numbers import positive_int
from linkwright.cli.qos import add_qos_arguments, fitting_profile
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.topic.rates import BandwidthWindow

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "measure how many bytes a topic carries"

_WINDOW = 100
_PERIOD = 1.0


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", metavar="TOPIC", help="such as /camera/image_raw")
    parser.add_argument(
        "-w",
        "--window",
        metavar="N",
        type=positive_int,
        default=_WINDOW,
        help="over how many messages it is taken (default: %(default)s)",
    )
    add_qos_arguments(parser, "subscribe", "sensor_data", "; as the publishers have it, if they agree")


def run(arguments: argparse.Namespace) -> int:
    """Print the bandwidth each second until the user ends it. Messages are not read."""
    name = absolute(arguments.topic_name)

    async def job(session: Session) -> int:
        kind = await topic_type(session, name, wait=True)
        window = BandwidthWindow(arguments.window)

        def count(data: bytes) -> None:
            window.add(time.monotonic_ns(), len(data))

        session.node.create_subscription(
            kind, name, session.receiver(count), fitting_profile(session.node, name, arguments), raw=True
        )
        print(f"Subscribed to [{name}]")

        def report() -> None:
            text = window.text(time.monotonic_ns())
            if text is not None:
                print(text)

        session.every(_PERIOD, report)
        return await session.finished() or 0

    return run_in_graph(arguments, job)
