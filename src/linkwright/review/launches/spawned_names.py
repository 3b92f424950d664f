"""Tell the controllers that a spawner starts from other names in its arguments."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

from linkwright.packages.manifest import SKIPPED_FOLDERS
from linkwright.review.caching import cached_in_review
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.names import find_all_controllers
from linkwright.review.files.parameters.yaml_values import read_yaml_values
from linkwright.review.launches.outlines import Entry, LaunchOutline

_SUFFIXES = (".yaml", ".yml")
_FILE_NAME = re.compile(r"[\w.-]+\.ya?ml\b")
_CONTROLLER_MANAGER = "controller_manager/ros2_control_node"
_OWN_SETTINGS = re.compile(r"(?:^|[\s,\[])(?:-p|-t|--param-file|--controller-type)(?=[\s,\]]|$)")
"""The options with which a spawner gives a controller its type."""
_MAX_BYTES = 1 << 20


def is_other_group(name: str, root: Path | None) -> bool:
    """Return whether a name is certainly not a controller of ROS 1.

    Parameter files of the repository have a group of this name, and none gives it a type, without which a spawner
    cannot start a controller.

    Args:
        name: the name in the arguments of a spawner.
        root: the folder of the repository; None if it is unknown.
    """
    if root is None:
        return False
    groups, files = _read_groups(root)
    short_name = name.rpartition("/")[2]
    return short_name in groups and not any(short_name in controllers for controllers in files.values())


def is_unconfigured(name: str, entry: Entry, outline: LaunchOutline) -> bool:
    """Return whether a spawner of ROS 2 certainly cannot start a controller, because nothing gives it a type.

    The file starts the controller manager with parameter files of the repository that configure other controllers, and
    no parameter file of the repository has a group of this name.

    Args:
        name: the name in the arguments of the spawner.
        entry: the spawner.
        outline: the launch file.
    """
    if outline.root is None or _OWN_SETTINGS.search(entry.settings.get("arguments", "")):
        return False
    groups, files = _read_groups(outline.root)
    managers = [other for other in outline.entries if other.name == _CONTROLLER_MANAGER]
    texts = [outline.resolve(text) for manager in managers for text in manager.settings.values()]
    names = {file for text in texts for file in _FILE_NAME.findall(text)}
    is_known = bool(names) and all(files.get(file) for file in names)
    short_name = name.rpartition("/")[2]
    return is_known and short_name not in groups and not any(short_name in found for found in files.values())


@cached_in_review(maxsize=2)
def _read_groups(root: Path) -> tuple[frozenset[str], dict[str, frozenset[str]]]:
    """Return the groups of all parameter files below a folder, and the controllers by the names of the files.

    All names are without their namespaces.

    The result is cached because the folder does not change during a review.
    """
    groups: set[str] = set()
    controllers: dict[str, frozenset[str]] = {}
    for file in _find_files(root):
        try:
            if file.stat().st_size > _MAX_BYTES:
                continue
            values = read_yaml_values(file.read_text("utf-8", errors="replace"))
        except (OSError, UnreadableFileError):
            continue
        names = {name.rpartition("/")[2] for name in find_all_controllers(values)}
        controllers[file.name] = controllers.get(file.name, frozenset()) | names
        groups.update(group for path in values for group in path.split(".")[:-1])
    return frozenset(groups), controllers


def _find_files(root: Path) -> Iterator[Path]:
    for parent, folders, names in os.walk(root):
        folders[:] = [name for name in folders if not name.startswith(".") and name not in SKIPPED_FOLDERS]
        yield from (Path(parent, name) for name in names if name.endswith(_SUFFIXES))
