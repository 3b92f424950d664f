"""Tell whether only added actions use a file, which a new argument switches off by default."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.review.launch_paths import find_launch_files
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.outlines import CONDITION, Entry, LaunchOutline
from linkwright.review.launches.programs.sources import try_read_outline
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.versions import Versions

_WORD = re.compile(r"\w+")
_READING = re.compile(r"\b(?:open|process_file|\w*(?:load|read|parse)\w*)\s*\(", re.IGNORECASE)
"""A call in Python that may read a file although no action needs it."""
_KNOWN_VALUE = re.compile(r"\$\((?:(?:opt)?env |(?:var|arg) [^() ]+ )")
"""A value in a condition that users may set today: an environment variable, or an argument that is not declared."""


def is_switched_off(versions: Versions, path: str, old_path: str, package: str, subpath: str) -> bool:
    """Return whether a launch file needs a file only for added actions, and only if users set a new argument.

    Args:
        versions: both versions of the repository.
        path: the path of the launch file.
        old_path: its path in the old version.
        package: the package with the file.
        subpath: the path of the file in the package.
    """
    old, new = try_read_outline(versions.old, old_path), try_read_outline(versions.new, path)
    if old is None or new is None or (path.endswith(PYTHON_SUFFIX) and _READING.search(versions.new.text(path))):
        return False
    arguments = {entry.name for entry in new.entries if entry.kind == "argument"}
    added = arguments.difference(_WORD.findall(versions.old.text(old_path)))
    outline = replace(new, entries=[entry for entry in new.entries if entry.name not in arguments - added])
    names = tuple(f"$({word} {package})/{subpath}" for word in ("find-pkg-share", "find"))
    users = _find_users(new, names)
    old_actions = {(entry.kind, entry.name) for entry in old.entries}
    return (
        bool(users)
        and all((user.kind, user.name) not in old_actions and _is_off(user, outline) for user in users)
        and not _sets_argument(versions, path, added)
    )


def _find_users(outline: LaunchOutline, names: tuple[str, ...]) -> list[Entry]:
    """Return the actions that may use a file, also by the value of an argument."""
    actions = [entry for entry in outline.entries if not entry.has_value]
    users = [
        entry
        for entry in actions
        if any(name in outline.resolve(text) for name in names for text in (entry.name, *entry.settings.values()))
    ]
    if any(name in value for name in names for value in outline.values.values()):
        users += [entry for entry in actions if entry.kind == "include" and entry not in users]
    return users


def _is_off(entry: Entry, outline: LaunchOutline) -> bool:
    """Return whether an action does not start, whatever the values of the arguments that the outline lacks."""
    condition = entry.settings.get(CONDITION, "")
    return not _KNOWN_VALUE.search(condition) and evaluate_condition(outline.resolve(condition)) is False


def _sets_argument(versions: Versions, path: str, arguments: set[str]) -> bool:
    """Return whether another launch file may start this one with one of several arguments."""
    name = PurePosixPath(path).name
    texts = (versions.new.text(other) for other in find_launch_files(versions.new) if other != path)
    return any(name in text and not arguments.isdisjoint(_WORD.findall(text)) for text in texts)
