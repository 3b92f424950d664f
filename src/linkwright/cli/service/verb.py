"""The verb ``service`` and the verbs below it."""

from __future__ import annotations

import argparse

from linkwright.cli.nested import configure_nested, run_nested

HELP = "list and call services"
VERBS = {
    "call": "call",
    "echo": "echo",
    "find": "find",
    "info": "info",
    "list": "listing",
    "type": "type_of",
}
run = run_nested


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("--include-hidden-services", action="store_true", help="consider hidden services as well")
    configure_nested(parser, __package__, VERBS)
