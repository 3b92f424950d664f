"""Find sources in C++ that no target of their package builds."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from linkwright.review.caching import cached_in_review
from linkwright.review.files.build.cmake_files import CMAKE_FILE
from linkwright.review.installed_paths import is_exported_header, read_package_facts
from linkwright.review.sources.cpp.text import blank_comments
from linkwright.review.sources.names import CPP_SUFFIXES, HEADER_SUFFIXES, NameKind
from linkwright.review.sources.reading import read_source_names
from linkwright.review.versions import TEST_FOLDERS, Version

_METHOD = re.compile(r"\b(\w+)\s*::\s*~?\w+\s*\([^;{}]*\)[^;{}()]*\{")
_CMAKE_COMMENT = re.compile(r"#[^\n]*")
_OTHER_TOOLS = (
    "Makefile",
    "makefile",
    "GNUmakefile",
    "meson.build",
    "BUILD",
    "BUILD.bazel",
    "platformio.ini",
    ".ino",
    ".pro",
)
"""The names, and the ends of names, of files with which other tools than CMake build the sources beside and below."""


@cached_in_review(maxsize=256)
def is_unbuilt(version: Version, package: str, path: str) -> bool:
    """Return whether no target builds a source, as far as the build files tell.

    A file that names it only in a comment, such as ``# add_executable(arm src/arm.cpp)``, does not build it.

    Args:
        version: the version that contains the source.
        package: the folder of its package.
        path: the path of the source.
    """
    pure_path = PurePosixPath(path)
    is_source = pure_path.suffix in CPP_SUFFIXES and pure_path.suffix not in HEADER_SUFFIXES
    if not is_source or not TEST_FOLDERS.isdisjoint(pure_path.parts):
        return False
    facts = read_package_facts(version, package)
    if facts is None:
        return False
    word = re.compile(rf"(?<![\w.-]){re.escape(pure_path.name)}(?![\w.-])")
    if facts.has_unknown_sources and not word.search(version.text(f"{package}/{CMAKE_FILE}".lstrip("/"))):
        return False
    sources = {source for parts in facts.targets.values() for source in parts.sources}
    own = pure_path.relative_to(package)
    if not sources or any(own.is_relative_to(source) for source in sources):
        return False
    others = version.paths((CMAKE_FILE, ".cmake", *_OTHER_TOOLS, *CPP_SUFFIXES), package)
    return not any(
        word.search(_read_code(version, other)) or _builds_below(other, package, pure_path)
        for other in others
        if other != path
    )


def _read_code(version: Version, path: str) -> str:
    """Return the text of a file, of those of CMake without comments."""
    text = version.text(path)
    return _CMAKE_COMMENT.sub("", text) if path.endswith((CMAKE_FILE, ".cmake")) else text


def _builds_below(tool_file: str, package: str, path: PurePosixPath) -> bool:
    """Return whether another tool than CMake builds the folder of a source, below that of the package."""
    folder = PurePosixPath(tool_file).parent
    is_own = tool_file.endswith(_OTHER_TOOLS) and folder != PurePosixPath(package)
    return is_own and path.is_relative_to(folder)


def find_exported_class(version: Version, package: str, path: str) -> str | None:
    """Return a class of which a source has methods and that an exported header of the package declares; or None."""
    methods = set(_METHOD.findall(blank_comments(version.text(path))))
    for header in version.paths(tuple(HEADER_SUFFIXES), package) if methods else ():
        if is_exported_header(version, package, header):
            names = read_source_names(version.file(header)).of_kind(NameKind.CLASS)
            found = next((item.name for item in names if item.name in methods), None)
            if found is not None:
                return found
    return None
