"""Tell whether a launch file uses an argument."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from linkwright.review.launches.outlines import Entry

USED_ARGUMENT = re.compile(r"\$\((?:var|arg) ([\w./-]+)")
_COMMENT = re.compile(r"<!--.*?-->|^\s*#[^\n]*", re.DOTALL | re.MULTILINE)
_COMPUTED_USE = re.compile(r"\bLaunchConfiguration\(\s*(?![\"'\s])|\blaunch_configurations\b(?!\[[\"'])")
"""A use of an argument whose name a Python file computes."""
_READING = re.compile(r"^[ \t]*(?P<name>\w+)[ \t]*=[ \t]*LaunchConfiguration\([^()\n]*\)[ \t]*$", re.MULTILINE)
"""A statement that assigns an argument to a name."""
_DEFAULTED_ARGUMENT = re.compile(r"\bLaunchConfiguration\(\s*[\"'](?P<name>[\w./-]+)[\"']\s*,\s*default\s*=")


def uses_argument(file: Path, name: str, entries: Sequence[Entry], *, is_declared: bool = True) -> bool:
    """Return whether a launch file may use an argument, apart from the files that it includes.

    Args:
        file: the launch file.
        name: the name of the argument.
        entries: the actions of the launch file, also those that functions of other files make.
        is_declared: whether the file declares the argument. Otherwise, only certain uses count.
    """
    others = [entry for entry in entries if entry.kind != "argument" or entry.name != name]
    if not is_declared:
        return is_used(name, others)
    text = _drop_unused_readings(read_code(file))
    return is_used(name, others) or may_use(text, name) or uses_computed_arguments(text)


def uses_computed_arguments(text: str) -> bool:
    """Return whether a Python file uses an argument whose name it computes."""
    return _COMPUTED_USE.search(text) is not None


def _drop_unused_readings(text: str) -> str:
    """Return a Python file without the assignments of arguments to names that nothing uses."""

    def drop(match: re.Match[str]) -> str:
        is_used_later = len(re.findall(rf"(?<![\w\"'.]){match['name']}(?![\w\"'])", text)) > 1
        return match[0] if is_used_later else ""

    return _READING.sub(drop, text)


def may_use(text: str, name: str) -> bool:
    """Return whether a file may use an argument outside of its declaration."""
    pattern = re.escape(name)
    is_in_expression = re.search(rf"\$\([^<>]*?(?<![\w.-]){pattern}(?![\w.-])", text)
    return is_in_expression is not None or len(re.findall(rf"[\"']{pattern}[\"']", text)) > 1


def is_used(name: str, entries: Sequence[Entry]) -> bool:
    """Return whether an action uses an argument."""
    return any(
        name in USED_ARGUMENT.findall(text) for entry in entries for text in (entry.name, *entry.settings.values())
    )


def had_action(entry: Entry, argument: str, old_entries: Sequence[Entry]) -> bool:
    """Return whether an old version had an action, perhaps under another name with the same use of an argument."""
    similar = [other for other in old_entries if other.kind == entry.kind]
    return any(other.name == entry.name for other in similar) or is_used(argument, similar)


def read_code(file: Path) -> str:
    """Return the text of a launch file without comments."""
    return _COMMENT.sub("", file.read_text("utf-8", errors="replace"))


def find_defaulted_arguments(file: Path) -> frozenset[str]:
    """Return the arguments that a Python launch file reads with a default of its own, also if it uses no such value."""
    return frozenset(match["name"] for match in _DEFAULTED_ARGUMENT.finditer(read_code(file)))
