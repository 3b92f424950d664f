"""Decide whether the sources of a node declare a parameter with the type that a launch file gives to it."""

from __future__ import annotations

from pathlib import Path

from linkwright.review.files.declared_types import declare_type
from linkwright.review.files.yaml_values import YamlValue
from linkwright.review.launches.default_names import find_package_folders
from linkwright.review.launches.outlines import Entry
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX

_SUFFIXES = (*CPP_SUFFIXES, PYTHON_SUFFIX)


def declares_type(entry: Entry, parameter: str, value: YamlValue, root: Path | None) -> bool:
    """Return whether the sources of a node declare a parameter with the type of a value, so that no other type works.

    Args:
        entry: the action that starts the node.
        parameter: the name of the parameter.
        value: the value that the launch file gives to it.
        root: the folder of the repository, which may have the sources; None if it is unknown.
    """
    folders = {} if root is None else find_package_folders(root)
    folder = folders.get(entry.name.partition("/")[0])
    if folder is None:
        return False
    files = (file for file in folder.rglob("*") if file.suffix in _SUFFIXES and file.is_file())
    return declare_type((file.read_text("utf-8", "replace") for file in files), parameter, value)
