"""Find arguments of launch files of ROS 1 that have a fixed value now, which callers cannot replace."""

from __future__ import annotations

from dataclasses import replace

from linkwright.diagnostics import joined_first, phrase, quoted_names
from linkwright.review.changes import MAX_NAMES
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.outlines import CONDITION, Entry, LaunchOutline


def report_fixed_arguments(pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> None:
    """Report the arguments that callers could pass to the old file, and that the new one sets to a value.

    Of conditional values, those count that hold by default.
    """
    if not (old.is_ros1 and new.is_ros1):
        return
    passable = {entry.name for entry in old.entries if entry.kind == "argument" and "value" not in entry.settings}
    passable -= {entry.name for entry in old.entries if _is_fixed(entry, old)}
    fixed = {entry.name: entry for entry in new.entries if entry.name in passable and _is_fixed(entry, new)}
    if not fixed:
        return
    names = joined_first([quoted_names([name]) for name in fixed], MAX_NAMES)
    text = phrase("arguments with a fixed value now, instead of a default: {names}", names=names)
    first = next(iter(fixed.values()))
    pair.add(text, pair.location(first.span), phrase("launch files that pass {names} to the file fail", names=names))


def fix_value(argument: Entry) -> Entry:
    """Return an argument whose default is a fixed value."""
    return _rename_setting(argument, "default", "value")


def free_value(argument: Entry) -> Entry:
    """Return an argument whose fixed value is a default."""
    return _rename_setting(argument, "value", "default")


def _rename_setting(argument: Entry, old: str, new: str) -> Entry:
    settings = {new if name == old else name: value for name, value in argument.settings.items()}
    return replace(argument, settings=settings)


def _is_fixed(entry: Entry, outline: LaunchOutline) -> bool:
    is_fixed = entry.kind == "argument" and "value" in entry.settings
    return is_fixed and evaluate_condition(outline.resolve(entry.settings.get(CONDITION, ""))) is True
