"""``linkwright bag``: record topics, play recordings, tell what is in them."""

from __future__ import annotations

import argparse

from linkwright.cli.nested import configure_nested, run_nested

NAME = "bag"
HELP = "record topics, play recordings and tell what is in them"
VERBS = {"info": "info", "play": "play", "record": "record"}


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the commands."""
    configure_nested(parser, __name__, VERBS)


def run(arguments: argparse.Namespace) -> int:
    """Run the command that was named."""
    return run_nested(arguments)
