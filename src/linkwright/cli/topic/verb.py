"""The command ``topic`` and its subcommands."""

from __future__ import annotations

import argparse

from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.topic import echo, measuring, names, pub

VERBS = {
    "bw": SubVerb(measuring.configure_bw, measuring.run_bw, help="measure the bandwidth of a topic"),
    "delay": SubVerb(
        measuring.configure_delay,
        measuring.run_delay,
        help="measure the delay of messages, from the stamp in their header",
    ),
    "echo": SubVerb(echo.configure_echo, echo.run_echo, help="print the messages of a topic"),
    "find": SubVerb(names.configure_find, names.run_find, help="list the topics of a type"),
    "hz": SubVerb(measuring.configure_hz, measuring.run_hz, help="measure the rate of messages"),
    "info": SubVerb(
        names.configure_info,
        names.run_info,
        help="print the type of a topic and the numbers of its publishers and subscriptions",
    ),
    "list": SubVerb(names.configure_list, names.run_list, help="list the topics"),
    "pub": SubVerb(pub.configure_pub, pub.run_pub, help="publish messages to a topic"),
    "type": SubVerb(names.configure_type, names.run_type, help="print the type of a topic"),
}
run = run_nested


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the subcommands of ``topic``."""
    parser.add_argument("--include-hidden-topics", action="store_true", help="consider hidden topics as well")
    configure_nested(parser, VERBS)
