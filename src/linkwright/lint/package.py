"""The ROS package that contains a description: its files and their references."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, SourceText
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages.manifest import SKIPPED_FOLDERS
from linkwright.xmltree import Document, Overlay, parse_file
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.reader import read_bytes

if TYPE_CHECKING:
    from linkwright.packages.readers.cmake import CMakeFile
    from linkwright.packages.readers.cmake_language import Command
    from linkwright.packages.readers.launch_files import LaunchFile
    from linkwright.packages.readers.package_xml import Manifest
    from linkwright.packages.readers.setup_py import SetupFile

MANIFEST = "package.xml"
_MAX_FILES = 20_000
_DESCRIPTION_SUFFIXES = (".xacro", ".urdf")


def find_package(
    path: Path, overlay: Overlay | None = None, cache: dict[Path, PackageContext] | None = None
) -> PackageContext | None:
    """Return the package that contains a file or folder, or None if there is none.

    Args:
        path: the file or folder.
        overlay: texts that replace the contents of files.
        cache: the cache of packages by folder, which is not used with an overlay.
    """
    path = path.absolute()
    for folder in (path, *path.parents):
        if (folder / MANIFEST).is_file():
            if overlay is not None or cache is None:
                return PackageContext(folder, overlay)
            return cache.get(folder) or cache.setdefault(folder, PackageContext(folder))
    return None


class PackageContext:
    """A ROS package, whose files are read on first use and never executed.

    The modules that read the files are also imported on first use, because the check of one robot needs few of them.

    Args:
        folder: the folder with the ``package.xml``.
        overlay: texts that replace the contents of files.

    Attributes:
        folder: the absolute path of the folder.
    """

    def __init__(self, folder: Path, overlay: Overlay | None = None) -> None:
        self.folder = folder.absolute()
        self._overlay = overlay

    @cached_property
    def _manifest(self) -> Manifest | LinkwrightError:
        from linkwright.packages.readers.package_xml import Manifest

        try:
            unsaved = None if self._overlay is None else self._overlay.document(str(self.folder / MANIFEST))
            return Manifest(unsaved or parse_file(self.folder / MANIFEST))
        except LinkwrightError as error:
            return error

    @property
    def manifest(self) -> Manifest | None:
        """The package's ``package.xml``, or None if it is not valid XML."""
        return None if isinstance(self._manifest, LinkwrightError) else self._manifest

    @property
    def manifest_error(self) -> LinkwrightError | None:
        """The error in the XML of the package's ``package.xml``, or None."""
        return self._manifest if isinstance(self._manifest, LinkwrightError) else None

    @property
    def name(self) -> str:
        """The name of the package, or the name of its folder if the manifest has none."""
        return (self.manifest and self.manifest.name) or self.folder.name

    @cached_property
    def files(self) -> tuple[str, ...]:
        """The sorted paths of all files in the package, without hidden files and build products."""
        return tuple(sorted(self._walk()))

    @cached_property
    def folders(self) -> frozenset[str]:
        """The paths of all folders with files in them or in subfolders, relative to the package."""
        paths: set[str] = set()
        for file in self.files:
            parts = file.split("/")[:-1]
            paths.update("/".join(parts[:count]) for count in range(1, len(parts) + 1))
        return frozenset(paths)

    def has(self, path: str) -> bool:
        """Return whether a file or folder exists at a path relative to the package."""
        return (self.folder / path).exists()

    def text(self, path: str) -> SourceText | None:
        """Return the text of a file of the package, or None if it cannot be read."""
        full_path = str(self.folder / path)
        unsaved = None if self._overlay is None else self._overlay.text(full_path)
        if unsaved is not None:
            return SourceText(full_path, unsaved)
        try:
            return SourceText(full_path, decode(read_bytes(full_path), full_path))
        except LinkwrightError:
            return None

    @cached_property
    def setup(self) -> SetupFile | None:
        """The package's ``setup.py``, or None if there is none or if CMake builds the package."""
        if self.manifest is not None and self.manifest.build_type == "ament_cmake" and self.has("CMakeLists.txt"):
            return None
        from linkwright.packages.readers.setup_py import read_setup

        source = self.text("setup.py")
        return None if source is None else read_setup(source)

    @cached_property
    def cmake(self) -> CMakeFile | None:
        """The package's ``CMakeLists.txt``, or None if there is none."""
        from linkwright.packages.readers.cmake import read_cmake

        source = self.text("CMakeLists.txt")
        return None if source is None else read_cmake(source, self.folder)

    @cached_property
    def cmake_commands(self) -> Sequence[Command]:
        """The commands of the package's ``CMakeLists.txt``; empty if there is none."""
        from linkwright.packages.readers.cmake_language import CMakeProgram

        source = self.text("CMakeLists.txt")
        return () if source is None else tuple(CMakeProgram(self.folder).run(source))

    @cached_property
    def launch_files(self) -> Mapping[str, LaunchFile]:
        """The package's Python launch files, by their paths relative to the package."""
        from linkwright.packages.readers.launch_files import is_launch_file, read_launch_file

        files_by_path = {}
        for file in self.files:
            if is_launch_file(file):
                source = self.text(file)
                if source is not None:
                    files_by_path[file] = read_launch_file(source, file)
        return files_by_path

    @cached_property
    def descriptions(self) -> Mapping[Path, Document]:
        """The package's unexpanded URDF and xacro files, by path, except files that are not XML."""
        from linkwright.xacro.cache import read_document

        documents: dict[Path, Document] = {}
        for file in self.files:
            if file.endswith(_DESCRIPTION_SUFFIXES):
                path = self.folder / file
                if not path.is_file():  # reading a named pipe would never end
                    continue
                try:
                    documents[path] = read_document(str(path))
                except LinkwrightError:
                    continue
        return documents

    def _walk(self) -> Iterator[str]:
        count = 0
        for top, folders, files in os.walk(self.folder):
            is_subfolder = Path(top) != self.folder
            folders[:] = [
                name
                for name in sorted(folders)
                if not name.startswith(".")
                and name not in SKIPPED_FOLDERS
                and not (Path(top) / name / MANIFEST).is_file()
            ]
            relative = Path(top).relative_to(self.folder).as_posix()
            for name in files:
                if name.startswith(".") or name.endswith(".pyc"):
                    continue
                count += 1
                if count > _MAX_FILES:
                    return
                yield f"{relative}/{name}" if is_subfolder else name
