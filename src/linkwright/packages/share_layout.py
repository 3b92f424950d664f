"""The share folder of a package that is not built, laid out as its build would do it.

Most packages keep their files in the sources as they install them, and their source folder serves as the share folder.
Some do not: ``install(DIRECTORY description/urdf DESTINATION share/${PROJECT_NAME})``, ``glob('cfg/*')`` to ``config``.
For these a folder of links is made in the user's cache, with the installed files at their installed paths and
everything else of the sources. So a user of the share folder, a launch file with ``os.path.join`` too, finds
the files that would exist after a build. Files that need compiling are ours if we have them, see
`linkwright.packages.substituted`.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from linkwright.files.user_folders import SHARES
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages.substituted import substituted_files

if TYPE_CHECKING:
    from linkwright.packages.readers.installed_file import InstalledFile

_MARK = os.path.join("", "linkwright", SHARES, "")  # noqa: PTH118 - a part of the path as text


def share_of_sources(name: str, folder: Path) -> Path:
    """The share folder of a package in its sources: the source folder, or a folder of links into it.

    Where the links cannot be made (a full disk, Windows without the right to make links) it is the source folder too.

    Args:
        name: the package.
        folder: its source folder.
    """
    if _MARK in str(folder):  # it is one already: that of a launch file which was found here
        return folder
    moved = {path: file for path, file in _shared(name, folder) if path != file.source}
    moved |= substituted_files(name, folder)
    if not moved:
        return folder
    from linkwright.packages.link_folder import link_folder

    try:
        return link_folder(name, folder, moved)
    except OSError:
        return folder


def source_of(path: str) -> str:
    """The file of a package that a file in such a folder of links represents; any other path as it is."""
    return os.path.realpath(path) if _MARK in path else path


def _shared(name: str, folder: Path) -> Iterator[tuple[str, InstalledFile]]:
    """The files that a package installs into its share folder, by path. Some with an unchanged path are left out."""
    share = f"share/{name}/"
    with suppress(OSError, ValueError):
        for file in _installed(folder, share):
            if file.destination.startswith(share) and _is_own(file.source):
                yield file.destination[len(share) :], file


def _is_own(source: str) -> bool:
    """Whether a file is in the package. A page is not shown files that an untrusted package takes from elsewhere."""
    path = Path(os.path.normpath(source))
    return not path.is_absolute() and path.parts[:1] != (os.pardir,)


def _installed(folder: Path, share: str) -> Iterator[InstalledFile]:
    for build_file in ("CMakeLists.txt", "setup.py"):
        try:
            text = (folder / build_file).read_text(encoding="utf-8", errors="replace")
        except OSError:
            continue
        from linkwright.diagnostics import SourceText

        source = SourceText(str(folder / build_file), text)
        if build_file == "setup.py":
            from linkwright.packages.readers.setup_py import read_setup

            yield from read_setup(source).installed_files(folder)
            return
        from linkwright.packages.readers.cmake import read_cmake

        cmake = read_cmake(source, folder)
        hooks = set(cmake.hooks)  # they are read where a build is sourced
        yield from (file for file in cmake.moved(folder, share) if file.destination not in hooks)
        return
