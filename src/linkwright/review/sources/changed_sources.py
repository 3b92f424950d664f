"""Search the changed sources of a version for names, and the other sources of their packages."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cached_property

from linkwright.packages.manifest import MANIFEST
from linkwright.review.files.rosbuild_manifests import ROSBUILD_MANIFEST
from linkwright.review.sources.code import Code, read_code
from linkwright.review.sources.names import NameKind, SourceName, SourceNames
from linkwright.review.sources.reading import read_source_names, try_read_source
from linkwright.review.sources.unchanged_sources import UnchangedSources, counterpart, is_same_topic
from linkwright.review.versions import Version

COMMUNICATION_KINDS = (
    *(NameKind.PUBLISHER, NameKind.SUBSCRIPTION, NameKind.SERVICE, NameKind.CLIENT),
    *(NameKind.ACTION, NameKind.ACTION_CLIENT),
)
"""The kinds of names by which a node communicates."""
_LOCAL = (NameKind.OPTION, NameKind.CLASS, NameKind.FUNCTION, NameKind.MEMBER)
"""The kinds whose names may mean another thing in another source."""


class ChangedSources:
    """The names in the changed sources of a version.

    Args:
        version: the version of the repository.
        paths: the paths of the sources; None for a source that the version lacks.
    """

    def __init__(self, version: Version, paths: Sequence[str | None]) -> None:
        self.version = version
        self._names = {path: read_source_names(version.file(path)) for path in paths if path is not None}
        self._others: dict[str, UnchangedSources] = {}

    def names(self, path: str | None) -> SourceNames:
        """Return the names in a changed source."""
        return self._names.get(path, SourceNames()) if path is not None else SourceNames()

    @cached_property
    def codes(self) -> Mapping[str, Code]:
        """The code of the changed sources, by path."""
        sources = {path: try_read_source(self.version.file(path)) for path in self._names}
        return {path: read_code(source) for path, source in sources.items() if source is not None}

    def has_function(self, name: str, code: Code, path: str) -> bool:
        """Return whether another changed source has a function with the same name and code.

        Args:
            name: the qualified name of the function.
            code: the code that contains the function.
            path: the path of the source to skip.
        """
        short, body = re.split(r"\.|::", name)[-1], code.body(name)
        return any(
            re.split(r"\.|::", function)[-1] == short and other.body(function) == body
            for other_path, other in self.codes.items()
            if other_path != path
            for function in other.functions
        )

    @cached_property
    def _known(self) -> frozenset[tuple[NameKind, str]]:
        return frozenset((item.kind, comparison_name(item)) for names in self._names.values() for item in names.names)

    @cached_property
    def _functions(self) -> frozenset[str]:
        overrides = {name for names in self._names.values() for name in names.overrides}
        declared = {name.rpartition("::")[2] for kind, name in self._known if kind is NameKind.FUNCTION}
        return frozenset(overrides | declared)

    @cached_property
    def _expressions(self) -> list[tuple[NameKind, str]]:
        return [(item.kind, item.type) for names in self._names.values() for item in names.expressions]

    def count(self, item: SourceName) -> int:
        """Return the number of expressions in changed sources with the same kind and type."""
        return self._expressions.count((item.kind, item.type))

    def lacks_in_changed(self, item: SourceName, path: str) -> bool:
        """Return whether no changed source except this one has a name, so that the name has not moved."""
        if item.kind is NameKind.PARAMETER and self._generates(item.name, path):
            return False
        others = (names for other, names in self._names.items() if other != path)
        return not any(
            (known.kind, comparison_name(known)) == (item.kind, comparison_name(item))
            for names in others
            for known in names.names
        )

    def lacks(self, item: SourceName, path: str) -> bool:
        """Return whether neither a changed source nor another source of the same package has a name.

        Args:
            item: the name to search for.
            path: the path of a source of the package.
        """
        if item.kind is NameKind.IMPORT:
            return True
        if (item.kind, comparison_name(item)) in self._known:
            return False
        if item.kind is NameKind.FUNCTION and item.name.rpartition("::")[2] in self._functions:
            return False  # in a base class, for example
        if item.kind in _LOCAL:
            return True
        package = self.package(path)
        if package is None:
            return True
        if item.kind is NameKind.PARAMETER and self._generates(item.name, path):
            return False
        others = self._unchanged(package)
        return not (others.has_same(item) if item.kind in COMMUNICATION_KINDS else others.has_text(item.name))

    def keeps(self, item: SourceName, path: str) -> bool:
        """Return whether an unchanged source of the same package has a topic, service or action of the same kind."""
        package = self.package(path) if item.kind in COMMUNICATION_KINDS else None
        return package is not None and self._unchanged(package).has_same(item)

    def user(self, item: SourceName, path: str) -> str | None:
        """Return a source of the same package with the other end of a topic, service or action, or None."""
        package, kind = self.package(path), counterpart(item.kind)
        if package is None or kind is None:
            return None
        for other, names in self._names.items():
            if self.package(other) == package and any(is_same_topic(item, user) for user in names.of_kind(kind)):
                return other
        return self._unchanged(package).user(item)

    def package(self, path: str) -> str | None:
        """Return the folder of the package of a file, or None for a file outside of packages."""
        return self.version.package_of(path, (MANIFEST, ROSBUILD_MANIFEST))

    def _unchanged(self, package: str) -> UnchangedSources:
        if package not in self._others:
            self._others[package] = UnchangedSources(self.version, package, self._names)
        return self._others[package]

    def _generates(self, name: str, path: str) -> bool:
        """Return whether a parameter description beside a source, from which code is generated, has a parameter."""
        files = self.version.file(path).parent.glob("*.y*ml")
        return any(f"{name.rpartition('.')[2]}:" in file.read_text("utf-8", errors="replace") for file in files)


def comparison_name(item: SourceName) -> str:
    """Return the name by which versions are compared. In ROS 1, a private name may lack the ``~``."""
    return item.name.lstrip("~/") if item.kind is NameKind.PARAMETER else item.name
