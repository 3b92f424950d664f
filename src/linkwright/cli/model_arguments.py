"""The arguments of commands that take a description: its file, values for it, and what it is compared with."""

from __future__ import annotations

from linkwright.assignments import parse_assignments
from linkwright.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse
    from contextlib import ExitStack

    from linkwright.descriptions.pairs import Pair


def add_model(parser: argparse.ArgumentParser) -> None:
    """The file of a robot's description, `file`, and `values` for its arguments."""
    parser.add_argument("file", metavar="FILE", help="the URDF or xacro file")
    add_values(parser, values_help="values for the file's <xacro:arg>")


def add_values(
    parser: argparse.ArgumentParser, *, values_help: str, name: str = "values", metavar: str = "NAME:=VALUE"
) -> None:
    """Words of the form ``name:=value``, as many as there are; others may be among them where the help says so."""
    nothing: list[str] = []  # without a default argparse says that it misses them too
    parser.add_argument(name, metavar=metavar, nargs="*", default=nothing, help=values_help)


def add_second_model(parser: argparse.ArgumentParser) -> None:
    """`words`, a second file that the first is compared with and values for both, and the option `against`."""
    add_values(
        parser,
        values_help="a second file, the new one of two that are compared, and NAME:=VALUE for <xacro:arg>",
        name="words",
        metavar="NEW",
    )
    add_against(parser)


def add_against(parser: argparse.ArgumentParser) -> None:
    """The commit that a description is compared with."""
    parser.add_argument(
        "--against",
        metavar="COMMIT",
        help="compare the file with what it was in a commit of its git repository, such as HEAD, with all that it "
        "includes and its meshes",
    )


def names_file(word: str) -> bool:
    """Whether a word is a file and not ``name:=value``, nor what looks like that and is no file, ``name=value``."""
    from pathlib import Path  # `xacro`, which is called often, declares its values here and needs no more

    return ":=" not in word and ("=" not in word or Path(word).exists())


def asked_pair(arguments: argparse.Namespace, stack: ExitStack) -> Pair | None:
    """The two descriptions that a command line asks for; None where it does not name two, or more.

    Args:
        arguments: `file`, `words` and `against`.
        stack: is told what is to be closed.

    Raises:
        LinkwrightError: see `linkwright.descriptions.revisions.Revision`.
    """
    from pathlib import Path

    from linkwright.descriptions.pairs import against, pair_of

    files = [word for word in arguments.words if names_file(word)]
    values = parse_assignments([word for word in arguments.words if not names_file(word)])
    if len(files) != (0 if arguments.against else 1):
        return None
    first = Path(arguments.file)
    if arguments.against:
        pair = against(first, arguments.against, values)
        stack.callback(pair.close)
        return pair
    return pair_of(first, Path(files[0]), values)
