"""Report nodes with equal names that a launch file newly starts, which roslaunch of ROS 1 refuses."""

from __future__ import annotations

from collections import Counter

from linkwright.diagnostics import phrase
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.outlines import CONDITION, NAMESPACE, PROGRAM_KINDS, Entry, LaunchOutline


def report_repeated_nodes(pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> None:
    """Report the names that several nodes of the new version have by default, and at most one of the old version.

    In ROS 2, the nodes start, but share their parameters and services.
    """
    if old.is_ros1 != new.is_ros1:
        return
    reason = phrase("roslaunch refuses the file") if new.is_ros1 else None
    old_counts = Counter(_find_name(entry, old) for entry in old.entries)
    seen: set[str] = set()
    for entry in new.entries:
        name = _find_name(entry, new)
        if name is not None and name in seen and old_counts[name] < 2:
            text = phrase("several nodes have the name '{name}'", name=name)
            pair.add(text, pair.location(entry.span), reason)
            old_counts[name] = 2
        seen.add(name or "")


def _find_name(entry: Entry, outline: LaunchOutline) -> str | None:
    """Return the full name of a node that starts by default, or None if it is unknown."""
    if entry.kind not in PROGRAM_KINDS or "name" not in entry.settings:
        return None
    if evaluate_condition(outline.resolve(entry.settings.get(CONDITION, ""))) is not True:
        return None
    names = [outline.resolve(entry.settings.get(setting, "")) for setting in (NAMESPACE, "name")]
    return None if any("$(" in name for name in names) else "/".join(filter(None, (name.strip("/") for name in names)))
