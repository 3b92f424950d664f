"""``linkwright interface packages``."""

from __future__ import annotations

import argparse

from linkwright.cli.interface.kinds import add_kind_arguments, kinds

HELP = "list the packages that have types"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_kind_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print their names, a line each."""
    from linkwright.messages import interface_names

    for package in sorted({name.split("/")[0] for kind in kinds(arguments) for name in interface_names(kind)}):
        print(package)
    return 0
