"""``linkwright interface list``."""

from __future__ import annotations

import argparse

from linkwright.cli.interface.kinds import add_kind_arguments, kinds

HELP = "list the types there are"

_TITLES = {"msg": "Messages:", "srv": "Services:", "action": "Actions:"}


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_kind_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print their names, by kind, as ros2 does."""
    from linkwright.messages import interface_names

    for kind in kinds(arguments):
        print(_TITLES[kind])
        for name in interface_names(kind):
            print(f"    {name}")
    return 0
