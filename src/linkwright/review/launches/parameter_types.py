"""Decide whether a node accepts the type of the value that a launch file gives to a parameter."""

from __future__ import annotations

from pathlib import Path

from linkwright.review.files.parameters.declared_types import declare_type
from linkwright.review.files.parameters.yaml_values import YamlType, YamlValue
from linkwright.review.launches.outlines import Entry
from linkwright.review.launches.programs.default_names import find_package_folders
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX

_SUFFIXES = (*CPP_SUFFIXES, PYTHON_SUFFIX)


def accepts_type(entry: Entry, parameter: str, old: YamlValue, new: YamlValue, root: Path | None) -> bool:
    """Return whether a node accepts the type of a new value of a parameter, judging by its sources.

    Without the sources, it probably refused an integer that becomes the same number with a decimal point.

    Args:
        entry: the action that starts the node.
        parameter: the name of the parameter.
        old: the value that the old launch file gives to it.
        new: the value that the new launch file gives to it.
        root: the folder of the repository, which may have the sources; None if it is unknown.
    """
    folders = {} if root is None else find_package_folders(root)
    folder = folders.get(entry.name.partition("/")[0])
    if folder is None:
        is_double = (old.type, new.type) == (YamlType.INTEGER, YamlType.FLOAT) and not old.is_list and not new.is_list
        return is_double and "." in new.text and new.text.rstrip("0").removesuffix(".") == old.text
    files = (file for file in folder.rglob("*") if file.suffix in _SUFFIXES and file.is_file())
    return declare_type((file.read_text("utf-8", "replace") for file in files), parameter, new)
