"""``linkwright topic hz``."""

from __future__ import annotations

import argparse
import sys
import time
from functools import partial
from typing import TYPE_CHECKING, Any

from linkwright.cli.lookup import absolute, topic_type
from linkwright.cli.numbers import positive_int
from linkwright.cli.qos import add_qos_arguments, fitting_profile
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.topic.filters import compile_filter
from linkwright.cli.topic.rates import RateWindow, rate_table, rate_text

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "measure how often messages are received"

_WINDOW = 10_000
_PERIOD = 1.0


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", metavar="TOPIC", nargs="+", help="such as /chatter; several give a table")
    parser.add_argument(
        "-w",
        "--window",
        metavar="N",
        dest="window",
        type=positive_int,
        default=_WINDOW,
        help="over how many messages the rate is taken (default: %(default)s)",
    )
    parser.add_argument("--filter", metavar="EXPR", help="count only messages 'm' for which this holds: 'm.data > 3'")
    parser.add_argument("--wall-time", action="store_true", help="go by the computer's clock, not by /clock")
    add_qos_arguments(parser, "subscribe", "sensor_data", "; as the publishers have it, if they agree")


def run(arguments: argparse.Namespace) -> int:
    """Print the rate each second until the user ends it. Messages are not read, unless for the filter."""
    names = list(dict.fromkeys(map(absolute, arguments.topic_name)))
    fits = None if arguments.filter is None else compile_filter(arguments.filter)

    async def job(session: Session) -> int:
        windows = {name: RateWindow(arguments.window) for name in names}
        # A node's clock is asked only where it may differ from the computer's: asking it costs more than counting.
        clock = session.node.get_clock()
        now_ns = clock.now_ns if arguments.use_sim_time and not arguments.wall_time else time.monotonic_ns

        def count(window: RateWindow, message: Any) -> None:
            if fits is not None and not fits(message):
                return
            if window.add(now_ns()):
                print("time has reset, resetting counters", file=sys.stderr)

        for name, window in windows.items():
            kind = await topic_type(session, name, wait=True)
            session.node.create_subscription(
                kind,
                name,
                session.receiver(partial(count, window)),
                fitting_profile(session.node, name, arguments),
                raw=fits is None,
            )
            if len(names) > 1:
                print(f"Subscribed to [{name}]")

        def report() -> None:
            spreads = {name: window.spread() for name, window in windows.items()}
            known = {name: spread for name, spread in spreads.items() if spread is not None}
            if len(names) > 1:
                print(rate_table(known) if known else "no new messages")
            elif known:
                print(rate_text(known[names[0]]))

        session.every(_PERIOD, report)
        return await session.finished() or 0

    return run_in_graph(arguments, job)
