"""Search the unchanged sources of a package for names."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from functools import cached_property
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.packages.manifest import MANIFEST, ROSBUILD_MANIFEST
from linkwright.review.files.build.cmake_files import CMAKE_FILE
from linkwright.review.installed_paths import find_python_packages, read_package_facts
from linkwright.review.sources.cpp.text import blank_comments
from linkwright.review.sources.names import (
    CPP_SUFFIXES,
    HEADER_SUFFIXES,
    PYTHON_SUFFIX,
    NameKind,
    SourceName,
    SourceNames,
)
from linkwright.review.sources.reading import read_source_names
from linkwright.review.versions import TEST_FOLDERS, Version

_SOURCE_SEARCH = re.compile(r"\bGLOB(?:_RECURSE)?\b|\baux_source_directory\b", re.IGNORECASE)
"""The commands of CMake that find sources by patterns."""
_PYTHON_COMMENT = re.compile(r"#.*")
_UNDECLARED = re.compile(r"\b(?:allow_undeclared_parameters|automatically_declare_parameters_from_overrides)\b")
"""The options of nodes whose parameters need no declaration."""
_LAUNCH_IMPORT = re.compile(r"^\s*from\s+launch(?:_ros)?(?:\.\w+)*\s+import\b", re.MULTILINE)
_NODE_IMPORT = re.compile(r"^\s*(?:from|import)\s+(?:rclpy|rospy)\b", re.MULTILINE)
_COUNTERPARTS = {
    NameKind.PUBLISHER: NameKind.SUBSCRIPTION,
    NameKind.SUBSCRIPTION: NameKind.PUBLISHER,
    NameKind.SERVICE: NameKind.CLIENT,
    NameKind.CLIENT: NameKind.SERVICE,
    NameKind.ACTION: NameKind.ACTION_CLIENT,
    NameKind.ACTION_CLIENT: NameKind.ACTION,
}
"""The kind of name at the other end of a topic, service or action."""


class UnchangedSources:
    """The unchanged sources of a package, without tests, launch files, their helper modules and unbuilt copies.

    Args:
        version: the version of the repository.
        package: the folder of the package; None for the sources outside of packages.
        changed: the paths of the changed sources.
    """

    def __init__(self, version: Version, package: str | None, changed: Collection[str]) -> None:
        self._version = version
        self._package = package
        self._changed = changed
        self._names: dict[str, SourceNames] = {}

    def has_text(self, name: str) -> bool:
        """Return whether one of the sources contains a text in quotation marks."""
        return any(True for _ in self._find_paths(name))

    def find_undeclared_reader(self, name: str) -> str | None:
        """Return a source that gets a parameter of ROS 2 although no source of the package may declare it, or None.

        Args:
            name: the name of a parameter that no changed source has.
        """
        texts = {
            path: blank_comments(text) if path.endswith(CPP_SUFFIXES) else _PYTHON_COMMENT.sub("", text)
            for path, text in ((path, self._texts[path]) for path in self._find_paths(name))
        }
        quoted = re.compile(rf"[\"']{re.escape(name)}[\"']")
        getting = re.compile(rf"\bget_parameter\s*\(\s*{quoted.pattern}\s*\)")
        counts = {path: (len(quoted.findall(text)), len(getting.findall(text))) for path, text in texts.items()}
        is_declared = any(mentions > gets for mentions, gets in counts.values())
        if is_declared or any(map(_UNDECLARED.search, self._texts.values())):
            return None
        return next((path for path, (mentions, _) in counts.items() if mentions), None)

    def has_name(self, item: SourceName) -> bool:
        """Return whether one of the sources has a name of the same kind."""
        paths = self._find_paths(item.name)
        return any(item.name == other.name for path in paths for other in self._read_names(path, item.kind))

    def list_owners(self, item: SourceName) -> dict[str, SourceNames]:
        """Return the sources that have a name of the same kind, or contain the text of a parameter, by path."""
        owners = {}
        for path in self._find_paths(item.name):
            names = list(self._read_names(path, item.kind))
            if item.kind is NameKind.PARAMETER or any(item.name == other.name for other in names):
                owners[path] = self._names[path]
        return owners

    def find_user(self, item: SourceName) -> str | None:
        """Return the path of a source that uses the other end of a name, or None."""
        kind = _COUNTERPARTS[item.kind]
        names = dict.fromkeys((item.name, item.name.lstrip("/"), f"/{item.name}"))
        paths = (path for name in names for path in self._find_paths(name))
        return next(
            (path for path in paths if any(is_same_topic(item, other) for other in self._read_names(path, kind))), None
        )

    def list_sources(self, *texts: str) -> Iterator[tuple[str, SourceNames]]:
        """Yield the paths and names of the sources that contain one of several texts."""
        for path, content in self._texts.items():
            if any(text in content for text in texts):
                self._read_names(path, NameKind.NODE)
                yield path, self._names[path]

    def _read_names(self, path: str, kind: NameKind) -> Iterator[SourceName]:
        if path not in self._names:
            self._names[path] = read_source_names(self._version.file(path))
        return self._names[path].of_kind(kind)

    def _find_paths(self, name: str) -> Iterator[str]:
        texts = (f'"{name}"', f"'{name}'")
        return (path for path, content in self._texts.items() if any(text in content for text in texts))

    @cached_property
    def _texts(self) -> dict[str, str]:
        paths = self._version.paths((*CPP_SUFFIXES, PYTHON_SUFFIX), self._package or "")
        texts = {path: self._version.text(path) for path in paths if self._is_searched(PurePosixPath(path))}
        return {path: text for path, text in texts.items() if not _only_makes_actions(path, text)}

    def _is_searched(self, path: PurePosixPath) -> bool:
        if not TEST_FOLDERS.isdisjoint(path.parts) or is_launch_file_name(path.name):
            return False
        return path.as_posix() not in self._changed and self._is_built(path)

    def _is_built(self, path: PurePosixPath) -> bool:
        """Return whether the package can build or install a source, or whether it is outside of packages."""
        if self._package is None:
            return self._version.package_of(path.as_posix(), (MANIFEST, ROSBUILD_MANIFEST)) is None
        if path.suffix == PYTHON_SUFFIX:
            folders = self._python_folders
            return folders is None or any(path.is_relative_to(folder) for folder in folders)
        known = self._built_sources
        return path.suffix in HEADER_SUFFIXES or known is None or path.as_posix() in known

    @cached_property
    def _python_folders(self) -> list[PurePosixPath] | None:
        """The Python files and folders that the package installs, or None if they are unknown."""
        package = self._package or ""
        facts = read_package_facts(self._version, package)
        has_cmake = self._version.file(f"{package}/{CMAKE_FILE}".lstrip("/")).is_file()
        if has_cmake or facts is None or not facts.is_complete:
            return None
        names = find_python_packages(self._version, package)
        paths = [f"{part}{name}" for name in names for part in ("", "src/")]
        return [PurePosixPath(package) / path for path in (*paths, *facts.files.values())]

    @cached_property
    def _built_sources(self) -> frozenset[str] | None:
        """The C++ sources that the package builds, or None if they are unknown."""
        package = self._package or ""
        facts = read_package_facts(self._version, package)
        text = self._version.text(f"{package}/{CMAKE_FILE}".lstrip("/"))
        if facts is None or not facts.targets or _SOURCE_SEARCH.search(text):
            return None
        paths = (source for parts in facts.targets.values() for source in parts.sources)
        return frozenset((PurePosixPath(package) / path).as_posix() for path in paths)


def _only_makes_actions(path: str, text: str) -> bool:
    """Return whether a Python module makes actions for launch files, and no node."""
    is_helper = path.endswith(PYTHON_SUFFIX) and _LAUNCH_IMPORT.search(text) is not None
    return is_helper and _NODE_IMPORT.search(text) is None


def get_counterpart(kind: NameKind) -> NameKind | None:
    """Return the kind at the other end of a topic, service or action, or None."""
    return _COUNTERPARTS.get(kind)


def is_same_topic(item: SourceName, other: SourceName) -> bool:
    """Return whether two names mean the same topic, service or action.

    Namespaces are ignored. Private names are those of one node.
    """
    return item.name.lstrip("/") == other.name.lstrip("/") and not item.name.startswith("~")


def make_user_reason(kind: NameKind, path: str, name: str) -> Phrase:
    """Return the reason why removing a name breaks a source that still uses it.

    Args:
        kind: the kind of the removed name.
        path: the path of the other source.
        name: the removed name.
    """
    values = {"file": PurePosixPath(path).name, "name": name}
    if kind is NameKind.PUBLISHER:
        return phrase("'{file}' still subscribes to '{name}'", **values)
    if kind is NameKind.SUBSCRIPTION:
        return phrase("'{file}' still publishes '{name}'", **values)
    if kind in (NameKind.SERVICE, NameKind.ACTION):
        return phrase("'{file}' still calls '{name}'", **values)
    return phrase("'{file}' still serves '{name}'", **values)
