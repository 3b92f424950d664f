"""Computes the completions of a command line.

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

from linkwright.cli.completion.values import candidates_of

TABLE = Path(__file__).with_name("commands.json")

_LAUNCH = "PACKAGE FILE | PATH [NAME:=VALUE ...]"


def divided(line: str) -> list[str]:
    """Split a command line up to the cursor into words; the last word is incomplete and may be empty."""
    try:
        words = shlex.split(line)
    except ValueError:  # an opening quotation mark is not closed yet
        words = line.split()
    return [*words, ""] if not words or line[-1:].isspace() else words


def complete(words: Sequence[str]) -> list[str]:
    """Return the completions of the last word; `scripts.FILES` represents file names."""
    program, *given = words
    *before, current = given or [""]
    current = current.lstrip("'\"")  # the opening quotation mark of an unfinished string
    found = _candidates(Path(program).name, before, current, json.loads(TABLE.read_text(encoding="utf-8")))
    return [fromkey for fromkey in dict.fromkeys(found) if fromkey.startswith((current, ":"))]


def _candidates(program: str, before: list[str], current: str, table: dict[str, Any]) -> Iterable[str]:
    verbs: dict[str, Any] = table["verbs"]
    if not before:
        return table["ros2"] if program == "ros2" else [*verbs, "--help", "--version"]
    command, path = verbs.get(before[0], {}), before[:1]
    rest = before[1:]
    if "below" in command:
        named = next((index for index, word in enumerate(rest) if not word.startswith("-")), None)
        if named is None:
            return [*command["below"], *command["options"]]
        command, path = command["below"].get(rest[named], {}), [*path, rest[named]]
        rest = rest[named + 1 :]
    options: dict[str, Any] = command.get("options", {})
    if rest and options.get(rest[-1]):
        return _of(options[rest[-1]], path, [], table)
    if current.startswith("-"):
        return options
    placed = [word for index, word in enumerate(rest) if not _is_option(rest, index, options)]
    places: list[dict[str, Any]] = command.get("places", [])
    if not places or (len(placed) >= len(places) and not places[-1]["many"]):
        return options
    return _of(places[min(len(placed), len(places) - 1)], path, placed, table)


def _is_option(words: list[str], index: int, options: dict[str, Any]) -> bool:
    """Return whether a word is an option or the argument of the preceding option."""
    return words[index].startswith("-") or (index > 0 and bool(options.get(words[index - 1])))


def _of(argument: dict[str, Any], path: list[str], placed: list[str], table: dict[str, Any]) -> Iterable[str]:
    kind: str = argument["name"]
    if argument.get("choices"):
        return [str(choice) for choice in argument["choices"]]
    if kind == _LAUNCH:
        kind = ("LAUNCH_PACKAGE", "LAUNCH_FILE", "LAUNCH_ARGUMENT")[min(len(placed), 2)]
    return candidates_of(kind, path, placed, table)
