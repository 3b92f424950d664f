"""``linkwright topic hz``."""

from __future__ import annotations

import argparse
import sys
import time
from functools import partial
from typing import TYPE_CHECKING, Any

from linkwright.cli.lookup import absolute, topic_type
from linkwright.cli.qos import add_subscription_qos_arguments
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.cli.topic.filters import compile_filter
from linkwright.cli.topic.measuring import add_window_argument, report_until_finished, subscribe
from linkwright.cli.topic.rates import RateWindow, rate_table, rate_text

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "measure how often messages are received"

_WINDOW = 10_000


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", metavar="TOPIC", nargs="+", help="such as /chatter; several give a table")
    add_window_argument(parser, _WINDOW)
    parser.add_argument("--filter", metavar="EXPR", help="count only messages 'm' for which this holds: 'm.data > 3'")
    parser.add_argument("--wall-time", action="store_true", help="go by the computer's clock, not by /clock")
    add_subscription_qos_arguments(parser)


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
            kind = await topic_type(session, name, wait=True, raw=fits is None)
            subscribe(session, arguments, kind, name, partial(count, window), raw=fits is None)
            if len(names) > 1:
                print(f"Subscribed to [{name}]")

        def text() -> str | None:
            spreads = {name: window.spread() for name, window in windows.items()}
            known = {name: spread for name, spread in spreads.items() if spread is not None}
            if len(names) > 1:
                return rate_table(known) if known else "no new messages"
            return rate_text(known[names[0]]) if known else None

        return await report_until_finished(session, text)

    return run_in_graph(arguments, job)
