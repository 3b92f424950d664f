"""Find names of a node that an added node of the same launch file offers in the new version."""

from __future__ import annotations

from collections.abc import Collection

from linkwright.review.launches.matching import find_loaded_class
from linkwright.review.launches.outlines import (
    NAMESPACE,
    PROGRAM_KINDS,
    REMAPPING,
    Entry,
    LaunchOutline,
    without_condition,
)
from linkwright.review.launches.programs.sides import Side, find_side


def is_taken_over(entry: Entry, name: str, old: LaunchOutline, new: LaunchOutline) -> bool:
    """Return whether another program newly offers a name to which a node remapped its own.

    The old file does not start the program, or remaps other names of it to this one.

    Args:
        entry: the node.
        name: the name outside of the node.
        old: the outline of the old file.
        new: the outline of the new file.
    """
    resolved = old.resolve(name)
    known = {
        (other.name, setting)
        for other in old.entries
        for setting, value in other.settings.items()
        if setting.startswith(REMAPPING) and old.resolve(value) == resolved
    }
    return any(
        _offers(other, resolved, entry, new, known)
        for other in new.entries
        if other.kind in PROGRAM_KINDS and other.name != entry.name
    )


def _offers(other: Entry, name: str, entry: Entry, outline: LaunchOutline, known: Collection[tuple[str, str]]) -> bool:
    """Return whether a node newly remaps a topic or service that it may offer to a name.

    Args:
        other: the node.
        name: the name outside of the node.
        entry: the node that had the name.
        outline: the outline of the new file.
        known: the programs and remappings to the name in the old file.
    """
    namespaces = (outline.resolve(item.settings.get(NAMESPACE, "")).strip("/") for item in (entry, other))
    if not name.startswith("/") and len(set(namespaces)) > 1:
        return False
    program = find_loaded_class(other) or other.name
    return any(
        outline.resolve(value) == name
        and find_side(program, without_condition(setting).removeprefix(REMAPPING), outline.root)
        in (Side.OFFERS, Side.UNKNOWN)
        for setting, value in other.settings.items()
        if setting.startswith(REMAPPING) and (other.name, setting) not in known
    )
