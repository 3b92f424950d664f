"""Tell the controllers that a spawner starts from other names in its arguments."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from linkwright.packages.manifest import SKIPPED_FOLDERS
from linkwright.review.caching import cached_in_review
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameter_names import find_all_controllers
from linkwright.review.files.yaml_values import read_yaml_values

_SUFFIXES = (".yaml", ".yml")
_MAX_BYTES = 1 << 20


def is_other_group(name: str, root: Path | None) -> bool:
    """Return whether a name is certainly not a controller of ROS 1.

    Parameter files of the repository have a group of this name, and none gives it a type, without which a spawner
    cannot start a controller.

    Args:
        name: the name in the arguments of a spawner.
        root: the folder of the repository; None if it is unknown.
    """
    groups, controllers = _read_groups(root) if root is not None else (frozenset(), frozenset())
    short_name = name.rpartition("/")[2]
    return short_name in groups and short_name not in controllers


@cached_in_review(maxsize=2)
def _read_groups(root: Path) -> tuple[frozenset[str], frozenset[str]]:
    """Return the groups and the controllers of all parameter files below a folder, without their namespaces.

    The result is cached because the folder does not change during a review.
    """
    groups: set[str] = set()
    controllers: set[str] = set()
    for file in _find_files(root):
        try:
            if file.stat().st_size > _MAX_BYTES:
                continue
            values = read_yaml_values(file.read_text("utf-8", errors="replace"))
        except (OSError, UnreadableFileError):
            continue
        controllers.update(name.rpartition("/")[2] for name in find_all_controllers(values))
        groups.update(group for path in values for group in path.split(".")[:-1])
    return frozenset(groups), frozenset(controllers)


def _find_files(root: Path) -> Iterator[Path]:
    for parent, folders, names in os.walk(root):
        folders[:] = [name for name in folders if not name.startswith(".") and name not in SKIPPED_FOLDERS]
        yield from (Path(parent, name) for name in names if name.endswith(_SUFFIXES))
