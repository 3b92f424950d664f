"""What the verbs share that list names of the graph: their options, and how they print what they found."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.cli.lookup import NamesAndTypes


def add_types_argument(parser: argparse.ArgumentParser, *, types_help: str) -> None:
    """Declare ``--show-types``, with what its help says."""
    parser.add_argument("-t", "--show-types", action="store_true", help=types_help)


def add_count_argument(parser: argparse.ArgumentParser, kind: str) -> None:
    """Declare ``--count``, for topics, services, actions or nodes."""
    parser.add_argument(
        "-c",
        f"--count-{kind}s",
        "--count",
        dest="count",
        action="store_true",
        help="print only how many there are",
    )


def add_hidden_argument(parser: argparse.ArgumentParser, option: str, *, hidden_help: str) -> None:
    """Declare ``--include-hidden-topics`` or the like, which may stand before the verb too."""
    parser.add_argument(
        option,
        "-a",
        "--all",
        action="store_true",
        default=argparse.SUPPRESS,
        help=hidden_help,
    )


def print_names(names: Sequence[str], arguments: argparse.Namespace) -> None:
    """Print names, a line each, or how many there are."""
    for line in [len(names)] if arguments.count else names:
        print(line)


def print_names_and_types(found: NamesAndTypes, arguments: argparse.Namespace) -> None:
    """Print names with their types, if they are asked for, or how many there are; as ros2 does."""
    lines = [f"{name} [{', '.join(types)}]" if arguments.show_types else name for name, types in found]
    print_names(lines, arguments)
