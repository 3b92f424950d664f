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

_MAX_FILES = 5_000
_MAX_BYTES = 1_000_000
"""The size in bytes above which a file is skipped, because it holds data and no calls."""
_XML_SUFFIXES = (".launch.xml", "_launch.xml")
_YAML_SUFFIXES = (".launch.yaml", ".launch.yml", "_launch.yaml", "_launch.yml")
_LAUNCH_FOLDERS = ("launch", "test", "tests")
"""Folders in which any XML file may be a launch file."""
_CALL_MARKERS = ("xacro", "MoveItConfigsBuilder", "IncludeLaunchDescription", "<include", "include:")
"""The words of which any calling file contains at least one."""


class CallingFiles:
    """A cache of the files that call xacro, by package."""

    def __init__(self) -> None:
        self._read: dict[Path, tuple[CallingFile, ...]] = {}
        self._packages: dict[Path, dict[str, Path]] = {}
        self._manifests: dict[Path, str] = {}

    def nearby_calling_files(self, path: Path, folders: tuple[Path, ...]) -> Iterator[tuple[str | None, CallingFile]]:
        """Yield the calling files of a file's package and of packages that depend on it.

        Each file is paired with the name of its package, or None.

        Args:
            path: the absolute path of the file.
            folders: packages to search in addition to the packages nearby.
        """
        own_package = enclosing_package(path.parent)
        if own_package is None:
            yield from ((None, file) for file in self.of(path.parent))
            return
        name, folder = own_package
        yield from ((name, file) for file in self.of(folder))
        yield from self._other_calling_files(name, folder, folders, depending=True)

    def distant_calling_files(self, path: Path, folders: tuple[Path, ...]) -> Iterator[tuple[str | None, CallingFile]]:
        """Yield the calling files of packages that do not depend on a file's package.

        Each file is paired with the name of its package.

        Args:
            path: the absolute path of the file.
            folders: packages to search in addition to the packages nearby.
        """
        own_package = enclosing_package(path.parent)
        if own_package is not None:
            yield from self._other_calling_files(*own_package, folders, depending=False)

    def _other_calling_files(
        self, name: str, folder: Path, folders: tuple[Path, ...], *, depending: bool
    ) -> Iterator[tuple[str, CallingFile]]:
        """Yield the calling files of other packages, with the names of their packages.

        With `depending`, these packages depend on the package `name`; otherwise, they do not depend on it.
        """
        for other_name, other_folder in self._known_packages(folder, folders).items():
            if other_name != name and (name in self._read_manifest(other_folder)) is depending:
                yield from ((other_name, file) for file in self.of(other_folder))

    def of(self, folder: Path) -> tuple[CallingFile, ...]:
        """Return the calling files in and below a folder, except in nested packages."""
        if folder not in self._read:
            parsed_files = (_read_calls(path, folder) for path in _find_candidate_files(folder))
            self._read[folder] = tuple(
                calling_file
                for calling_file in parsed_files
                if calling_file and (calling_file.calls or calling_file.inclusions)
            )
        return self._read[folder]

    def _known_packages(self, folder: Path, folders: tuple[Path, ...]) -> dict[str, Path]:
        """Return the folders of the packages in the workspace and in additional folders, by name."""
        return {
            **self._neighboring_packages(folder),
            **{package[0]: folder for folder in folders if (package := enclosing_package(folder))},
        }

    def _neighboring_packages(self, folder: Path) -> dict[str, Path]:
        """Return the folders of packages next to a package or below the same ``src``, by name."""
        source_folder = next((parent for parent in folder.parents if parent.name == "src"), folder.parent)
        if source_folder not in self._packages:
            self._packages[source_folder] = SourceScan(source_folder).packages()
        return self._packages[source_folder]

    def _read_manifest(self, folder: Path) -> str:
        if folder not in self._manifests:
            self._manifests[folder] = _read_text(folder / MANIFEST) or ""
        return self._manifests[folder]


def _find_candidate_files(folder: Path) -> Iterator[Path]:
    count = 0
    for top, folders, names in os.walk(folder):
        directory = Path(top)
        if directory != folder and (MANIFEST in names or not IGNORE_MARKERS.isdisjoint(names)):
            folders.clear()
            continue
        folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in SKIPPED_FOLDERS)
        xml_suffixes = (".xml",) if directory.name in _LAUNCH_FOLDERS else _XML_SUFFIXES
        for name in sorted(names):
            if name == "CMakeLists.txt" or name.endswith((".py", ".launch", ".test", *xml_suffixes, *_YAML_SUFFIXES)):
                count += 1
                if count > _MAX_FILES:
                    return
                yield directory / name


def _read_calls(path: Path, package: Path) -> CallingFile | None:
    text = _read_text(path)
    if text is None or not any(word in text for word in _CALL_MARKERS):
        return None
    source = SourceText(str(path), text)
    if path.name == "CMakeLists.txt":
        from linkwright.packages.readers.xacro_calls.cmake import read_cmake_calls

        return read_cmake_calls(source, package) if "xacro" in text and path.parent == package else None
    if path.suffix == ".py":
        from linkwright.packages.readers.xacro_calls.python import read_python

        return read_python(source)
    from linkwright.packages.readers.xacro_calls.markup import read_xml, read_yaml

    return read_yaml(source) if path.name.endswith(_YAML_SUFFIXES) else read_xml(source)


def _read_text(path: Path) -> str | None:
    try:
        if not path.is_file() or path.stat().st_size > _MAX_BYTES:
            return None
        return decode(read_bytes(path), str(path))
    except (LinkwrightError, OSError):
        return None
