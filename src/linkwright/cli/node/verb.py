"""The verb ``node`` and the verbs below it."""

from __future__ import annotations

import argparse

from linkwright.cli.nested import configure_nested, run_nested

NAME = "node"
HELP = "list and describe nodes"

_MODULES = {"info": "info", "list": "listing"}
VERBS = tuple(_MODULES)


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    configure_nested(parser, __package__, _MODULES)


def run(arguments: argparse.Namespace) -> int:
    """Run the verb that was named."""
    return run_nested(arguments)
