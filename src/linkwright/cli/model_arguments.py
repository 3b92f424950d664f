"""The command-line arguments for one or two descriptions and their xacro arguments."""

from __future__ import annotations

from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    import argparse
    from contextlib import ExitStack

    from linkwright.descriptions.pairs import Pair


def add_model(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments `file`, a robot description, and `values`, its xacro arguments."""
    parser.add_argument("file", metavar="FILE", help="the URDF or xacro file")
    add_values(parser, values_help="values for the file's <xacro:arg>")


def add_values(
    parser: argparse.ArgumentParser, *, values_help: str, name: str = "values", metavar: str = "NAME:=VALUE"
) -> None:
    """Declare a positional argument for any number of words ``name:=value``.

    Args:
        parser: the parser of the command.
        values_help: the help text, which states whether other words are accepted as well.
        name: the attribute of the parsed arguments that contains the words.
        metavar: the name of the argument in the help.
    """
    no_values: list[str] = []  # without a default, argparse reports the optional words as missing arguments, too
    parser.add_argument(name, metavar=metavar, nargs="*", default=no_values, help=values_help)


def add_second_model(parser: argparse.ArgumentParser) -> None:
    """Declare `words`, a second file and values for both files, and the option ``--against``."""
    add_values(
        parser,
        values_help="the new file to compare FILE with, and NAME:=VALUE for <xacro:arg>",
        name="words",
        metavar="NEW",
    )
    add_against(parser)


def add_against(parser: argparse.ArgumentParser) -> None:
    """Declare the option ``--against``, which names the commit to compare a description with."""
    parser.add_argument(
        "--against",
        metavar="COMMIT",
        help="compare the file, its includes and its meshes with a commit of its git repository, such as HEAD",
    )


def names_file(word: str) -> bool:
    """Return whether a word names a file, and is not ``name:=value`` or ``name=value``."""
    from pathlib import Path  # imported late, because the frequent command `xacro` needs only the functions above

    return ":=" not in word and ("=" not in word or Path(word).exists())


def open_requested_pair(arguments: argparse.Namespace, stack: ExitStack) -> Pair | None:
    """Return the two descriptions to compare, or None if the command line does not specify two.

    Args:
        arguments: the parsed arguments `file`, `words` and `against`.
        stack: receives the resources to close.

    Raises:
        LinkwrightError: see `linkwright.descriptions.revisions.file_in_commit`.
    """
    from pathlib import Path

    from linkwright.descriptions.pairs import make_file_pair, make_pair_with_commit

    files = [word for word in arguments.words if names_file(word)]
    values = parse_assignments([word for word in arguments.words if not names_file(word)])
    if len(files) != (0 if arguments.against else 1):
        return None
    path = Path(arguments.file)
    if arguments.against:
        pair = make_pair_with_commit(path, arguments.against, values)
        stack.callback(pair.close)
        return pair
    return make_file_pair(path, Path(files[0]), values)
