"""The verb ``service`` and the verbs below it."""

from __future__ import annotations

import argparse

from linkwright.cli.nested import configure_nested, run_nested

NAME = "service"
HELP = "list and call services"

_MODULES = {
    "call": "call",
    "find": "find",
    "info": "info",
    "list": "listing",
    "type": "type_of",
}
VERBS = tuple(_MODULES)


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("--include-hidden-services", action="store_true", help="consider hidden services as well")
    configure_nested(parser, __package__, _MODULES)


def run(arguments: argparse.Namespace) -> int:
    """Run the verb that was named."""
    return run_nested(arguments)
