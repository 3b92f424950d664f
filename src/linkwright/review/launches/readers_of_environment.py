"""The files of a version that read an environment variable, besides a launch file that does not any more."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

from linkwright.packages.manifest import SKIPPED_FOLDERS

_SUFFIXES = (".launch", ".xml", ".py", ".yaml", ".yml", ".xacro", ".urdf", ".cpp", ".hpp", ".h", ".c")
_READING = re.compile(r"(?:env|environ|getenv|environ\.get|EnvironmentVariable)\W{1,8}(?P<name>[A-Za-z_]\w*)")
_MAX_BYTES = 1 << 20


def reader_of(root: Path, name: str, excluded: str) -> str | None:
    """Return a file that reads an environment variable, relative to the root, or None if there is none.

    Args:
        root: the folder of the version.
        name: the name of the variable.
        excluded: the path of a file that is not searched, relative to the root.
    """
    return next((path for path in _readers(root).get(name, ()) if path != excluded), None)


@lru_cache(maxsize=2)
def _readers(root: Path) -> Mapping[str, list[str]]:
    """Return the files that read environment variables, by the name of the variable."""
    readers: dict[str, list[str]] = {}
    for folder, folders, names in os.walk(root):
        folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in SKIPPED_FOLDERS)
        for name in sorted(names):
            file = Path(folder, name)
            if not name.endswith(_SUFFIXES) or file.is_symlink() or file.stat().st_size > _MAX_BYTES:
                continue
            text = file.read_text("utf-8", errors="replace")
            for variable in {match["name"] for match in _READING.finditer(text)}:
                readers.setdefault(variable, []).append(file.relative_to(root).as_posix())
    return readers
