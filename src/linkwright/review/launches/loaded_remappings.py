"""Find the names that launch files give to the topics of the nodes which load a parameter file."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import PurePosixPath

from linkwright.review.launches.outlines import REMAPPING, Entry, LaunchOutline, without_condition
from linkwright.review.launches.programs.sources import list_nodes, read_launch_files
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.versions import Version


def find_loaded_remappings(version: Version, path: str) -> list[Mapping[str, str]]:
    """Return the remappings of each node that loads a parameter file, by name without the first slash.

    The result is empty if they are not known, as those of groups in Python.

    Args:
        version: the version of the repository.
        path: the path of the parameter file.
    """
    name = PurePosixPath(path).name
    pattern = re.compile(rf"(?<![\w.-]){re.escape(name)}(?![\w.])")
    found: list[Mapping[str, str]] = []
    for launch_file, outline in read_launch_files(version, name):
        nodes = [entry for entry in list_nodes(outline) if any(map(pattern.search, entry.settings.values()))]
        is_unknown = launch_file.endswith(PYTHON_SUFFIX) and any(entry.kind == "remapping" for entry in outline.entries)
        if not nodes or is_unknown:
            return []
        found += [_read_remappings(entry, outline) for entry in nodes]
    return found


def _read_remappings(entry: Entry, outline: LaunchOutline) -> dict[str, str]:
    """Return the remappings of a node and of the groups around it."""
    own = {
        without_condition(setting).removeprefix(REMAPPING): value
        for setting, value in entry.settings.items()
        if setting.startswith(REMAPPING)
    }
    names = {**dict(entry.remappings), **own}
    return {outline.resolve(name).strip("/"): outline.resolve(value).strip("/") for name, value in names.items()}
