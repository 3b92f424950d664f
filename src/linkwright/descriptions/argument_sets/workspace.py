"""The files in packages that may call xacro, with a cache of the parsed files."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, SourceText
from linkwright.packages import MANIFEST, enclosing_package
from linkwright.packages.manifest import IGNORE_MARKERS, SKIPPED_FOLDERS, SourceScan
from linkwright.packages.readers.xacro_calls.call import CallingFile
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.reader import read_bytes

_MOST_FILES = 5_000
_LARGEST = 1_000_000
"""Larger files, in bytes, hold data and no calls."""
_MARKUP = (".launch.xml", "_launch.xml")
_YAML = (".launch.yaml", ".launch.yml", "_launch.yaml", "_launch.yml")
_LAUNCH_FOLDERS = ("launch", "test", "tests")
"""Folders whose XML files may be launch files whatever they are called."""
_WORDS = ("xacro", "MoveItConfigsBuilder", "IncludeLaunchDescription", "<include", "include:")
"""A file without any of these words calls nothing."""


class CallingFiles:
    """A cache of the files in packages that call xacro."""

    def __init__(self) -> None:
        self._read: dict[Path, tuple[CallingFile, ...]] = {}
        self._packages: dict[Path, dict[str, Path]] = {}
        self._manifests: dict[Path, str] = {}

    def around(self, path: Path, folders: tuple[Path, ...]) -> Iterator[tuple[str | None, CallingFile]]:
        """Yield the calling files of a file's package and of packages that depend on it.

        Each file is paired with the name of its package, or None.

        Args:
            path: the absolute path of the file.
            folders: packages to search in addition to those nearby.
        """
        own = enclosing_package(path.parent)
        if own is None:
            yield from ((None, file) for file in self.of(path.parent))
            return
        name, folder = own
        yield from ((name, file) for file in self.of(folder))
        yield from self._of_others(name, folder, folders, using=True)

    def elsewhere(self, path: Path, folders: tuple[Path, ...]) -> Iterator[tuple[str | None, CallingFile]]:
        """Yield the calling files of packages that do not depend on a file's package.

        Each file is paired with the name of its package.

        Args:
            path: the absolute path of the file.
            folders: packages to search in addition to those nearby.
        """
        own = enclosing_package(path.parent)
        if own is not None:
            yield from self._of_others(*own, folders, using=False)

    def _of_others(
        self, name: str, folder: Path, folders: tuple[Path, ...], *, using: bool
    ) -> Iterator[tuple[str, CallingFile]]:
        """Yield the calling files of other packages, with the names of their packages.

        With `using`, these are the packages that depend on the package `name`, otherwise those that do not.
        """
        for other, place in self._near(folder, folders).items():
            if other != name and (name in self._manifest(place)) is using:
                yield from ((other, file) for file in self.of(place))

    def of(self, folder: Path) -> tuple[CallingFile, ...]:
        """Return the calling files in and below a folder, except those of nested packages."""
        if folder not in self._read:
            read = (_read(path, folder) for path in _files(folder))
            self._read[folder] = tuple(
                calling_file
                for calling_file in read
                if calling_file and (calling_file.calls or calling_file.inclusions)
            )
        return self._read[folder]

    def _near(self, folder: Path, folders: tuple[Path, ...]) -> dict[str, Path]:
        """Return the folders of the packages in the workspace and in additional folders, by name."""
        return {
            **self._beside(folder),
            **{found[0]: folder for folder in folders if (found := enclosing_package(folder))},
        }

    def _beside(self, folder: Path) -> dict[str, Path]:
        """Return the folders of packages next to a package or below the same ``src``, by name."""
        above = next((parent for parent in folder.parents if parent.name == "src"), folder.parent)
        if above not in self._packages:
            self._packages[above] = SourceScan(above).packages()
        return self._packages[above]

    def _manifest(self, folder: Path) -> str:
        if folder not in self._manifests:
            self._manifests[folder] = _text(folder / MANIFEST) or ""
        return self._manifests[folder]


def _files(folder: Path) -> Iterator[Path]:
    count = 0
    for top, folders, names in os.walk(folder):
        place = Path(top)
        if place != folder and (MANIFEST in names or not IGNORE_MARKERS.isdisjoint(names)):
            folders.clear()
            continue
        folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in SKIPPED_FOLDERS)
        markup = (".xml",) if place.name in _LAUNCH_FOLDERS else _MARKUP
        for name in sorted(names):
            if name == "CMakeLists.txt" or name.endswith((".py", ".launch", ".test", *markup, *_YAML)):
                count += 1
                if count > _MOST_FILES:
                    return
                yield place / name


def _read(path: Path, package: Path) -> CallingFile | None:
    text = _text(path)
    if text is None or not any(word in text for word in _WORDS):
        return None
    source = SourceText(str(path), text)
    if path.name == "CMakeLists.txt":
        from linkwright.packages.readers.xacro_calls.cmake import read_cmake_calls

        return read_cmake_calls(source, package) if "xacro" in text and path.parent == package else None
    if path.suffix == ".py":
        from linkwright.packages.readers.xacro_calls.python import read_python

        return read_python(source)
    from linkwright.packages.readers.xacro_calls.markup import read_xml, read_yaml

    return read_yaml(source) if path.name.endswith(_YAML) else read_xml(source)


def _text(path: Path) -> str | None:
    try:
        if not path.is_file() or path.stat().st_size > _LARGEST:
            return None
        return decode(read_bytes(path), str(path))
    except (LinkwrightError, OSError):
        return None
