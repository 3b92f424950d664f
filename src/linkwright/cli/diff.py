"""``linkwright diff``: what has changed from one description to another, or since a commit."""

from __future__ import annotations

import argparse
import json
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.assignments import parse_assignments
from linkwright.diagnostics import LinkwrightError, print_diagnostics

if TYPE_CHECKING:
    from linkwright.descriptions.pairs import Pair

SAME, DIFFERENT, TROUBLE = 0, 1, 2
"""Exit statuses, those of ``diff``."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("file", metavar="OLD", help="the URDF or xacro file; with --against, the new one")
    parser.add_argument(
        "words",
        metavar="NEW",
        nargs="*",
        default=[],
        help="the file to compare it with, and NAME:=VALUE for the <xacro:arg> of both files",
    )
    add_against(parser)
    parser.add_argument(
        "--format", choices=("text", "json"), default="text", help="form of the result (default: %(default)s)"
    )


def add_against(parser: argparse.ArgumentParser) -> None:
    """The option about the other description, which `view` and `export` have too."""
    parser.add_argument(
        "--against",
        metavar="COMMIT",
        help="compare the file with what it was in a commit of its git repository, such as HEAD, with all that it "
        "includes and its meshes",
    )


def run(arguments: argparse.Namespace) -> int:
    """Print the differences; the status is 0 where there are none, 1 where there are some, 2 for trouble."""
    from linkwright.descriptions.comparison import as_data, as_text

    with ExitStack() as stack:
        try:
            pair = asked_pair(arguments, stack)
            if pair is None:
                print("linkwright diff: give two files, or one and --against COMMIT", file=sys.stderr)
                return TROUBLE
            comparison = pair.compared()
        except LinkwrightError as error:
            print_diagnostics(error.diagnostics, sys.stderr)
            return TROUBLE
        if arguments.format == "json":
            data = {"old": pair.old.label(), "new": pair.new.label(), "differences": as_data(comparison, pair.label)}
            print(json.dumps(data, indent=2, ensure_ascii=False))
        else:
            sys.stdout.write(as_text(comparison, pair.label))
    return DIFFERENT if comparison.differences else SAME


def asked_pair(arguments: argparse.Namespace, stack: ExitStack) -> Pair | None:
    """The two descriptions that a command line asks for; None where it does not name two, or more.

    Args:
        arguments: `file`, `words` and `against`.
        stack: is told what is to be closed.

    Raises:
        LinkwrightError: see `linkwright.descriptions.revisions.Revision`.
    """
    from linkwright.descriptions.pairs import against, pair_of

    files = [word for word in arguments.words if ":=" not in word]
    values = parse_assignments([word for word in arguments.words if ":=" in word])
    if len(files) != (0 if arguments.against else 1):
        return None
    first = Path(arguments.file)
    if arguments.against:
        pair = against(first, arguments.against, values)
        stack.callback(pair.close)
        return pair
    return pair_of(first, Path(files[0]), values)
