"""The common code of commands that list graph names with their types."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from linkwright.cli.lookup import make_absolute, sort_visible_names, unknown_name_error
from linkwright.cli.session import run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.lookup import NamesAndTypes
    from linkwright.cli.session import Session
    from linkwright.diagnostics import Phrase


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of graph names with types: topics, services or actions.

    Attributes:
        find_names: returns the existing names with their types.
        code: the code of the error for an unknown name.
        missing_message: returns the message of the error for a name.
        hint: the hint of the error if no existing name is similar.
    """

    find_names: Callable[[Session], NamesAndTypes]
    code: str
    missing_message: Callable[[str], Phrase]
    hint: Phrase

    def find_types(self, session: Session, requested_name: str, *, hidden: bool = True) -> list[str]:
        """Return the types of a name from the command line.

        Raises:
            LinkwrightError: with `code`, the name does not exist.
            InvalidNameError: the name is not valid.
        """
        name = make_absolute(requested_name)
        types_by_name = dict(sort_visible_names(self.find_names(session), hidden=hidden))
        if name not in types_by_name:
            raise unknown_name_error(self.code, self.missing_message(requested_name), name, types_by_name, self.hint)
        return types_by_name[name]

    def print_types(self, arguments: argparse.Namespace, requested_name: str, *, hidden: bool = True) -> int:
        """Print the types of a name, one per line, and return the exit status."""
        make_absolute(requested_name)  # reject an invalid name before joining the graph

        async def job(session: Session) -> int:
            print("\n".join(self.find_types(session, requested_name, hidden=hidden)))
            return 0

        return run_in_graph(arguments, job, read_only=True)

    def print_of_type(self, arguments: argparse.Namespace, type_name: str, *, hidden: bool) -> int:
        """Print the names that have the type `type_name`, and return the exit status."""

        async def job(session: Session) -> int:
            types_by_name = sort_visible_names(self.find_names(session), hidden=hidden)
            print_names([name for name, types in types_by_name if type_name in types], arguments)
            return 0

        return run_in_graph(arguments, job, read_only=True)


def add_types_argument(parser: argparse.ArgumentParser, *, types_help: str) -> None:
    """Declare the option ``--show-types``."""
    parser.add_argument("-t", "--show-types", action="store_true", help=types_help)


def add_count_argument(parser: argparse.ArgumentParser, kind: str) -> None:
    """Declare the option ``--count``, also as ``--count-topics`` for the kind ``topic``."""
    parser.add_argument(
        "-c",
        f"--count-{kind}s",
        "--count",
        dest="count",
        action="store_true",
        help="print only the number of results",
    )


def add_hidden_argument(parser: argparse.ArgumentParser, option: str, *, hidden_help: str) -> None:
    """Declare an option that includes hidden names, such as ``--include-hidden-topics``.

    The option is also accepted before the subcommand.
    """
    parser.add_argument(
        option,
        "-a",
        "--all",
        action="store_true",
        default=argparse.SUPPRESS,
        help=hidden_help,
    )


def print_names(names: Sequence[str], arguments: argparse.Namespace) -> None:
    """Print names, one per line, or only their number if ``--count`` is given."""
    for line in [len(names)] if arguments.count else names:
        print(line)


def print_names_and_types(names_and_types: NamesAndTypes, arguments: argparse.Namespace) -> None:
    """Print names as ros2 does: with their types if requested, or only their number."""
    lines = [f"{name} [{', '.join(types)}]" if arguments.show_types else name for name, types in names_and_types]
    print_names(lines, arguments)
