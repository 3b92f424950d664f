"""``linkwright param set``."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from linkwright.cli.param.access import RemoteParameters, parameter_of, print_result
from linkwright.cli.param.arguments import add_node_arguments
from linkwright.cli.session import run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

HELP = "set parameters of a node"

_USAGE = 2


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_node_arguments(parser)
    parser.add_argument(
        "words", metavar="NAME VALUE", nargs="+", help="a parameter's name and its value in YAML; and so on for more"
    )
    parser.add_argument("--atomic", action="store_true", help="set all or none")


def run(arguments: argparse.Namespace) -> int:
    """Set them, and say of each whether it was."""
    words = arguments.words
    if len(words) % 2:
        said = f"Parameters must be provided as name/value pairs: name value [name value ...]. Got {len(words)} word(s)"
        print(f"linkwright param set: {said}", file=sys.stderr)
        return _USAGE
    wanted = [parameter_of(name, value) for name, value in zip(words[::2], words[1::2], strict=True)]

    async def job(session: Session) -> int:
        parameters = await RemoteParameters.of(session, arguments)
        if arguments.atomic:
            result = await parameters.set_together(wanted)
            print_result(result, "Set parameters atomically successful", "Setting parameters atomically failed")
            return 0 if result.successful else 1
        results = await parameters.set(wanted)
        for parameter, result in zip(wanted, results, strict=True):
            before = f"{parameter.name}: " if len(wanted) > 1 else ""
            print_result(result, f"{before}Set parameter successful", f"{before}Setting parameter failed")
        return 0 if all(result.successful for result in results) else 1

    return run_in_graph(arguments, job)
