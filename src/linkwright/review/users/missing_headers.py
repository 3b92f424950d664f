"""Find C++ sources that newly use a message or service of the repository whose header no source includes."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.launches.programs.missing import RepositoryPackage
from linkwright.review.sources.cpp.text import blank_comments
from linkwright.review.sources.names import CPP_SUFFIXES
from linkwright.review.users.lost_interfaces import find_package
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_SUFFIXES = (".msg", ".srv")
_WORD_START = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")


def find_missing_headers(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the first source that newly uses a type of messages which it cannot know, with a change.

    The header of another message brings the types of its fields.
    """
    sources = _Sources(versions.new)
    told: set[str] = set()
    for file in changed_files:
        path = file.new_path
        if path is None or file.is_submodule or not path.endswith(CPP_SUFFIXES):
            continue
        if not TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts):
            continue
        text = blank_comments(versions.new.text(path))
        old_text = versions.old.text(file.old_path) if file.old_path else ""
        for interface in sources.interfaces:
            package = find_package(versions.new, interface)
            kind, name = PurePosixPath(interface).suffix[1:], PurePosixPath(interface).stem
            if package is None or name not in text or package not in text:
                continue
            match = re.search(rf"(?<![\w:]){re.escape(package)}::(?:{kind}::)?{re.escape(name)}\b", text)
            is_new = match is not None and match[0] not in old_text and interface not in told
            if match is None or not is_new or sources.may_know(package, kind, name):
                continue
            told.add(interface)
            header = sources.format_header(interface, package, kind, name)
            line = text.count("\n", 0, match.start()) + 1
            column = match.start() - text.rfind("\n", 0, match.start())
            sentence = phrase("uses '{type}', but no source includes <{header}>", type=match[0], header=header)
            yield path, Change(sentence, Effect.BREAKING, phrase("it does not build"), Location(path, line, column))


class _Sources:
    """The C++ sources and the interfaces of a version."""

    def __init__(self, version: Version) -> None:
        self._version = version

    @cached_property
    def interfaces(self) -> list[str]:
        """The paths of the messages and services."""
        return list(self._version.paths(_SUFFIXES))

    @cached_property
    def _text(self) -> str:
        """The texts of all C++ sources."""
        return "\n".join(self._version.text(path) for path in self._version.paths(CPP_SUFFIXES))

    @cached_property
    def _interface_text(self) -> str:
        """The texts of all interfaces."""
        return "\n".join(self._version.text(path) for path in self._version.paths((*_SUFFIXES, ".action")))

    def may_know(self, package: str, kind: str, name: str) -> bool:
        """Return whether a source includes or declares a type, or the header of another interface brings it."""
        letters = "_?".join(name)  # snake case of any convention
        headers = rf"{re.escape(package)}/(?:{kind}/(?:\w+/)?)?(?i:{letters})\w*\.h"
        declared = rf"\b(?:class|struct|using)\s+{name}\b|\btypedef\b[^;]*\b{name}\s*;"
        if re.search(rf"{headers}|{declared}", self._text):
            return True
        return re.search(rf"(?m)^\s*(?:\w+/)?{name}\b", self._interface_text) is not None

    def format_header(self, interface: str, package: str, kind: str, name: str) -> str:
        """Return the header of an interface in the version of ROS of its package."""
        folder = self._version.package_of(interface)
        if folder is not None and RepositoryPackage(self._version, folder).is_ros1:
            return f"{package}/{name}.h"
        return f"{package}/{kind}/{_to_snake_case(name)}.hpp"


def _to_snake_case(name: str) -> str:
    return _WORD_START.sub("_", name).lower()
