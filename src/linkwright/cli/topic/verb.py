"""The verb ``topic`` and the verbs below it."""

from __future__ import annotations

import argparse

from linkwright.cli.nested import configure_nested, run_nested

HELP = "list, print, publish and measure topics"
VERBS = {
    "bw": "bw",
    "delay": "delay",
    "echo": "echo",
    "find": "find",
    "hz": "hz",
    "info": "info",
    "list": "listing",
    "pub": "pub",
    "type": "type_of",
}
run = run_nested


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("--include-hidden-topics", action="store_true", help="consider hidden topics as well")
    configure_nested(parser, __package__, VERBS)
