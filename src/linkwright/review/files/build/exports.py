"""Find packages of which other packages use nothing to build."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import PurePosixPath

from linkwright.review.files.build.cmake_files import CMAKE_FILE, read_cmake_facts
from linkwright.review.files.build.facts import UNSHARED_PACKAGES, FactKind
from linkwright.review.versions import Version

_EXPORTED_KINDS = frozenset(
    {
        *(FactKind.EXPORTED_TARGET, FactKind.EXPORTED_FOLDER, FactKind.EXPORTED_DEPENDENCY),
        *(FactKind.INTERFACE, FactKind.DYNAMIC, FactKind.MODULE),
    }
)
"""The kinds of facts with which other packages may be built, or that dependents get with the package.

A library without headers, such as a plugin, is only loaded.
"""
_EXPORTS = re.compile(
    r"^[^#\n]*(?:\b(?:ament_export_|ament_auto_package|rosidl_|generate_messages|install_python|ament_python_install)"
    r"|\b(?:CONFIG_EXTRAS|CFG_EXTRAS|generate_parameter_)"
    r"|\.cmake\b|\bEXPORT\b)|^[ \t]*install\s*\([^)]*\binclude\b",
    re.MULTILINE | re.IGNORECASE,
)
"""A command or file that may export something, which the facts may not show."""
_EXPORTED_DEPENDENCIES = re.compile(r"\bament_export_dependencies\s*\((?P<names>[^)]*)\)")
_AMENT_PACKAGE = re.compile(r"^[^#\n]*\bament_package\s*\(", re.MULTILINE)


def exports_nothing(version: Version, manifest: str) -> bool:
    """Return whether a package installs nothing with which other packages are built.

    With ament, others can neither link to a library nor include headers that the package does not export.

    Args:
        version: the version of the repository.
        manifest: the path of its ``package.xml`` relative to the root.
    """
    path = (PurePosixPath(manifest).parent / CMAKE_FILE).as_posix()
    texts = (_EXPORTED_DEPENDENCIES.sub(_blank_tools, text) for text in _read_build_files(version, manifest))
    if not version.file(path).is_file() or any(map(_EXPORTS.search, texts)):
        return False
    if _AMENT_PACKAGE.search(version.text(path)):
        return True
    facts = read_cmake_facts(version, path)
    is_known = not facts.unknown and not (facts.has_library and facts.targets)
    return is_known and not facts.header_paths and all(fact.kind not in _EXPORTED_KINDS for fact in facts.facts)


def _blank_tools(match: re.Match[str]) -> str:
    """Return a call that exports dependencies, or nothing if it only exports tools that each package names itself."""
    return "" if UNSHARED_PACKAGES.issuperset(match["names"].split()) else match[0]


def _read_build_files(version: Version, manifest: str) -> Iterator[str]:
    """Yield the texts of the CMake files of a package, including those of its folders."""
    for path in version.paths((CMAKE_FILE, ".cmake"), PurePosixPath(manifest).parent.as_posix()):
        yield version.text(path)
