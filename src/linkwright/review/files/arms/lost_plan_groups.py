"""Tell which planning groups the semantic descriptions of a package have lost.

Settings of a lost group, such as its kinematics, break nothing more than the loss of the group itself.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import PurePosixPath

from linkwright.review.versions import Version, Versions

_SUFFIXES = (".srdf", ".srdf.xacro")
_NAMING_SUFFIXES = (".launch", ".py", ".xml", ".yaml", ".xacro", ".srdf", ".setup_assistant")
"""The ends of the names of files that may name a semantic description. One that none names is a copy."""
_GROUP = re.compile(r"<group\s+name\s*=\s*[\"']([^\"']+)[\"']")
_FAKE_CONTROLLER = re.compile(r"fake_(?P<group>.+)_controller")
"""The name that MoveIt's assistant gives to the fake controller of a group."""


def is_of_lost_group(versions: Versions, path: str, part: str) -> bool:
    """Return whether a part of a file sets something of a planning group that the descriptions of its package lost.

    Args:
        versions: the repository before and after the change.
        path: the path of the file in the new version.
        part: the path of the part, such as ``arm.kinematics_solver`` or ``controller_list[fake_arm_controller]``.
    """
    name = re.split(r"[.\[\]]", part.partition("controller_list[")[2] or part, maxsplit=1)[0]
    fake = _FAKE_CONTROLLER.fullmatch(name)
    group = name if fake is None else fake["group"]
    folder = versions.new.package_of(path) or ""
    changed = {file.old_path for file in versions.changed_files}
    old_paths = [path for path in versions.old.paths(_SUFFIXES, folder) if path in changed]
    if group not in _read_groups(versions.old, old_paths):
        return False
    texts = [versions.new.text(path) for path in versions.new.paths(_NAMING_SUFFIXES, folder)]
    used = (
        path
        for path in versions.new.paths(_SUFFIXES, folder)
        if any(PurePosixPath(path).name in text for text in texts)
    )
    kept = [path for path in versions.new.paths(_SUFFIXES, folder) if path in changed]
    return group not in _read_groups(versions.new, [*used, *kept])


def _read_groups(version: Version, paths: Iterable[str]) -> set[str]:
    return {group for path in paths for group in _GROUP.findall(version.text(path))}
