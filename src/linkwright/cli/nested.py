"""Commands with subcommands, such as ``topic echo``, each with a separate argument parser."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from typing import NamedTuple, cast


class SubVerb(NamedTuple):
    """A subcommand.

    Attributes:
        configure: declares the arguments.
        run: runs the subcommand and returns the exit status.
        help: the one-line help text.
    """

    configure: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace], int]
    help: str


def configure_nested(parser: argparse.ArgumentParser, verbs: Mapping[str, SubVerb]) -> None:
    """Declare the subcommands of a command.

    Args:
        parser: the command's parser.
        verbs: the subcommands by name.
    """
    subparsers = parser.add_subparsers(dest="verb", metavar="COMMAND", title="commands")
    for name, verb in verbs.items():
        subparser = subparsers.add_parser(
            name, help=verb.help, description=verb.help, formatter_class=parser.formatter_class
        )
        verb.configure(subparser)
        subparser.set_defaults(run_verb=verb.run)
    parser.set_defaults(print_help=parser.print_help)


def run_nested(arguments: argparse.Namespace) -> int:
    """Run the requested subcommand, or print the help as ros2 does if none is requested."""
    run_verb = getattr(arguments, "run_verb", None)
    if run_verb is None:
        arguments.print_help()
        return 0
    return cast("int", run_verb(arguments))
