"""``linkwright bisect``: find the commit that changed a part of a robot.

It can also find the commit that changed the result of a command.
"""

from __future__ import annotations

import argparse
import sys
from contextlib import closing
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.exit_status import FINDINGS, FINE, USAGE
from linkwright.cli.progress import ProgressLine
from linkwright.diagnostics import Phrase, counted, phrase
from linkwright.diagnostics.translation import localized
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    from linkwright.review.bisecting import CommandCheck, FoundCommit, History, PartCheck


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``bisect``."""
    parser.add_argument("file", metavar="FILE", help="the URDF or xacro file")
    parser.add_argument(
        "words",
        metavar="CHECK",
        nargs="+",
        help="NAME:=VALUE for the file's <xacro:arg>; then, after --, a link or joint, which is compared with the "
        "newest commit, or a command of several words, which runs in a folder with the files of each commit. In a "
        "command, the word FILE becomes the path of the description, and the exit status 125 means that the commit "
        "cannot be judged",
    )
    parser.add_argument(
        "--old", metavar="COMMIT", default="", help="the oldest commit to consider (default: the first one of the file)"
    )
    parser.add_argument(
        "--new", metavar="COMMIT", default="HEAD", help="the newest commit to consider (default: %(default)s)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Print the first commit with the state or result of the newest one.

    Returns:
        0, 1 if the oldest commit has the same state or result, or 2 for wrong usage.
    """
    values = list(takewhile(lambda word: ":=" in word, arguments.words))
    check_words = arguments.words[len(values) :]
    if not check_words:
        print("linkwright bisect: pass a link, a joint or a command after --", file=sys.stderr)
        return USAGE
    from linkwright.review.bisecting import CommandCheck, History, PartCheck

    history = History(Path(arguments.file), arguments.old, arguments.new)
    if len(check_words) == 1:
        with closing(PartCheck(history, parse_assignments(values), check_words[0])) as check:
            return _search(history, check, phrase("'{name}' is the same in all commits", name=check_words[0]))
    return _search(
        history, CommandCheck(history, check_words), phrase("the command has the same result in all commits")
    )


def _search(history: History, check: PartCheck | CommandCheck, unchanged: Phrase) -> int:
    progress = ProgressLine()

    def show(count: int) -> None:
        progress.show(counted("{count} commit left", "{count} commits left", count))

    try:
        change = history.search(check, show)
    finally:
        progress.end()
    if change is None:
        print(localized(unchanged))
        return FINDINGS
    _print_change(check, change)
    return FINE


def _print_change(check: PartCheck | CommandCheck, change: FoundCommit) -> None:
    from linkwright.review.bisecting import PartCheck, format_part_difference, format_undecided_count

    print(change.title)
    if isinstance(check, PartCheck):
        for difference in check.differences(change.before):
            print(f"  {localized(format_part_difference(difference))}")
    if change.undecided:
        print(localized(format_undecided_count(change.undecided)))
