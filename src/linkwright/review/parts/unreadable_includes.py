"""Find descriptions that cannot be expanded, because a file that they always include is missing or not well-formed."""

from __future__ import annotations

from pathlib import Path

from linkwright.review.parts.missing_includes import resolve_include
from linkwright.review.parts.outline import INCLUDE, Outline, try_read_outline
from linkwright.review.versions import Version

_SUFFIXES = (".xacro", ".urdf", ".xml")
_OPTIONAL = "optional"
"""The attribute of an include whose file may be missing."""


def includes_unreadable_file(version: Version, path: str, outline: Outline) -> bool:
    """Return whether a description includes a file of the repository that is missing or malformed, under no condition.

    Args:
        version: the version of the repository.
        path: the path of the description.
        outline: its outline.
    """
    visited, pending = {path}, [(path, outline)]
    while pending:
        includer, current = pending.pop()
        for element in current.root.elements():
            if element.tag != INCLUDE:
                continue
            file = resolve_include(version, includer, element.attributes.get("filename", "").strip())
            if file is not None and _is_missing(version, file) and _OPTIONAL not in element.attributes:
                return True
            included_path = None if file is None or not file.is_file() else version.relative(file)
            if file is None or included_path is None or included_path in visited:
                continue
            included = try_read_outline(file, version.overlay)
            if included is None:
                return True
            visited.add(included_path)
            pending.append((included_path, included))
    return False


def _is_missing(version: Version, file: Path) -> bool:
    """Return whether a file of the repository does not exist, and the build certainly does not make or move it."""
    if file.exists() or version.relative(file) is None or "*" in file.name or not file.name.endswith(_SUFFIXES):
        return False
    if not file.parent.is_dir() or not any(file.parent.iterdir()):
        return False  # the folder may be a submodule
    names = (file.name, f"{file.name}.in", f"{file.name}.em", f"{file.name}.j2")
    return not any(version.paths(names))
