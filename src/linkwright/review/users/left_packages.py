"""Find the files that still use a package which only the old version has."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import PurePosixPath

from linkwright.packages.manifest import MANIFEST
from linkwright.review.files.build.cmake_files import CMAKE_FILE
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX
from linkwright.review.sources.used_packages import UsedPackages, get_package
from linkwright.review.users.old_dependencies import find_dependencies
from linkwright.review.versions import Version

_MARKUP_SUFFIXES = (".launch", ".xml", ".xacro", ".urdf", ".sdf", ".world", ".rviz", ".srdf")
_YAML_SUFFIXES = (".yaml", ".yml")
_SEARCHED_SUFFIXES = (
    *(MANIFEST, CMAKE_FILE, PYTHON_SUFFIX, *CPP_SUFFIXES),
    *(*_MARKUP_SUFFIXES, *_YAML_SUFFIXES),
)
_MARKUP_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_LINE_COMMENT = re.compile(r"#[^\n]*")
_REFERENCE = (
    r"\$\(find(?:-pkg-share|-pkg-prefix)?\s+{name}\s*\)|(?:package|model)://{name}/|"
    r"\b(?:get_package_\w+|FindPackage(?:Share|Prefix))\(\s*(?:package\w*\s*=\s*)?['\"]{name}['\"]|"
    r"\b(?:pkg|package)\s*[=:]\s*['\"]?{name}(?![\w.-])"
)
"""The forms in which launch files, descriptions and configurations name a package."""


def list_package_users(version: Version, name: str) -> list[str]:
    """Return the paths of the files that use a package: its dependents, build files, sources and launch files."""
    return [path for path in version.paths(_SEARCHED_SUFFIXES) if _uses(version, path, name)]


def _uses(version: Version, path: str, name: str) -> bool:
    text = version.text(path)
    if name not in text:
        return False
    if PurePosixPath(path).name in (MANIFEST, CMAKE_FILE):
        return any(True for _ in find_dependencies(version, path, {name}))
    if path.endswith((PYTHON_SUFFIX, *CPP_SUFFIXES)) and name in _read_packages(version, path):
        return True
    comment = _MARKUP_COMMENT if path.endswith(_MARKUP_SUFFIXES) else _LINE_COMMENT
    reference = _REFERENCE.replace("{name}", re.escape(name))
    return not path.endswith(CPP_SUFFIXES) and re.search(reference, comment.sub("", text)) is not None


def _read_packages(version: Version, path: str) -> Iterator[str]:
    packages = UsedPackages(version, version.package_of(path) or "", {})
    return map(get_package, packages.read_all(path))
