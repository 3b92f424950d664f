"""Find included files that nothing used: they are not installed, and no file of the repository names them."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError
from linkwright.review.installed_paths import find_installed_paths
from linkwright.review.versions import Version

_USER_SUFFIXES = (
    *(".xacro", ".urdf", ".srdf", ".gazebo", ".macro", ".trans", ".inc", ".sdf", ".world"),
    *(".py", ".launch", ".xml", ".yaml", ".yml", ".cpp", ".hpp", ".sh"),
)
_SUBSTITUTION_END = re.compile(r".*[)}]")


def is_unused_part(version: Version, path: str) -> bool:
    """Return whether nothing could use a file of a description: it is neither installed nor named.

    Packages of ROS 1 also find files that are not installed.
    """
    package = version.package_of(path)
    try:
        is_installed = package is None or find_installed_paths(version, package, path) != frozenset()
    except LinkwrightError:
        return False
    if is_installed:
        return False
    name = PurePosixPath(path).name
    mention = re.compile(rf"[^\s\"'<>=,]*{re.escape(name)}(?![\w.-])")
    return not any(
        _may_name(match[0], path)
        for other in version.paths(_USER_SUFFIXES)
        if other != path
        for match in mention.finditer(version.text(other))
    ) and not _may_be_computed(version, path)


def _may_name(text: str, path: str) -> bool:
    """Return whether a text with the name of a file, such as ``$(find arm)/urdf/hand.xacro``, may mean a path."""
    rest = _SUBSTITUTION_END.sub("", text).lstrip("./")
    return f"/{path}".endswith(f"/{rest}")


def _may_be_computed(version: Version, path: str) -> bool:
    """Return whether an include with an expression in its name is near the file or names its folder."""
    folder = PurePosixPath(path).parent.name
    pattern = re.compile(rf"filename\s*=\s*[\"'][^\"']*/?{re.escape(folder)}/[^\"'/]*\$[^\"']*[\"']")
    return any(pattern.search(version.text(other)) for other in version.paths((".xacro", ".urdf")))
