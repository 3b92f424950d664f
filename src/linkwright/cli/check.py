"""``linkwright check``: read a description and print its tree, or what is wrong with it."""

from __future__ import annotations

import argparse
import sys

from linkwright.cli.assignments import parse_assignments
from linkwright.diagnostics import has_errors, print_diagnostics

NAME = "check"
HELP = "check a URDF or xacro file and print its link tree"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("file", metavar="FILE", help="the URDF or xacro file")
    parser.add_argument("values", metavar="NAME:=VALUE", nargs="*", help="values for the file's <xacro:arg>")


def run(arguments: argparse.Namespace) -> int:
    """Print the tree as check_urdf does, and every finding; 1 when one of them is an error."""
    from linkwright.urdf import examine, tree_text

    reading = examine(arguments.file, arguments=parse_assignments(arguments.values))
    print_diagnostics(reading.diagnostics, sys.stderr)
    if reading.robot is not None:
        sys.stdout.write(tree_text(reading.robot))
    return 1 if has_errors(reading.diagnostics) else 0
