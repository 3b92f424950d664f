"""The completions of a command line.

`tools/command_reference.py` extracts the commands, their options and arguments from the commands' own parsers, and
writes them to the table ``commands.json``. Creating the parsers at run time would take too long after TAB is pressed.
The name of an argument in the help (``PACKAGE``, ``TOPIC``) selects its candidates.
"""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from linkwright.cli.completion.values import find_argument_candidates

TABLE_PATH = Path(__file__).with_name("commands.json")

_LAUNCH_METAVAR = "PACKAGE FILE | PATH [NAME:=VALUE ...]"


def split_line(line: str) -> list[str]:
    """Split a command line up to the cursor into words.

    The last word is the word at the cursor, and may be empty.
    """
    try:
        words = shlex.split(line)
    except ValueError:  # an opening quotation mark is not closed yet
        words = line.split()
    return [*words, ""] if not words or line[-1:].isspace() else words


def complete(words: Sequence[str]) -> list[str]:
    """Return the completions of the last word.

    The completion `scripts.FILES` represents all file names.
    """
    program, *arguments = words
    *preceding, current = arguments or [""]
    current = current.lstrip("'\"")  # the opening quotation mark of an unfinished string
    candidates = _find_candidates(
        Path(program).name, preceding, current, json.loads(TABLE_PATH.read_text(encoding="utf-8"))
    )
    return [candidate for candidate in dict.fromkeys(candidates) if candidate.startswith((current, ":"))]


def _find_candidates(program: str, preceding: list[str], current: str, table: dict[str, Any]) -> Iterable[str]:
    verbs: dict[str, Any] = table["verbs"]
    if not preceding:
        return table["ros2"] if program == "ros2" else [*verbs, "--help", "--version"]
    command, path = verbs.get(preceding[0], {}), preceding[:1]
    remaining = preceding[1:]
    if "below" in command:
        subcommand_index = next((index for index, word in enumerate(remaining) if not word.startswith("-")), None)
        if subcommand_index is None:
            return [*command["below"], *command["options"]]
        command, path = command["below"].get(remaining[subcommand_index], {}), [*path, remaining[subcommand_index]]
        remaining = remaining[subcommand_index + 1 :]
    options: dict[str, Any] = command.get("options", {})
    if remaining and options.get(remaining[-1]):
        return _find_argument_candidates(options[remaining[-1]], path, [], table)
    if current.startswith("-"):
        return options
    positionals = [word for index, word in enumerate(remaining) if not _is_option(remaining, index, options)]
    parameters: list[dict[str, Any]] = command.get("places", [])
    if not parameters or (len(positionals) >= len(parameters) and not parameters[-1]["many"]):
        return options
    return _find_argument_candidates(parameters[min(len(positionals), len(parameters) - 1)], path, positionals, table)


def _is_option(words: list[str], index: int, options: dict[str, Any]) -> bool:
    """Return whether a word is an option or the argument of the preceding option."""
    return words[index].startswith("-") or (index > 0 and bool(options.get(words[index - 1])))


def _find_argument_candidates(
    argument: dict[str, Any], path: list[str], positionals: list[str], table: dict[str, Any]
) -> Iterable[str]:
    metavar: str = argument["name"]
    if argument.get("choices"):
        return [str(choice) for choice in argument["choices"]]
    if metavar == _LAUNCH_METAVAR:
        metavar = ("LAUNCH_PACKAGE", "LAUNCH_FILE", "LAUNCH_ARGUMENT")[min(len(positionals), 2)]
    return find_argument_candidates(metavar, path, positionals, table)
