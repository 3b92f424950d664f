"""``linkwright daemon``: does nothing, for scripts that start and stop ros2's daemon.

Linkwright does not have a daemon.
"""

from __future__ import annotations

import argparse

_ANSWERS = {
    "start": "The daemon is not needed: each command finds the nodes itself",
    "status": "The daemon is not running",
    "stop": "The daemon is not running",
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``daemon``."""
    parser.add_argument(
        "verb",
        metavar="{start,status,stop}",
        choices=_ANSWERS,
        help="accepted for compatibility with ros2; has no effect",
    )


def run(arguments: argparse.Namespace) -> int:
    """Report that there is no daemon."""
    print(_ANSWERS[arguments.verb])
    return 0
