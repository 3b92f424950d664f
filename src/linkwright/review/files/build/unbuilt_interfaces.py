"""Tell whether the build file of a package certainly does not build an interface."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError
from linkwright.review.caching import cached_in_review
from linkwright.review.files.build.cmake_files import CMAKE_FILE, read_cmake_facts
from linkwright.review.files.build.facts import FactKind
from linkwright.review.versions import Version

_COMMENT = re.compile(r"#[^\n]*")
_SEARCH = re.compile(r"\bGLOB(?:_RECURSE)?\b", re.IGNORECASE)
_GENERATOR = re.compile(
    r"\w*(?:interface|message|service|action|rosidl_gen|gen(?:msg|srv))\w*\s*\(|\binclude\s*\(|\.(?:msg|srv|action|idl)\b",
    re.IGNORECASE,
)
"""Commands that may build interfaces, and those that read a file with such commands."""


def is_unbuilt(version: Version, path: str) -> bool:
    """Return whether the ``CMakeLists.txt`` of a package certainly does not build an interface.

    It is not certain if the file finds interfaces by patterns or has the name in any form. A file that lists no
    interface must also have no command that builds some.

    Args:
        version: the version of the repository.
        path: the path of the interface.
    """
    package = version.package_of(path)
    if package is None:
        return False
    build_file = f"{package}/{CMAKE_FILE}".lstrip("/")
    name = PurePosixPath(path).stem
    if not version.file(build_file).is_file():
        return False
    built_names = _read_built_names(version, build_file)
    text = _COMMENT.sub("", version.text(build_file))
    if name in built_names or (not built_names and _GENERATOR.search(text) is not None):
        return False
    has_name = re.search(rf"(?<!\w){re.escape(name)}(?!\w)", text) is not None
    return not has_name and _SEARCH.search(text) is None


@cached_in_review(maxsize=256)
def _read_built_names(version: Version, build_file: str) -> frozenset[str]:
    """Return the names of the interfaces that a build file certainly builds, without folders."""
    try:
        facts = read_cmake_facts(version, build_file).facts
    except (LinkwrightError, OSError, ValueError, RecursionError):
        return frozenset()
    return frozenset(PurePosixPath(fact.name).stem for fact in facts if fact.kind is FactKind.INTERFACE)
