"""``package.xml``: the file that makes a folder a ROS package (REP 149)."""

from __future__ import annotations

import re
from pathlib import Path

from linkwright.loading.lean_patterns import lazy_pattern

MANIFEST = "package.xml"

_COMMENT = lazy_pattern(r"<!--.*?-->", re.DOTALL)
_NAME = lazy_pattern(r"<package\b[^>]*>.*?<name>\s*([^<\s]+)\s*</name>", re.DOTALL)


def package_name(folder: Path) -> str | None:
    """The name in a folder's ``package.xml``; None if there is no such file or no name in it.

    The text is searched, not parsed: one broken manifest must not stop a search through a whole workspace,
    and a search reads many of them.
    """
    try:
        text = (folder / MANIFEST).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return None
    found = _NAME.search(_COMMENT.sub("", text))
    return found.group(1) if found else None


def enclosing_package(path: Path) -> tuple[str, Path] | None:
    """Name and folder of the package that contains a file or folder: the nearest ``package.xml`` upwards."""
    for folder in (path, *path.parents):
        name = package_name(folder)
        if name is not None:
            return name, folder
    return None
