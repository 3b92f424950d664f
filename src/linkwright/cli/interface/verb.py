"""The verb ``interface`` and the verbs below it."""

from __future__ import annotations

import argparse

from linkwright.cli.nested import configure_nested, run_nested

NAME = "interface"
HELP = "list and show types of messages, services and actions"

_MODULES = {
    "list": "listing",
    "package": "package",
    "packages": "packages",
    "proto": "proto",
    "show": "show",
}
VERBS = tuple(_MODULES)


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    configure_nested(parser, __package__, _MODULES)


def run(arguments: argparse.Namespace) -> int:
    """Run the verb that was named."""
    return run_nested(arguments)
