"""``linkwright daemon``: does nothing, for scripts that start and stop ros2's daemon.

Linkwright does not have a daemon.
"""

from __future__ import annotations

import argparse

_RESPONSES = {
    "start": "The daemon is not needed: each command finds the nodes itself",
    "status": "The daemon is not running",
    "stop": "The daemon is not running",
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``daemon``."""
    parser.add_argument(
        "verb",
        metavar="{start,status,stop}",
        choices=_RESPONSES,
        help="accepted for compatibility with ros2; has no effect",
    )


def run(arguments: argparse.Namespace) -> int:
    """Report that there is no daemon."""
    print(_RESPONSES[arguments.verb])
    return 0
