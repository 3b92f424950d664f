"""Detect launch files that were converted to another format."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import PurePosixPath

from linkwright.files.git_repository import ChangedFile

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
