"""Launch files that a range of commits writes in another format."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path, PurePosixPath

from linkwright.files.git_repository import ChangedFile
from linkwright.packages.launch_files import is_launch_file_name

_LAUNCH_ROOT = re.compile(rb"\s*(<\?[^>]*>\s*)?(<!--(?:[^-]|-(?!->))*-->\s*)*<launch[\s>]")
_SUFFIX = re.compile(r"[._]launch(\.(py|xml|ya?ml))?$")


def with_other_formats(files: Sequence[ChangedFile]) -> list[ChangedFile]:
    """Return changed files in which a removed launch file and an added one in another format are a renamed file.

    Git recognizes renamed files by their texts, which have nothing in common in Python, XML and YAML.
    """
    added = {_key(file.new_path): file for file in files if file.new_path and not file.old_path}
    result: list[ChangedFile] = []
    joined: set[str] = set()
    for file in files:
        other = added.get(_key(file.old_path)) if file.old_path and not file.new_path else None
        if other is not None and other.new_path and _SUFFIX.search(other.new_path) and other.new_path not in joined:
            joined.add(other.new_path)
            result.append(ChangedFile(file.old_path, other.new_path))
        else:
            result.append(file)
    return [file for file in result if file.old_path or file.new_path not in joined]


def _key(path: str | None) -> tuple[str, str]:
    """Return the folder of a launch file and its name without its format; empty names for other files."""
    pure_path = PurePosixPath(path or "")
    if not _SUFFIX.search(pure_path.name):
        return "", ""
    return str(pure_path.parent), _SUFFIX.sub("", pure_path.name)


def is_launch_file(path: str) -> bool:
    """Return whether the path is that of a launch file of ROS 1 or ROS 2."""
    return path.endswith(".launch") or is_launch_file_name(path)


def is_launch_xml(file: Path) -> bool:
    """Return whether an XML file has the root of a launch file, as files that others include may have."""
    try:
        return file.suffix == ".xml" and _LAUNCH_ROOT.match(file.read_bytes()) is not None
    except OSError:
        return False


def is_launch_yaml(file: Path) -> bool:
    """Return whether a YAML file has the key of a launch file. Other files also have such names."""
    try:
        return re.search(rb"(?m)^launch[ \t]*:", file.read_bytes()) is not None
    except OSError:
        return False
