"""Report the arguments of launch files that the new version no longer uses."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.effects import explain_argument_removal
from linkwright.review.launches.outlines import Entry, LaunchOutline

_ARGUMENT_WITH_DEFAULT = re.compile(r"\$\(var ([\w.-]+) ")
_USED_ARGUMENT = re.compile(r"\$\((?:var|arg) ([\w./-]+)")
_COMMENT = re.compile(r"<!--.*?-->|^\s*#[^\n]*", re.DOTALL | re.MULTILINE)
_COMPUTED_USE = re.compile(r"\bLaunchConfiguration\(\s*(?![\"'\s])|\blaunch_configurations\b(?!\[[\"'])")
"""A use of an argument whose name a Python file computes."""
_PASSING_ATTRIBUTE = "pass_all_args"
"""The attribute with which an include of ROS 1 passes all arguments."""


def report_unused_arguments(
    pair: FilePair, old: LaunchOutline, new: LaunchOutline, paired_old: Sequence[Entry]
) -> None:
    """Report the arguments that only the old version uses.

    Args:
        pair: both versions of the launch file.
        old: the old outline, with the new names of arguments.
        new: the outline of the new file.
        paired_old: the old actions that the new version also has. Arguments of removed actions are not reported.
    """
    _report_undeclared(pair, old, new)
    content = _COMMENT.sub("", _read_text(pair.new_file))
    if _PASSING_ATTRIBUTE in content or (not new.is_ros1 and any(entry.kind == "include" for entry in new.entries)):
        return  # an included file may use any argument
    old_names = {entry.name for entry in old.entries if _is_argument(entry) and _is_used(entry.name, paired_old)}
    for entry in new.entries:
        if not _is_argument(entry) or entry.name not in old_names or _is_used(entry.name, new.entries):
            continue
        if not _may_use(content, entry.name):
            text = phrase("argument '{name}' is no longer used", name=entry.name)
            reason = phrase("a value that a caller passes for '{name}' has no effect", name=entry.name)
            pair.add(text, pair.location(entry.span), reason)


def uses_argument(file: Path, name: str, entries: Sequence[Entry]) -> bool:
    """Return whether a launch file may use an argument that it declares, apart from the files that it includes.

    Args:
        file: the launch file.
        name: the name of the argument.
        entries: the actions of the launch file, also those that functions of other files make.
    """
    others = [entry for entry in entries if entry.kind != "argument" or entry.name != name]
    text = _COMMENT.sub("", _read_text(file))
    return _is_used(name, others) or _may_use(text, name) or _COMPUTED_USE.search(text) is not None


def _may_use(text: str, name: str) -> bool:
    """Return whether a file may use an argument outside of its declaration."""
    pattern = re.escape(name)
    is_in_expression = re.search(rf"\$\([^<>]*?(?<![\w.-]){pattern}(?![\w.-])", text)
    return is_in_expression is not None or len(re.findall(rf"[\"']{pattern}[\"']", text)) > 1


def _report_undeclared(pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> None:
    """Report the undeclared arguments that only the old version names."""
    used = {name: entry for entry in old.entries for name in _find_names_with_default(entry)}
    declared = {entry.name for outline in (old, new) for entry in outline.entries if entry.has_value}
    text = _read_text(pair.new_file) if used.keys() - declared else ""
    for name, entry in used.items():
        if name not in declared and not re.search(rf"\b{re.escape(name)}\b", text):
            location = pair.location(entry.span, is_old=True)
            pair.add(
                phrase("argument '{name}' removed", name=name),
                location,
                explain_argument_removal(name, is_ros1=old.is_ros1),
            )


def _read_text(file: Path) -> str:
    return file.read_text("utf-8", errors="replace")


def _find_names_with_default(entry: Entry) -> list[str]:
    return [name for text in (entry.name, *entry.settings.values()) for name in _ARGUMENT_WITH_DEFAULT.findall(text)]


def _is_argument(entry: Entry) -> bool:
    return entry.kind == "argument" and "value" not in entry.settings


def _is_used(name: str, entries: Sequence[Entry]) -> bool:
    """Return whether an action uses an argument."""
    return any(
        name in _USED_ARGUMENT.findall(text) for entry in entries for text in (entry.name, *entry.settings.values())
    )
