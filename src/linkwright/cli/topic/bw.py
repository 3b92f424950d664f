"""``linkwright topic bw``."""

from __future__ import annotations

import argparse
import time
from typing import TYPE_CHECKING

from linkwright.cli.lookup import absolute, topic_type
from linkwright.cli.qos import add_subscription_qos_arguments
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.topic.measuring import add_window_argument, report_until_finished, subscribe
from linkwright.cli.topic.rates import BandwidthWindow

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "measure how many bytes a topic carries"

_WINDOW = 100


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", metavar="TOPIC", help="such as /camera/image_raw")
    add_window_argument(parser, _WINDOW)
    add_subscription_qos_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the bandwidth each second until the user ends it. Messages are not read."""
    name = absolute(arguments.topic_name)

    async def job(session: Session) -> int:
        kind = await topic_type(session, name, wait=True, raw=True)
        window = BandwidthWindow(arguments.window)

        def count(data: bytes) -> None:
            window.add(time.monotonic_ns(), len(data))

        subscribe(session, arguments, kind, name, count, raw=True)
        print(f"Subscribed to [{name}]")
        return await report_until_finished(session, lambda: window.text(time.monotonic_ns()))

    return run_in_graph(arguments, job)
