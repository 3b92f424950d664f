"""Find sources that still use a topic, service or action with the type that another source gave up."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX, NameKind, SourceName, SourceNames
from linkwright.review.sources.reading import read_source_names
from linkwright.review.sources.unchanged_sources import get_counterpart, is_same_topic
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_SOURCE_SUFFIXES = (*CPP_SUFFIXES, PYTHON_SUFFIX)
_COMMON_NAME = re.compile(
    r"cmd_vel\w*|odom\w*|scan\w*|imu\w*|fix|map|joy|goal|goal_pose|initialpose|battery\w*|joint_\w+|"
    r"(?:\w+_)?(?:image|points|cloud|pose|camera_info)(?:_\w+)?|status|state|reset|enable|start|stop|clock|tf|tf_static"
)
"""The last words of the names that programs of other repositories often offer, too."""


def find_left_types(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the sources whose counterpart has another type now, each with a change.

    In other packages, relative names are compared only if no third package offers the name, and not common ones.
    A name that another source still has with the old type is left out.
    """
    sources = _Sources(versions.new)
    for file in changed_files:
        if not (file.old_path and file.new_path and file.path.endswith(_SOURCE_SUFFIXES)) or file.is_submodule:
            continue
        for old, new in _find_changed_types(versions, file.old_path, file.new_path):
            if not any(sources.find(old.kind, old, file.new_path)):
                kind = get_counterpart(old.kind)
                users = sources.find(kind, old, file.new_path) if kind is not None else ()
                for path, item in users:
                    if not item.has_type_of(new):  # its package may be unknown
                        yield path, _make_change(path, item, new, file.new_path)


def _find_changed_types(versions: Versions, old_path: str, new_path: str) -> Iterator[tuple[SourceName, SourceName]]:
    """Yield the names whose type differs between the versions of a source."""
    old = read_source_names(versions.old.file(old_path)).names
    new = read_source_names(versions.new.file(new_path)).names
    for item in old:
        if get_counterpart(item.kind) is None or not item.type or item.name in ("", "/"):
            continue
        matching = [other for other in new if (other.kind, other.name) == (item.kind, item.name)]
        if len(matching) == 1 and matching[0].type and not matching[0].has_type_of(item):
            yield item, matching[0]


class _Sources:
    """The sources of a version, except tests and launch files."""

    def __init__(self, version: Version) -> None:
        self._version = version
        self._all_texts: dict[str, str] | None = None
        self._names: dict[str, SourceNames] = {}

    def find(self, kind: NameKind, item: SourceName, path: str) -> Iterator[tuple[str, SourceName]]:
        """Yield the sources that use a name with its type, each with the name in it.

        Args:
            kind: the kind of the names.
            item: the name and its type.
            path: the path of the source that had the name.
        """
        package = self._version.package_of(path)
        is_common = item.name.startswith("~") or _COMMON_NAME.fullmatch(item.name.rpartition("/")[2]) is not None
        is_shared = not is_common and self._has_one_owner(item, package)
        for user, text in self._texts.items():
            if item.name.lstrip("/") not in text or item.type.rpartition("/")[2].rpartition("::")[2] not in text:
                continue
            is_own = self._version.package_of(user) == package
            for other in self._read(user).of_kind(kind):
                is_same = item.name == other.name and item.name.startswith("/")
                if (is_same or ((is_own or is_shared) and is_same_topic(item, other))) and other.has_type_of(item):
                    yield user, other

    def _has_one_owner(self, item: SourceName, package: str | None) -> bool:
        """Return whether no source of another package has a name of the same kind."""
        name = item.name.lstrip("/")
        return not any(
            is_same_topic(item, other)
            for path, text in self._texts.items()
            if name in text and self._version.package_of(path) != package
            for other in self._read(path).of_kind(item.kind)
        )

    @property
    def _texts(self) -> Mapping[str, str]:
        if self._all_texts is None:
            paths = (path for path in self._version.paths(_SOURCE_SUFFIXES) if _is_searched(PurePosixPath(path)))
            self._all_texts = {path: self._version.text(path) for path in paths}
        return self._all_texts

    def _read(self, path: str) -> SourceNames:
        if path not in self._names:
            self._names[path] = read_source_names(self._version.file(path))
        return self._names[path]


def _is_searched(path: PurePosixPath) -> bool:
    return TEST_FOLDERS.isdisjoint(path.parts) and not is_launch_file_name(path.name)


def _make_change(path: str, item: SourceName, new: SourceName, source: str) -> Change:
    types = (item.type, new.type) if item.type != new.type else (item.full_type, new.full_type)
    text = phrase(
        "{kind} '{name}' still has the type {old}; '{file}' now uses {new}",
        kind=item.kind.title,
        name=item.name,
        old=types[0],
        file=source,
        new=types[1],
    )
    return Change(text, Effect.BREAKING, _make_reason(item.kind), Location(path, item.span.line, item.span.column))


def _make_reason(kind: NameKind) -> Phrase:
    if kind in (NameKind.PUBLISHER, NameKind.SUBSCRIPTION):
        return phrase("no messages are exchanged")
    return phrase("the calls fail")
