"""Decide whether removing a group of parameters from a file without nodes is breaking."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.file_pair import FilePair
from linkwright.review.files.arms.lost_plan_groups import is_of_lost_group
from linkwright.review.files.parameters.names import is_parameter
from linkwright.review.versions import Version

_MIN_GROUP_SIZE = 2
_PARAMETERS = "ros__parameters"
"""The key of the parameters of a node in ROS 2, which is below the name of the node."""
_TOP_KEY = re.compile(r"^['\"]?([\w./~-]+)['\"]?\s*:", re.MULTILINE)
LAUNCH_SUFFIXES = (".launch", "launch.py", "launch.xml", "launch.yaml", "launch.yml")
"""The ends of the names of launch files."""


_DESCRIPTION_SUFFIXES = (".xacro", ".urdf")
_PROGRAM_SUFFIXES = (".py", ".launch", ".launch.xml", ".cpp", ".hpp", ".h", ".sh")
"""The ends of the names of other files that may read a parameter file."""
_LIST_ITEM = re.compile(r"\[([^\[\]]+)\]")
"""The name of an item of a list in a path, such as ``behaviors[rotate].type``."""


def find_lost_items(old: Iterable[str], new: Iterable[str]) -> frozenset[str]:
    """Return the names of list items that only the old version of a file has.

    Args:
        old: the paths of the old values.
        new: the paths of the new values.
    """
    before, after = ({item for path in paths for item in _LIST_ITEM.findall(path)} for paths in (old, new))
    return frozenset(before - after)


def find_group_reason(
    pair: FilePair, name: str, values: Collection[str], lost_items: Collection[str] = ()
) -> Phrase | None:
    """Return the reason why removing a group at the top of a file is breaking, or None.

    A group that moved to a file which launch files load is not lost. No program reads the group of a plugin that its
    list loses, such as a recovery behavior of ``move_base``. A list is not a group. In ROS 2, no program gets
    parameters without the name of a node, and ROS 2 refuses files that also have a group for none. A file that
    descriptions read is for them only.

    Args:
        pair: both versions of the file.
        name: the path of the removed part.
        values: the paths of its values.
        lost_items: the names of list items that only the old version has.
    """
    is_refused = _PARAMETERS in pair.versions.old.text(pair.old_path)
    is_unread = name == _PARAMETERS or name in lost_items or is_refused
    if is_unread or len(values) < _MIN_GROUP_SIZE or "." in name:
        return None
    if any("[" in value or is_parameter(value) for value in values) or _is_unread_by_descriptions(pair, name):
        return None
    if is_of_lost_group(pair.versions, pair.new_path, name):
        return None
    keys = {value.removeprefix(f"{name}.").partition(".")[0] for value in values}
    if any(path != pair.new_path and _has_group(pair, path, name, keys) for path in list_changed_files(pair)):
        return None
    return phrase("programs that read '{name}' from the file do not find it", name=name)


def _is_unread_by_descriptions(pair: FilePair, name: str) -> bool:
    """Return whether only descriptions of the old version name a file, and none of them names the group.

    A description may pass the whole file to macros of another file, so that any description counts.
    """
    version, file_name = pair.versions.old, PurePosixPath(pair.old_path).name
    texts = [version.text(path) for path in version.paths(_DESCRIPTION_SUFFIXES)]
    others = (version.text(path) for path in version.paths(_PROGRAM_SUFFIXES))
    word = re.compile(rf"\b{re.escape(name)}\b")
    return (
        any(file_name in text for text in texts)
        and not any(file_name in text or word.search(text) for text in others)
        and not any(word.search(text) for text in texts)
    )


def list_changed_files(pair: FilePair) -> list[str]:
    """Return the paths of the changed YAML files of the new version."""
    paths = (file.new_path for file in pair.versions.changed_files)
    return [path for path in paths if path and path.endswith((".yaml", ".yml"))]


def _has_group(pair: FilePair, path: str, name: str, keys: Collection[str]) -> bool:
    """Return whether a file that a launch file names contains a group, or most of its keys for a single node."""
    version = pair.versions.new
    found = set(_TOP_KEY.findall(version.text(path)))
    has_keys = len(keys) >= _MIN_GROUP_SIZE and 2 * len(found & set(keys)) > len(keys)
    if name not in found and not has_keys:
        return False
    return is_named_by_launch_file(version, path)


def is_named_by_launch_file(version: Version, path: str) -> bool:
    """Return whether a launch file of a version contains the name of a file."""
    file_name = PurePosixPath(path).name
    return any(file_name in version.text(launch) for launch in version.paths(LAUNCH_SUFFIXES))
