"""Find packages of which other packages use nothing to build."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from linkwright.review.files.build_facts import FactKind
from linkwright.review.files.cmake_files import CMAKE_FILE, read_cmake_facts
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
    r"^[^#\n]*(?:\b(?:ament_export_|ament_auto_package|rosidl_|generate_messages|install_python|CONFIG_EXTRAS|CFG_EXTRAS)"
    r"|\.cmake\b)|^[ \t]*install\s*\([^)]*\binclude\b",
    re.MULTILINE | re.IGNORECASE,
)
"""A command or file that may export something, which the facts may not show."""


def exports_nothing(version: Version, manifest: str) -> bool:
    """Return whether a package installs nothing with which other packages are built.

    It only builds programs, plugins, and libraries without headers.

    Args:
        version: the version of the repository.
        manifest: the path of its ``package.xml`` relative to the root.
    """
    path = (PurePosixPath(manifest).parent / CMAKE_FILE).as_posix()
    if not version.file(path).is_file() or _EXPORTS.search(version.text(path)):
        return False
    facts = read_cmake_facts(version, path)
    return (
        not facts.unknown and not facts.header_paths and all(fact.kind not in _EXPORTED_KINDS for fact in facts.facts)
    )
