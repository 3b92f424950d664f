"""The verb ``lifecycle`` and the verbs below it."""

from __future__ import annotations

import argparse

from linkwright.cli.nested import configure_nested, run_nested

NAME = "lifecycle"
HELP = "look at and change the states of managed nodes"

_MODULES = {"get": "get", "list": "listing", "nodes": "nodes", "set": "set"}
VERBS = tuple(_MODULES)


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    configure_nested(parser, __package__, _MODULES)


def run(arguments: argparse.Namespace) -> int:
    """Run the verb that was named."""
    return run_nested(arguments)
