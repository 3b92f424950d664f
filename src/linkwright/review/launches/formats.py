"""Detect launch files that were converted to another format."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path, PurePosixPath

from linkwright.files.git_repository import ChangedFile
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.review.versions import Version

_LAUNCH_ROOT_TAG = re.compile(rb"\s*(<\?[^>]*>\s*)?(<!--(?:[^-]|-(?!->))*-->\s*)*<launch[\s>]")
_LAUNCH_FUNCTION = re.compile(rb"^def generate_launch_description\b|^def generate_test_description\b", re.MULTILINE)
_XML_SUFFIXES = (".xml", ".test")
_SUFFIXES = (".launch", *_XML_SUFFIXES, ".py", ".yaml", ".yml")
_MAX_BYTES = 1 << 20
_LAUNCH_SUFFIX = re.compile(r"[._]launch(\.(py|xml|ya?ml))?$")


def join_format_changes(files: Sequence[ChangedFile]) -> list[ChangedFile]:
    """Return the changed files, with a converted launch file as one renamed file.

    Git recognizes renamed files by their text. Launch files in Python, XML and YAML have little text in common.
    """
    added = {_name_without_format(file.new_path): file for file in files if file.new_path and not file.old_path}
    result: list[ChangedFile] = []
    matched_paths: set[str] = set()
    for file in files:
        counterpart = added.get(_name_without_format(file.old_path)) if file.old_path and not file.new_path else None
        if (
            counterpart is not None
            and counterpart.new_path
            and _LAUNCH_SUFFIX.search(counterpart.new_path)
            and counterpart.new_path not in matched_paths
        ):
            matched_paths.add(counterpart.new_path)
            result.append(ChangedFile(file.old_path, counterpart.new_path))
        else:
            result.append(file)
    return [file for file in result if file.old_path or file.new_path not in matched_paths]


def _name_without_format(path: str | None) -> tuple[str, str]:
    """Return the folder of a launch file and its name without the format.

    Other files give two empty strings.
    """
    pure_path = PurePosixPath(path or "")
    if not _LAUNCH_SUFFIX.search(pure_path.name):
        return "", ""
    return str(pure_path.parent), _LAUNCH_SUFFIX.sub("", pure_path.name)


def is_launch_file(path: str) -> bool:
    """Return whether a path is a launch file of ROS 1 or ROS 2."""
    return path.endswith(".launch") or is_launch_file_name(path)


def is_launch_xml(file: Path) -> bool:
    """Return whether the root of an XML file is ``<launch>``.

    Included files may have any name.
    """
    try:
        return file.suffix in _XML_SUFFIXES and _LAUNCH_ROOT_TAG.match(file.read_bytes()) is not None
    except OSError:
        return False


def is_launch_yaml(file: Path) -> bool:
    """Return whether a YAML file has the top-level key ``launch``.

    Included files may have any name.
    """
    try:
        return re.search(rb"(?m)^launch[ \t]*:", file.read_bytes()) is not None
    except OSError:
        return False


@lru_cache(maxsize=8)
def find_launch_files(version: Version) -> tuple[str, ...]:
    """Return the paths of all launch files of a version: by their names, or by their contents."""
    return tuple(path for path in version.paths(_SUFFIXES) if is_launch_file(path) or _contains_actions(version, path))


def _contains_actions(version: Version, path: str) -> bool:
    """Return whether a file is a launch file by its contents, which may have any name."""
    file = version.file(path)
    try:
        if file.stat().st_size > _MAX_BYTES:
            return False
        if file.suffix == ".py":
            return _LAUNCH_FUNCTION.search(file.read_bytes()) is not None
    except OSError:
        return False
    return is_launch_yaml(file) if file.suffix in (".yaml", ".yml") else is_launch_xml(file)
