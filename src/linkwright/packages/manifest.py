"""The file ``package.xml``, which makes a folder a ROS package (REP 149).

Packages are searched as in colcon.
"""

from __future__ import annotations

import os
import re
from collections import deque
from collections.abc import Iterator
from pathlib import Path

from linkwright.loading.deferred import lazy_pattern

MANIFEST = "package.xml"
ROSBUILD_MANIFEST = "manifest.xml"
"""The manifest of a package of rosbuild, the build system before catkin."""

_COMMENT = lazy_pattern(r"<!--.*?-->", re.DOTALL)
_NAME = lazy_pattern(r"<package\b[^>]*>.*?<name>\s*([^<\s]+)\s*</name>", re.DOTALL)


def package_name(folder: Path) -> str | None:
    """Return the name in a folder's ``package.xml``, or None if it is missing.

    The name is found by a search through the text, without an XML parser: a search for packages reads many manifests,
    and a broken manifest must not stop the search.
    """
    try:
        text = (folder / MANIFEST).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return None
    match = _NAME.search(_COMMENT.sub("", text))
    return match.group(1) if match else None


def enclosing_package(path: Path) -> tuple[str, Path] | None:
    """Return the name and folder of the package that contains a file or folder, or None.

    The package is the nearest enclosing folder with a ``package.xml``.
    """
    for folder in (path, *path.parents):
        name = package_name(folder)
        if name is not None:
            return name, folder
    return None


IGNORE_MARKERS = frozenset({"COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE"})
SKIPPED_FOLDERS = frozenset({"build", "install", "log", "node_modules", "__pycache__", "site-packages"})

MAX_DEPTH = 8
MAX_FOLDERS = 3000


class SourceScan:
    """A lazy breadth-first search for packages below a folder.

    Folders nearer to the root come first, and siblings are sorted by name. A folder with a ``package.xml`` is a package
    and is not searched further. Hidden folders, build products and folders with an ignore marker are skipped. The
    search ends `MAX_DEPTH` levels below the root or after `MAX_FOLDERS` folders, so that a search that starts
    in a home folder does not read the whole disk.

    Attributes:
        root: the folder where the search starts.
        truncated: whether the search reached a limit before it had visited all folders.
        unnamed: the folders with a ``package.xml`` that does not contain a package name.
    """

    def __init__(self, root: Path) -> None:
        self.root = root
        self.truncated = False
        self.unnamed: list[Path] = []
        self._folders: dict[str, Path] = {}
        self._steps: Iterator[tuple[str, Path]] | None = self._walk()

    def find(self, name: str) -> Path | None:
        """Return the folder of a package, or None if it is not found.

        The search stops as soon as the package is found.
        """
        if name in self._folders:
            return self._folders[name]
        while self._advance():
            if name in self._folders:
                return self._folders[name]
        return None

    def packages(self) -> dict[str, Path]:
        """Return the folders of all packages below the root, by name.

        If several packages have the same name, the first one found is included.
        """
        while self._advance():
            pass
        return dict(self._folders)

    def _advance(self) -> bool:
        if self._steps is None:
            return False
        step = next(self._steps, None)
        if step is None:
            self._steps = None
            return False
        self._folders.setdefault(*step)
        return True

    def _walk(self) -> Iterator[tuple[str, Path]]:
        pending: deque[tuple[str, int]] = deque([(str(self.root), 0)])
        visited = 0
        while pending:
            if visited >= MAX_FOLDERS:
                self.truncated = True
                return
            folder, depth = pending.popleft()
            visited += 1
            files, folders = _list_folder(folder)
            if not IGNORE_MARKERS.isdisjoint(files):
                continue
            if MANIFEST in files:
                path = Path(folder)
                name = package_name(path)
                if name is not None:
                    yield name, path
                else:
                    self.unnamed.append(path)
                continue
            if depth == MAX_DEPTH:
                self.truncated = self.truncated or bool(folders)
                continue
            pending.extend((f"{folder}{os.sep}{entry}", depth + 1) for entry in folders)


def _list_folder(folder: str) -> tuple[set[str], list[str]]:
    """Return the names of the files in a folder, and the sorted names of subfolders to search."""
    files: set[str] = set()
    folders: list[str] = []
    try:
        with os.scandir(folder) as entries:
            for entry in entries:
                name = entry.name
                if entry.is_dir(follow_symlinks=True):
                    if not name.startswith(".") and name not in SKIPPED_FOLDERS and not _is_link_upwards(entry):
                        folders.append(name)
                else:
                    files.add(name)
    except OSError:
        pass
    folders.sort()
    return files, folders


def _is_link_upwards(entry: os.DirEntry[str]) -> bool:
    """Return whether a folder is a link to a folder that contains it.

    Following such a link would never end.
    """
    if not entry.is_symlink():
        return False
    link = Path(entry.path)
    target = link.resolve()
    parent = link.parent.resolve()
    return target == parent or target in parent.parents
