"""``linkwright diff``: compare two descriptions, or a description with a commit."""

from __future__ import annotations

import argparse
import json
import sys
from contextlib import ExitStack

from linkwright.cli.model_arguments import add_against, add_values, open_requested_pair
from linkwright.diagnostics import LinkwrightError, print_diagnostics

SAME, DIFFERENT, FAILURE = 0, 1, 2
"""The exit statuses of ``diff``."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``diff``."""
    parser.add_argument("file", metavar="OLD", help="the URDF or xacro file; with --against, the new one")
    add_values(
        parser,
        values_help="the file to compare OLD with, and NAME:=VALUE for the <xacro:arg> of both files",
        name="words",
        metavar="NEW",
    )
    add_against(parser)
    parser.add_argument(
        "--format", choices=("text", "json"), default="text", help="the output format (default: %(default)s)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Print the differences.

    Returns:
        0 if there are no differences, 1 if there are some, 2 for an error.
    """
    from linkwright.descriptions.comparison import as_data, as_text

    with ExitStack() as stack:
        try:
            pair = open_requested_pair(arguments, stack)
            if pair is None:
                print("linkwright diff: pass two files, or one and --against COMMIT", file=sys.stderr)
                return FAILURE
            comparison = pair.read_and_compare()
        except LinkwrightError as error:
            print_diagnostics(error.diagnostics, sys.stderr)
            return FAILURE
        if arguments.format == "json":
            data = {"old": pair.old.label(), "new": pair.new.label(), "differences": as_data(comparison, pair.label)}
            print(json.dumps(data, indent=2, ensure_ascii=False))
        else:
            sys.stdout.write(as_text(comparison, pair.label))
    return DIFFERENT if comparison.differences else SAME
