"""``linkwright interface proto``."""

from __future__ import annotations

import argparse

HELP = "print a message with its defaults, to be filled in and published"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("type", metavar="TYPE", help="such as std_msgs/msg/String")
    parser.add_argument("--no-quotes", action="store_true", help="leave the quotes around it out")


def run(arguments: argparse.Namespace) -> int:
    """Print it: of a service the request, of an action the goal, as ros2 does."""
    from linkwright.messages import prototype

    text = prototype(arguments.type)
    print(text if arguments.no_quotes else f'"{text}"')
    return 0
