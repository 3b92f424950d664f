"""Verbs with verbs of their own, such as ``topic echo``: each a module, all configured below one parser."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from importlib import import_module
from typing import Protocol, cast


class SubVerb(Protocol):
    """What the module of a verb below a verb offers."""

    HELP: str

    def configure(self, parser: argparse.ArgumentParser) -> None:
        """Declare the arguments."""

    def run(self, arguments: argparse.Namespace) -> int:
        """Do it; returns the exit status."""


def configure_nested(parser: argparse.ArgumentParser, package: str, modules: Mapping[str, str]) -> None:
    """Declare the verbs below a verb.

    Args:
        parser: the verb's.
        package: the dotted name of the package that the modules are in.
        modules: the names of the verbs, each with that of its module.
    """
    below = parser.add_subparsers(dest="verb", metavar="COMMAND", title="commands")
    for name, module_name in modules.items():
        module = cast("SubVerb", import_module(f"{package}.{module_name}"))
        made = below.add_parser(name, help=module.HELP, description=module.HELP, formatter_class=parser.formatter_class)
        module.configure(made)
        made.set_defaults(run_verb=module.run)
    parser.set_defaults(print_help=parser.print_help)


def run_nested(arguments: argparse.Namespace) -> int:
    """Run the verb that was named; without one, print the help as ros2 does."""
    run = getattr(arguments, "run_verb", None)
    if run is None:
        arguments.print_help()
        return 0
    return cast("int", run(arguments))
