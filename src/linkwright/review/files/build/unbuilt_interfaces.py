"""Tell whether the build files of a package certainly do not build an interface."""

from __future__ import annotations

import re
from fnmatch import fnmatchcase
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError
from linkwright.review.caching import cached_in_review
from linkwright.review.files.build.cmake_files import CMAKE_FILE, read_cmake_facts
from linkwright.review.files.build.facts import FactKind
from linkwright.review.files.build.setup_files import SETUP_FILE
from linkwright.review.versions import Version

_COMMENT = re.compile(r"#[^\n]*")
_SEARCH = re.compile(r"\bGLOB(?:_RECURSE)?\b(?P<words>[^)]*)", re.IGNORECASE)
_VARIABLE = re.compile(r"\$\w*\{[^}]*\}")
_GENERATOR = re.compile(
    r"\b(?!(?:message|generate_messages|ament_export_interfaces)\s*\()"
    r"\w*(?:interface|message|service|action|rosidl_gen|gen(?:msg|srv))\w*\s*\("
    r"|\binclude\s*\(\s*(?!(?:GNUInstallDirs|CMake\w+|Check\w+|CTest|ExternalProject|FetchContent)\s*\))"
    r"|\.(?:msg|srv|action|idl)\b",
    re.IGNORECASE,
)
"""Commands that may build interfaces, and those that read another file with such commands.

``generate_messages`` builds only what other commands list.
"""
_SETUP_GENERATOR = re.compile(r"rosidl|gen(?:msg|srv|py|_py|erate)|\b(?:msg|srv|action|idl)\b")
"""The words of a ``setup.py`` that may build interfaces."""
_READER = re.compile(r"\.(?:msg|srv|action)[\"']")
"""The end of a name in Python with which a program may read definitions itself."""


def is_unbuilt(version: Version, path: str) -> bool:
    """Return whether the build files of a package certainly do not build an interface.

    It is not certain if they find interfaces by a pattern that the name matches, or have the name in any form. If none
    of them lists an interface, they must also have no command that builds some.

    Args:
        version: the version of the repository.
        path: the path of the interface.
    """
    package = version.package_of(path)
    if package is None:
        return False
    file = PurePosixPath(path)
    build_file = f"{package}/{CMAKE_FILE}".lstrip("/")
    if not version.file(build_file).is_file():
        return file.suffix != ".idl" and _is_python_without_interfaces(version, package)
    built_names = _read_built_names(version, build_file)
    text = _read_build_files(version, package)
    if file.stem in built_names or (not built_names and _GENERATOR.search(text) is not None):
        return False
    has_name = re.search(rf"(?<!\w){re.escape(file.stem)}(?!\w)", text) is not None
    return not has_name and not any(_finds(match["words"], file.name) for match in _SEARCH.finditer(text))


@cached_in_review(maxsize=256)
def _is_python_without_interfaces(version: Version, package: str) -> bool:
    """Return whether a package of Python, which has no file of CMake, neither builds nor reads definitions."""
    setup = version.text(f"{package}/{SETUP_FILE}".lstrip("/"))
    if not setup or _SETUP_GENERATOR.search(setup) is not None or _read_build_files(version, package):
        return False
    return all(_READER.search(version.text(path)) is None for path in version.paths((".py",), package))


def _finds(words: str, name: str) -> bool:
    """Return whether a search of CMake may find a file with a name.

    Args:
        words: the variable and the patterns of the search.
        name: the name of the file without its folder.
    """
    patterns = _VARIABLE.sub("*", words).replace('"', " ").split()
    return any(fnmatchcase(name, PurePosixPath(pattern).name) for pattern in patterns)


@cached_in_review(maxsize=256)
def _read_build_files(version: Version, package: str) -> str:
    """Return the text of all files of CMake in a package, without comments."""
    paths = version.paths((CMAKE_FILE, ".cmake"), package)
    return _COMMENT.sub("", "\n".join(version.text(path) for path in paths))


@cached_in_review(maxsize=256)
def _read_built_names(version: Version, build_file: str) -> frozenset[str]:
    """Return the names of the interfaces that a build file certainly builds, without folders."""
    try:
        facts = read_cmake_facts(version, build_file).facts
    except (LinkwrightError, OSError, ValueError, RecursionError):
        return frozenset()
    return frozenset(PurePosixPath(fact.name).stem for fact in facts if fact.kind is FactKind.INTERFACE)
