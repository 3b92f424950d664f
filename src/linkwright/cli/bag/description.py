"""``linkwright bag description``: print the robot description of a recording.

The command can also compare the description with a file.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.diff import DIFFERENT, FAILURE, SAME
from linkwright.cli.model_arguments import add_values
from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, phrase, print_diagnostics
from linkwright.diagnostics.translation import localized
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    from linkwright.bag import BagReader

_HASH_DIGITS = 12
"""The number of digits of a hash that messages show."""


def configure_description(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``bag description``."""
    parser.add_argument("bag", metavar="BAG", help="the folder of a recording, or one .mcap or .db3 file")
    add_values(
        parser,
        values_help="a URDF or xacro file to compare with the recorded description, and NAME:=VALUE for its "
        "<xacro:arg>",
        name="words",
        metavar="FILE|NAME:=VALUE",
    )


def run_description(arguments: argparse.Namespace) -> int:
    """Print the description, or the differences between it and a file.

    Returns:
        0; with a file, the exit status of `linkwright diff`: 0 if there are no differences, 1 if there are some, 2 for
        an error.
    """
    from linkwright.bag import BagReader
    from linkwright.bag.robot_description import find_recorded_description

    files = [word for word in arguments.words if ":=" not in word]
    if len(files) > 1:
        print("linkwright bag description: pass one file at most", file=sys.stderr)
        return FAILURE
    try:
        with BagReader(arguments.bag) as bag:
            print_diagnostics(bag.findings, sys.stderr)
            if files:
                return _compare(bag, Path(files[0]), parse_assignments([w for w in arguments.words if ":=" in w]))
            text = find_recorded_description(bag)
    except LinkwrightError as error:
        print_diagnostics(error.diagnostics, sys.stderr)
        return FAILURE
    if text is None:
        print_diagnostics([_missing_description_error(arguments.bag)], sys.stderr)
        return FAILURE
    sys.stdout.write(text if text.endswith("\n") else f"{text}\n")
    return SAME


def _compare(bag: BagReader, path: Path, values: dict[str, str]) -> int:
    """Print the differences between the recorded description and a file.

    Raises:
        LinkwrightError: the file or the recorded description cannot be read; BAG118, the recording has neither a
            description nor its hash.
    """
    from linkwright.bag.robot_description import find_recorded_description, find_recorded_hash, hash_description
    from linkwright.descriptions.comparison import as_text
    from linkwright.descriptions.pairs import Model, Pair
    from linkwright.files.scratch_folders import ScratchFolder
    from linkwright.packages import PackageFinder

    finder = PackageFinder(start=[path.absolute().parent, Path.cwd()])
    new = Model(path.absolute(), values, finder)
    text = find_recorded_description(bag)
    if text is None:
        known_hash = find_recorded_hash(bag)
        if known_hash is None:
            raise LinkwrightError(_missing_description_error(str(bag.path)))
        return _compare_hashes(known_hash, hash_description(new.read().text))
    with ScratchFolder("recorded") as folder:
        recorded = Path(folder).resolve() / "robot.urdf"
        recorded.write_text(text, encoding="utf-8")
        comparison = Pair(Model(recorded, {}, finder), new).read_and_compare()

        def label(file: str) -> str:
            return display_path(bag.path) if Path(file) == recorded else new.display_name(file)

        sys.stdout.write(as_text(comparison, label))
    return DIFFERENT if comparison.differences else SAME


def _compare_hashes(recorded_hash: str, file_hash: str) -> int:
    if recorded_hash == file_hash:
        print(localized(phrase("the description is the same as in the recording")))
        return SAME
    message = phrase(
        "the description differs from the recorded one; the recording has only a hash: "
        "SHA-256 {recorded}... -> {present}...",
        recorded=recorded_hash[:_HASH_DIGITS],
        present=file_hash[:_HASH_DIGITS],
    )
    print(localized(message))
    return DIFFERENT


def _missing_description_error(bag: str) -> Diagnostic:
    message = phrase("'{path}' has no robot description", path=display_path(bag))
    hint = phrase("record the topic /robot_description, too; `linkwright bag record -a` records all topics")
    return Diagnostic("BAG118", message, hint=hint)
