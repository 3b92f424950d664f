"""Files that are not among a package's sources because a program or a user makes them later."""

from __future__ import annotations

import re
from fnmatch import fnmatchcase
from functools import lru_cache
from pathlib import Path

from linkwright.loading.lean_patterns import lazy_pattern
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext

_IGNORE, _SUBMODULES = ".gitignore", ".gitmodules"
_REPOSITORY = ".git"
_HIGHEST = 8
"""So many folders above a file are looked at for a ``.gitignore`` where none of them is a repository's."""
_MAPS = frozenset({"map", "maps"})
_READABLE = (".py", ".sh", ".bash", ".md", ".rst", ".txt", ".cpp", ".cc", ".hpp", ".h", ".in")
_BUILD_FILES = frozenset({"setup.py", "CMakeLists.txt"})
_LONGEST = 200_000
_COMMENT = lazy_pattern(r"#.*")
_INSTALLS = lazy_pattern(r"\binstall\s*\([^)]*\)", re.IGNORECASE)
_MAKES = lazy_pattern(
    r"\bfile\s*\(\s*(?:DOWNLOAD|MAKE_DIRECTORY|WRITE|COPY|GENERATE|ARCHIVE_EXTRACT)\b"
    r"|\b(?:execute_process|configure_file|add_custom_command|add_custom_target|ExternalProject_\w+|FetchContent_\w+)\s*\(",
    re.IGNORECASE,
)


def is_made_later(package: PackageContext, path: str) -> bool:
    """Return whether a missing file of a package is probably made by a program or a user later.

    Such a file is ignored by git, made by CMake, a map (which mapping saves), or mentioned by another file of the
    package: a script that writes it, or a README that describes how to make it. Launch files do not count.

    Args:
        package: the package.
        path: the path of the file, relative to the package.
    """
    return (
        not _MAPS.isdisjoint(path.split("/")[:-1])
        or is_ignored_by_git(package.folder / path)
        or _is_built(package, path.rpartition("/")[2])
        or _is_mentioned(package, path.rpartition("/")[2])
    )


def is_ignored_by_git(path: Path) -> bool:
    """Return whether a ``.gitignore`` on the way to a file names it; a later line wins, as in git.

    Args:
        path: of the file, which need not exist; absolute.
    """
    answer = False
    for folder in _folders_upwards(path):
        relative = path.relative_to(folder).as_posix()
        for line in _lines(folder / _IGNORE):
            if _names(line.removeprefix("!"), relative):
                answer = not line.startswith("!")
    return answer


def submodule_of(path: Path) -> str | None:
    """Return the submodule of a Git repository that a file or folder is in, relative to the repository, or None.

    Args:
        path: of the file or folder, which need not exist; absolute.
    """
    for folder in _folders_upwards(path):
        for line in _lines(folder / _SUBMODULES):
            key, _, value = line.partition("=")
            if key.strip() == "path" and path.is_relative_to(folder / value.strip()):
                return value.strip()
    return None


@lru_cache(maxsize=256)
def _lines(path: Path) -> tuple[str, ...]:
    """The lines of a ``.gitignore`` or ``.gitmodules``, or none where there is no such file."""
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return ()
    return tuple(line for line in map(str.strip, lines) if line and not line.startswith("#"))


def _folders_upwards(path: Path) -> list[Path]:
    """The folders from that of a repository down to a file."""
    found = []
    for folder in list(path.parents)[:_HIGHEST]:
        found.append(folder)
        if (folder / _REPOSITORY).exists():
            break
    return found[::-1]


def _names(pattern: str, path: str) -> bool:
    """Whether a pattern of a ``.gitignore`` names a file, or a folder that it is in; both relative to its folder."""
    parts = path.split("/")
    above = ["/".join(parts[:count]) for count in range(1, len(parts) + 1)]
    if pattern.endswith("/"):
        pattern, above = pattern.rstrip("/"), above[:-1]
    if "/" not in pattern:
        return any(fnmatchcase(item.rpartition("/")[2], pattern) for item in above)
    pattern = pattern.lstrip("/").removeprefix("**/")
    return any(fnmatchcase(item, pattern) for item in above)


def _is_built(package: PackageContext, name: str) -> bool:
    """Return whether ``CMakeLists.txt`` has xacro expand a file to one of that name, or configures one."""
    source = package.text("CMakeLists.txt")
    made = re.escape(name)
    return source is not None and bool(
        re.search(rf"\bxacro_add_\w+\s*\([^)]*\b{made}(?:\.xacro)?\b", source.text)
        or re.search(rf"\bconfigure_file\s*\([^)]*\b{made}(?:\.in)?\b", source.text)
        or re.search(rf"\bOUTPUT\s[^)]*\b{made}\b", source.text)
    )


def is_made_by_cmake(package: PackageContext, path: str) -> bool:
    """Return whether ``CMakeLists.txt`` downloads, copies or generates files, and names a path besides installing it.

    Args:
        package: the package.
        path: of a file or folder that is not among the sources, relative to the package.
    """
    source = package.text("CMakeLists.txt")
    if source is None:
        return False
    text = _COMMENT.sub("", source.text)
    rest = _INSTALLS.sub("", text)
    return _MAKES.search(text) is not None and bool(re.search(rf"(?<![\w.-]){re.escape(path)}(?![\w.-])", rest))


def _is_mentioned(package: PackageContext, name: str) -> bool:
    if any(file.rpartition("/")[2] == name for file in package.files):
        return False  # the one that is there may be meant
    for file in package.files:
        if file.endswith(_READABLE) and file not in package.launch_files and file not in _BUILD_FILES:
            source = package.text(file)
            if source is not None and name in source.text[:_LONGEST]:
                return True
    return False
