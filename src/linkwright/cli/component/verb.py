"""The verb ``component`` and the verbs below it."""

from __future__ import annotations

import argparse

from linkwright.cli.nested import configure_nested, run_nested

NAME = "component"
HELP = "load nodes into containers, list and unload them"

_MODULES = {
    "list": "listing",
    "load": "load",
    "standalone": "standalone",
    "types": "types",
    "unload": "unload",
}
VERBS = tuple(_MODULES)


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    configure_nested(parser, __package__, _MODULES)


def run(arguments: argparse.Namespace) -> int:
    """Run the verb that was named."""
    return run_nested(arguments)
