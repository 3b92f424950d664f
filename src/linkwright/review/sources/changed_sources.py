"""Search for names in the changed sources of a version and in the rest of their packages."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import PurePosixPath
from types import MappingProxyType

from linkwright.packages.manifest import MANIFEST, ROSBUILD_MANIFEST
from linkwright.review.sources.cpp.base_classes import find_base_sources
from linkwright.review.sources.cpp_bases import ClassMethods
from linkwright.review.sources.names import (
    CPP_SUFFIXES,
    DYNAMIC_SUFFIX,
    PYTHON_SUFFIX,
    NameKind,
    SourceName,
    SourceNames,
    Timer,
)
from linkwright.review.sources.reading import read_source_names, try_read_source
from linkwright.review.sources.separate_programs import are_in_separate_programs
from linkwright.review.sources.statements.code import Code, read_code
from linkwright.review.sources.statements.moved_code import MovedCode, find_moved_code, without_functions
from linkwright.review.sources.statements.renamed_words import find_renamed_words
from linkwright.review.sources.unchanged_sources import UnchangedSources, get_counterpart, is_same_topic
from linkwright.review.sources.used_packages import UsedPackages
from linkwright.review.versions import Version

COMMUNICATION_KINDS = (
    *(NameKind.PUBLISHER, NameKind.SUBSCRIPTION, NameKind.SERVICE, NameKind.CLIENT),
    *(NameKind.ACTION, NameKind.ACTION_CLIENT),
)
"""The kinds of names by which a node communicates."""
_DEFINED_KINDS = (NameKind.CLASS, NameKind.FUNCTION, NameKind.MEMBER)
"""The kinds of definitions, which only sources of the same language can use."""
_LOCAL_KINDS = (
    *(NameKind.OPTION, *_DEFINED_KINDS),
    *(NameKind.COMMAND_INTERFACE, NameKind.STATE_INTERFACE, NameKind.CLAIMED_INTERFACE),
)
"""The kinds whose names may mean something else in a different source."""


class ChangedSources:
    """The names in the changed sources of a version.

    Args:
        version: the version of the repository.
        paths: the paths of the sources; None for a source that the version lacks.
        new_packages: the new names of packages that are renamed after this version, by old name.
    """

    def __init__(
        self, version: Version, paths: Sequence[str | None], new_packages: Mapping[str, str] = MappingProxyType({})
    ) -> None:
        self.version = version
        self._new_packages = new_packages
        self._names = {path: read_source_names(version.file(path)) for path in paths if path is not None}
        self._unchanged_by_package: dict[str | None, UnchangedSources] = {}
        self._used_by_package: dict[str, UsedPackages] = {}
        self._moved_code: dict[str, MovedCode] | None = None
        self._renamed_words: dict[str, str] | None = None
        self._counterpart: ChangedSources | None = None

    def connect(self, other: ChangedSources) -> None:
        """Set the changed sources of the other version, in both directions."""
        self._counterpart, other._counterpart = other, self

    def get_names(self, path: str | None) -> SourceNames:
        """Return the names in a changed source."""
        names = None if path is None else self._names.get(path)
        return SourceNames() if names is None else names

    def get_inherited(self, path: str | None) -> list[SourceNames]:
        """Return the names in the sources of the base classes of a C++ source."""
        if path is None or not path.endswith(CPP_SUFFIXES):
            return []
        return [read_source_names(base) for base in find_base_sources(self.version.file(path))]

    @property
    def paths(self) -> Collection[str]:
        """The paths of the changed sources."""
        return self._names.keys()

    def list_timers(self, path: str | None) -> list[Timer]:
        """Return the timers in all changed sources except one."""
        return [timer for names in self.list_others(path) for timer in names.timers]

    def list_others(self, path: str | None) -> list[SourceNames]:
        """Return the names in each changed source except one."""
        return [names for other, names in self._names.items() if other != path]

    @cached_property
    def codes(self) -> Mapping[str, Code]:
        """The code of the changed sources, by path."""
        sources = {path: try_read_source(self.version.file(path)) for path in self._names}
        return {path: read_code(source) for path, source in sources.items() if source is not None}

    @property
    def new_packages(self) -> Mapping[str, str]:
        """The new names of the packages that are renamed after this version, by their old names."""
        return self._new_packages

    def rename_type(self, full_type: str) -> str:
        """Return the type of messages with the new name of its package if that is renamed after this version."""
        package, separator, name = full_type.partition("/")
        return f"{self._new_packages.get(package, package)}{separator}{name}"

    def rename_imports(self, code: Code, new: Code) -> Code:
        """Return code of this version with the new names of renamed packages in imports that the new code lacks."""
        kept = {part.text for part in new.imports}
        imports = [
            part if part.text in kept else part._replace(text=self._rename_packages(part.text)) for part in code.imports
        ]
        return replace(code, imports=imports)

    def _rename_packages(self, text: str) -> str:
        return re.sub(r"\w+", lambda word: self._new_packages.get(word[0], word[0]), text)

    def find_moved_code(self, old: ChangedSources) -> Mapping[str, MovedCode]:
        """Return where Python sources of this version moved their code outside of functions, by the path of the source.

        Args:
            old: the changed sources of the old version.
        """
        if self._moved_code is None:
            codes = {path: code for path, code in self.codes.items() if not path.endswith(CPP_SUFFIXES)}
            added = {
                path: without_functions(code, old.codes.get(path, Code()).functions) for path, code in codes.items()
            }
            found = {
                path: find_moved_code(old.codes[path], code, added) for path, code in codes.items() if path in old.codes
            }
            self._moved_code = {path: moved for path, moved in found.items() if moved is not None}
        return self._moved_code

    def find_renamed_words(self, old: ChangedSources) -> Mapping[str, str]:
        """Return the new names of variables, members and functions that only have another name, by their old names.

        Args:
            old: the changed sources of the old version.
        """
        if self._renamed_words is None:
            self._renamed_words = find_renamed_words(old.codes, self.codes)
        return self._renamed_words

    @cached_property
    def _texts(self) -> Sequence[str]:
        sources = (try_read_source(self.version.file(path)) for path in self._names)
        return [source.text for source in sources if source is not None]

    def has_text(self, text: str) -> bool:
        """Return whether a changed source has a literal text."""
        return any(f"'{text}'" in source or f'"{text}"' in source for source in self._texts)

    def has_word(self, word: str) -> bool:
        """Return whether a changed source has a name."""
        pattern = re.compile(rf"\b{re.escape(word)}\b")
        return any(word in source and pattern.search(source) for source in self._texts)

    def has_function(self, name: str, code: Code, path: str) -> bool:
        """Return whether another changed source has a function with the same name and code.

        Args:
            name: the qualified name of the function.
            code: the code that contains the function.
            path: the path of the source to skip.
        """
        short, body = re.split(r"\.|::", name)[-1], code.get_body(name)
        return any(
            re.split(r"\.|::", function)[-1] == short and other.get_body(function) == body
            for other_path, other in self.codes.items()
            if other_path != path
            for function in other.functions
        )

    @cached_property
    def _known_names(self) -> Mapping[tuple[NameKind, str, bool], Sequence[str]]:
        """The paths of the changed sources that have a name."""
        found: dict[tuple[NameKind, str, bool], list[str]] = {}
        for path, names in self._names.items():
            for key in dict.fromkeys(_make_key(item, path) for item in names.names):
                found.setdefault(key, []).append(path)
        return found

    def _is_known(self, item: SourceName, path: str) -> bool:
        """Return whether a changed source has a name that may have moved to it or from it.

        A source of another package that has the name in both versions keeps its own one.
        """
        key, package = _make_key(item, path), self.find_package(path)
        other = self._counterpart._known_names if self._counterpart is not None else {}
        kept = frozenset(other.get(key, ()))
        return any(owner not in kept or self.find_package(owner) == package for owner in self._known_names.get(key, ()))

    @cached_property
    def _methods(self) -> ClassMethods:
        return ClassMethods(self.version, self._names)

    @cached_property
    def _expressions(self) -> list[tuple[NameKind, str]]:
        return [(item.kind, item.type) for names in self._names.values() for item in names.expressions]

    def count_expressions(self, item: SourceName) -> int:
        """Return the number of expressions in changed sources with the same kind and type."""
        return self._expressions.count((item.kind, item.type))

    def list_similar(self, item: SourceName) -> set[str]:
        """Return the literal and computed names of the same kind and type in all changed sources."""
        return {
            other.name
            for names in self._names.values()
            for other in (*names.names, *names.expressions)
            if (other.kind, other.type) == (item.kind, item.type)
        }

    def count_owners(self, item: SourceName, path: str) -> int:
        """Return the number of other changed sources that have a name.

        A parameter of dynamic_reconfigure only counts in other descriptions.
        """
        is_description = path.endswith(DYNAMIC_SUFFIX)
        others = (
            names
            for other, names in self._names.items()
            if other != path and (other.endswith(DYNAMIC_SUFFIX) or not is_description)
        )
        key = get_comparison_name(item)
        return sum(any(get_comparison_name(known) == key for known in names.of_kind(item.kind)) for names in others)

    def lacks(self, item: SourceName, path: str) -> bool:
        """Return whether a name is in no changed source and in no source of the package.

        Args:
            item: the name to search for.
            path: the path of a source of the package.
        """
        if item.kind is NameKind.OPTION:
            return not self._has_in_imported(item, path)
        if item.kind is NameKind.IMPORT:
            return True
        if self._is_known(item, path):
            return False
        if item.kind is NameKind.FUNCTION and self._methods.has_function(item.name):
            return False
        if item.kind in _LOCAL_KINDS:
            return True
        package = self.find_package(path)
        if package is None:
            return True
        if item.kind is NameKind.PARAMETER and self.generates(item.name, path):
            return False
        others = self._get_unchanged(package)
        is_read = item.kind in (*COMMUNICATION_KINDS, NameKind.NODE)
        if item.kind is NameKind.PARAMETER and self.find_undeclared_reader(item, path) is not None:
            return True
        return not (others.has_name(item) if is_read else others.has_text(item.name))

    def find_undeclared_reader(self, item: SourceName, path: str) -> str | None:
        """Return an unchanged source that gets a parameter which no source of the package declares, or None.

        A source in other programs is another node, which failed before.
        """
        package = self.find_package(path)
        if package is None or self._is_known(item, path):
            return None
        reader = self._get_unchanged(package).find_undeclared_reader(item.name)
        is_other = reader is not None and are_in_separate_programs(self.version, package, path, [reader])
        return None if is_other else reader

    def _has_in_imported(self, item: SourceName, path: str) -> bool:
        """Return whether a changed source that a source imports or includes has a name."""
        text = self.version.text(path)
        return any(
            any(known.name == item.name for known in names.of_kind(item.kind))
            for other, names in self._names.items()
            if other != path and imports(text, PurePosixPath(other).stem)
        )

    def list_owners(self, item: SourceName, path: str) -> dict[str, SourceNames]:
        """Return the other sources of the package of a file that have a name, by path.

        Of unchanged sources with a parameter, all that contain its name as a text are returned.
        """
        package = self.find_package(path)
        if package is None:
            return {}
        key = get_comparison_name(item)
        changed = {
            other: names
            for other, names in self._names.items()
            if other != path
            and self.find_package(other) == package
            and any(get_comparison_name(known) == key for known in names.of_kind(item.kind))
        }
        return {**changed, **self._get_unchanged(package).list_owners(item)}

    def find_moved(self, item: SourceName, path: str) -> SourceName | None:
        """Return the same name in the only other changed source of the package that has it, or None."""
        package, key = self.find_package(path), get_comparison_name(item)
        found = [
            known
            for other, names in self._names.items()
            if other != path and self.find_package(other) == package
            for known in names.of_kind(item.kind)
            if get_comparison_name(known) == key
        ]
        return found[0] if len(found) == 1 else None

    def has_in_unchanged(self, item: SourceName, path: str) -> bool:
        """Return whether an unchanged source of the package has the same topic, service or action."""
        package = self.find_package(path) if item.kind in COMMUNICATION_KINDS else None
        return package is not None and self._get_unchanged(package).has_name(item)

    def find_user(self, item: SourceName, path: str, old: ChangedSources | None = None) -> str | None:
        """Return a source of the package that uses the other end of a name, or None.

        Only topics, services and actions have another end.

        Args:
            item: the name.
            path: a file of the package.
            old: the changed sources of the old version; if given, the source must have used the name there, too.
        """
        package, kind = self.find_package(path), get_counterpart(item.kind)
        if package is None or kind is None:
            return None
        users = self.list_changed_users(item, path)
        if old is not None:
            users = [user for user in users if not old.lacks_use(item, user)]
        return users[0] if users else self._get_unchanged(package).find_user(item)

    def lacks_use(self, item: SourceName, path: str) -> bool:
        """Return whether a source of the version does not use the other end of a topic, service or action."""
        kind = get_counterpart(item.kind)
        known = self.get_names(path).of_kind(kind) if kind is not None else ()
        return self.version.file(path).is_file() and not any(is_same_topic(item, user) for user in known)

    def list_changed_users(self, item: SourceName, path: str) -> list[str]:
        """Return the changed sources of the package that use the other end of a topic, service or action."""
        package, kind = self.find_package(path), get_counterpart(item.kind)
        users = {other: names.of_kind(kind) for other, names in self._names.items()} if package and kind else {}
        return [
            other
            for other, known in users.items()
            if self.find_package(other) == package and any(is_same_topic(item, user) for user in known)
        ]

    def has_counterpart(self, item: SourceName) -> bool:
        """Return whether a changed source of any package has the other end of a topic, service or action."""
        kind = get_counterpart(item.kind)
        found = (known for names in self._names.values() for known in (names.of_kind(kind) if kind else ()))
        return any(is_same_topic(item, known) for known in found)

    def list_sources(self, path: str, text: str) -> Iterator[tuple[str, SourceNames]]:
        """Yield the paths and names of the sources in the package of a file. Unchanged ones must contain a text."""
        package = self.find_package(path)
        if package is not None:
            yield from ((other, names) for other, names in self._names.items() if self.find_package(other) == package)
            yield from self._get_unchanged(package).list_sources(text)

    def list_all_sources(self, *texts: str) -> Iterator[tuple[str, SourceNames]]:
        """Yield the paths and names of the sources of the version. Unchanged ones must contain one of several texts."""
        yield from self._names.items()
        for package in (*self._packages, None):
            yield from self._get_unchanged(package).list_sources(*texts)

    def find_names(self, path: str) -> SourceNames | None:
        """Return the names in a source, changed or not, or None if the version does not have it."""
        file = self.version.file(path)
        return read_source_names(file) if file.is_file() else None

    @cached_property
    def _packages(self) -> list[str]:
        """The folders of all packages."""
        paths = self.version.paths((MANIFEST, ROSBUILD_MANIFEST))
        pure_paths = (PurePosixPath(path) for path in paths)
        names = {path.parent.as_posix() for path in pure_paths if path.name in (MANIFEST, ROSBUILD_MANIFEST)}
        return sorted("" if name == "." else name for name in names)

    def find_package(self, path: str) -> str | None:
        """Return the folder of the package of a file, or None for a file outside of packages."""
        return self.version.package_of(path, (MANIFEST, ROSBUILD_MANIFEST))

    def get_used_packages(self, path: str) -> UsedPackages | None:
        """Return the packages that the package of a file uses; None for a file outside of packages."""
        package = self.find_package(path)
        if package is None:
            return None
        return self._used_by_package.setdefault(package, UsedPackages(self.version, package, self._new_packages))

    def _get_unchanged(self, package: str | None) -> UnchangedSources:
        if package not in self._unchanged_by_package:
            self._unchanged_by_package[package] = UnchangedSources(self.version, package, self._names)
        return self._unchanged_by_package[package]

    def generates(self, name: str, path: str) -> bool:
        """Return whether code is generated for a parameter.

        The generator reads a description beside the source.
        """
        files = self.version.file(path).parent.glob("*.y*ml")
        return any(f"{name.rpartition('.')[2]}:" in file.read_text("utf-8", errors="replace") for file in files)


def imports(text: str, stem: str) -> bool:
    """Return whether the text of a source imports or includes a file, by its name without the suffix."""
    return re.search(rf"^\s*(?:#\s*include|import|from)\b.*\b{re.escape(stem)}\b", text, re.MULTILINE) is not None


def get_comparison_name(item: SourceName) -> str:
    """Return the name by which versions are compared.

    In ROS 1, a private name may lack the ``~``.
    """
    return item.name.lstrip("~/") if item.kind is NameKind.PARAMETER else item.name


def _make_key(item: SourceName, path: str) -> tuple[NameKind, str, bool]:
    """Return a key that is equal for the same name in another source."""
    return item.kind, get_comparison_name(item), item.kind in _DEFINED_KINDS and path.endswith(PYTHON_SUFFIX)
