"""Find the files that descriptions include, and includes of files that do not exist."""

from __future__ import annotations

import os
import re
from pathlib import Path

from linkwright.review.parts.outline import INCLUDE
from linkwright.review.versions import Version
from linkwright.xmltree import Element

_PATH_IN_PACKAGE = re.compile(r"\$\(find\s+([\w-]+)\s*\)/+([^$]+)")


def has_missing_include(version: Version, path: str, root: Element) -> bool:
    """Return whether a file includes a file of the repository that does not exist, and none of another package.

    A file of another package, or one whose path is computed, may define any macro.
    """
    includes = [element for element in root.walk() if element.tag == INCLUDE]
    files = [resolve_include(version, path, element.attributes.get("filename", "").strip()) for element in includes]
    return None not in files and any(file is not None and not file.exists() for file in files)


def names_absent_package(version: Version, path: str, filename: str) -> bool:
    """Return whether an include names a file of a package that is not found."""
    match = _PATH_IN_PACKAGE.fullmatch(filename)
    return match is not None and version.share_of(match[1], version.file(path).parent) is None


def resolve_include(version: Version, path: str, filename: str) -> Path | None:
    """Return the file that an include names, or None if its path is computed or its package unknown."""
    folder = version.file(path).parent
    match = _PATH_IN_PACKAGE.fullmatch(filename)
    if match is not None:
        share = version.share_of(match[1], folder)
        return None if share is None else share / match[2]
    return None if "$" in filename or not filename else Path(os.path.normpath(folder / filename))
