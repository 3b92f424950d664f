"""``linkwright xacro``: expand a xacro file to URDF."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from linkwright.cli.assignments import parse_assignments
from linkwright.cli.output import write_output
from linkwright.diagnostics import print_diagnostics

NAME = "xacro"
HELP = "expand a xacro file to URDF"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("file", metavar="FILE", help="the xacro file, or - for standard input")
    parser.add_argument("values", metavar="NAME:=VALUE", nargs="*", help="values for the file's <xacro:arg>")
    parser.add_argument("-o", metavar="OUT", dest="output", help="write to this file instead of standard output")


def run(arguments: argparse.Namespace) -> int:
    """Expand; warnings go to standard error, the text to standard output or the file."""
    from linkwright.xacro import expand

    values = parse_assignments(arguments.values)
    if arguments.file == "-":
        expansion = expand("<stdin>", values, text=sys.stdin.read())
    else:
        expansion = expand(arguments.file, values)
    print_diagnostics(expansion.diagnostics, sys.stderr)
    if arguments.output:
        write_output(Path(arguments.output), str(expansion))
    else:
        sys.stdout.write(str(expansion))
    return 0
