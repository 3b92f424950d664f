"""``linkwright interface show``."""

from __future__ import annotations

import argparse
import sys

from linkwright.cli.interface.definition_text import definition_lines
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase

HELP = "print the definition of a type, with those of the types in it"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    group = parser.add_mutually_exclusive_group()
    group.add_argument("--all-comments", action="store_true", help="print the comments of nested types too")
    group.add_argument("--no-comments", action="store_true", help="print no comments and no blank lines")
    parser.add_argument("type", metavar="TYPE", help="such as std_msgs/msg/String; '-' reads it from standard input")


def run(arguments: argparse.Namespace) -> int:
    """Print the definition, as ros2 does."""
    from linkwright.messages import definition_text, get_interface

    name = arguments.type
    if name == "-":
        name = sys.stdin.readline().strip()
        if not name:
            raise LinkwrightError(Diagnostic("CLI442", phrase("there is no type on standard input")))
    name = get_interface(name).TYPE_NAME
    lines = definition_lines(
        name,
        definition_text,
        comments=not arguments.no_comments,
        nested_comments=arguments.all_comments,
    )
    for line in lines:
        print(line)
    return 0
