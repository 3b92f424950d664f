"""Find out which nodes of launch files run a source."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError
from linkwright.packages.manifest import package_name
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.installed_paths import read_package_facts
from linkwright.review.launches.outlines import PROGRAM_KINDS, Entry, LaunchOutline
from linkwright.review.launches.programs.default_names import find_script
from linkwright.review.launches.programs.script_options import LAUNCH_SUFFIXES
from linkwright.review.launches.reading import read_outline
from linkwright.review.sources.names import CPP_SUFFIXES
from linkwright.review.versions import TEST_FOLDERS, Version


class SourcePrograms:
    """The programs that contain a source.

    Args:
        version: the version of the repository.
        path: the path of the source.
    """

    def __init__(self, version: Version, path: str) -> None:
        self._version = version
        self._path = path
        self._folder = version.package_of(path)
        self.package = None if self._folder is None else package_name(version.file(self._folder))

    def runs(self, node: str) -> bool:
        """Return whether a node certainly runs the source.

        Args:
            node: the package and the executable or the class of a component, such as ``arm/driver.py``.
        """
        package, _, name = node.partition("/")
        if not name or package != self.package:
            return False
        if not self._path.endswith(CPP_SUFFIXES):
            return find_script(self._version.root, node) == self._version.file(self._path)
        if "::" in name:
            class_name = re.escape(name.rpartition("::")[2])
            return re.search(rf"\b{class_name}::{class_name}\s*\(", self._version.text(self._path)) is not None
        return self._path in self._list_sources(name)

    def _list_sources(self, program: str) -> Iterator[str]:
        """Yield the paths of the sources of an executable, and of the libraries of the package that it links to."""
        facts = None if self._folder is None else read_package_facts(self._version, self._folder)
        names = {} if facts is None else facts.output_names
        pending = [target for target, name in names.items() if name == program] or [program]
        seen = set(pending)
        while facts is not None and pending:
            parts = facts.targets.get(pending.pop())
            for source in () if parts is None else parts.sources:
                yield (PurePosixPath(self._folder or "") / source).as_posix()
            libraries = () if parts is None else tuple(parts.libraries)
            pending += [library for library in libraries if library not in seen]
            seen.update(libraries)


def read_launch_files(version: Version, *words: str) -> Iterator[tuple[str, LaunchOutline]]:
    """Yield the launch files that contain one of several words, except tests, with their outlines."""
    for path in version.paths(LAUNCH_SUFFIXES):
        if TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts):
            text = version.text(path)
            outline = try_read_outline(version, path) if any(word in text for word in words) else None
            if outline is not None:
                yield path, outline


def try_read_outline(version: Version, path: str) -> LaunchOutline | None:
    """Return the outline of a launch file, or None if it cannot be read."""
    try:
        return read_outline(version.file(path), version.root)
    except (LinkwrightError, UnreadableFileError, OSError, ValueError, RecursionError):
        return None


def list_nodes(outline: LaunchOutline) -> list[Entry]:
    """Return the nodes that a launch file starts."""
    return [entry for entry in outline.entries if entry.kind in PROGRAM_KINDS]
