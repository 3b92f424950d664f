"""Find descriptions that cannot be expanded, because a file that they always include is not well-formed."""

from __future__ import annotations

from linkwright.review.parts.missing_includes import resolve_include
from linkwright.review.parts.outline import INCLUDE, Outline, try_read_outline
from linkwright.review.versions import Version


def includes_malformed_file(version: Version, path: str, outline: Outline) -> bool:
    """Return whether a description includes a file of the repository that cannot be parsed, under no condition.

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
            included_path = None if file is None or not file.is_file() else version.relative(file)
            if file is None or included_path is None or included_path in visited:
                continue
            included = try_read_outline(file, version.overlay)
            if included is None:
                return True
            visited.add(included_path)
            pending.append((included_path, included))
    return False
