"""The comparison of the sources of nodes: literal names of topics, services, actions, parameters and nodes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.packages.manifest import MANIFEST
from linkwright.review.breaking import name_reason
from linkwright.review.changes import Change, Effect, Location, Subject, SubjectKind
from linkwright.review.files.source_names import (
    CPP_SUFFIXES,
    PYTHON_SUFFIX,
    NameKind,
    SourceName,
    SourceNames,
    read_source_names,
)
from linkwright.review.versions import Version, Versions

_TEST_FOLDERS = frozenset({"test", "tests"})
_CLIENTS = (NameKind.CLIENT, NameKind.ACTION_CLIENT)
_MAX_NAMES = 8


def source_subjects(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[Subject]:
    """Yield the changed sources of nodes in which literal names differ.

    A name that only moves to another file is not a change, and nothing is said of names that are expressions.
    """
    files = [file for file in changed_files if _is_source(file)]
    sides = (
        _Side(versions.old, [file.old_path for file in files]),
        _Side(versions.new, [file.new_path for file in files]),
    )
    for file in files:
        changes = list(_changes(*sides, file))
        if changes:
            yield Subject(SubjectKind.SOURCE, file.path, file.old_path, file.new_path, changes)


def _is_source(file: ChangedFile) -> bool:
    path = PurePosixPath(file.path)
    is_code = path.suffix in (*CPP_SUFFIXES, PYTHON_SUFFIX) and path.name != "setup.py"
    is_test = not _TEST_FOLDERS.isdisjoint(path.parts) or path.name.startswith("test_")
    return is_code and not is_test and not is_launch_file_name(path.name) and not file.is_submodule


class _Side:
    """The names in the changed sources of a version.

    Args:
        version: the version.
        paths: the paths of the sources; None for one that the version does not have.
    """

    def __init__(self, version: Version, paths: Sequence[str | None]) -> None:
        self.version = version
        self._names = {path: read_source_names(version.file(path)) for path in paths if path is not None}

    def names(self, path: str | None) -> SourceNames:
        """Return the names in a changed source."""
        return self._names.get(path, SourceNames()) if path is not None else SourceNames()

    @cached_property
    def _known(self) -> frozenset[tuple[NameKind, str]]:
        return frozenset((item.kind, item.name) for names in self._names.values() for item in names.names)

    def lacks(self, item: SourceName, path: str) -> bool:
        """Return whether neither a changed source nor another source of the same package has a name.

        Args:
            item: the name.
            path: the path of a source of the package.
        """
        if (item.kind, item.name) in self._known:
            return False
        parents = (self.version.file(parent.as_posix()) for parent in PurePosixPath(path).parents)
        package = next((folder for folder in parents if (folder / MANIFEST).is_file()), None)
        if package is None:
            return True
        if item.kind is NameKind.PARAMETER and self._generates(item.name, path):
            return False
        texts = (f'"{item.name}"', f"'{item.name}'")
        for file in package.rglob("*"):
            relative = self.version.relative(file)
            if file.suffix not in (*CPP_SUFFIXES, PYTHON_SUFFIX) or relative in self._names or not file.is_file():
                continue
            if not _TEST_FOLDERS.isdisjoint(file.parts) or is_launch_file_name(file.name):
                continue
            content = file.read_text("utf-8", errors="replace")
            if any(text in content for text in texts):
                return False
        return True

    def _generates(self, name: str, path: str) -> bool:
        """Return whether a description of parameters beside a source, from which code is generated, has a parameter."""
        files = self.version.file(path).parent.glob("*.y*ml")
        return any(f"{name.rpartition('.')[2]}:" in file.read_text("utf-8", errors="replace") for file in files)


def _changes(old: _Side, new: _Side, file: ChangedFile) -> Iterator[Change]:
    old_names, new_names = old.names(file.old_path), new.names(file.new_path)
    for kind in NameKind:
        before = {item.name: item for item in old_names.names if item.kind is kind}
        after = {item.name: item for item in new_names.names if item.kind is kind}
        yield from (
            change
            for name, item in after.items()
            if name in before
            for change in _type_changes(before[name], item, new.version)
        )
        removed = [item for name, item in before.items() if name not in after]
        added = [item for name, item in after.items() if name not in before]
        if new_names.expressions[kind] > old_names.expressions[kind]:
            removed = []
        if old_names.expressions[kind] > new_names.expressions[kind]:
            added = []
        removed = [item for item in removed if new.lacks(item, file.path)]
        added = [item for item in added if old.lacks(item, file.old_path or file.path)]
        for before_item, after_item in _renamed(removed, added):
            text = phrase(
                "{kind} {old} renamed to {new}", kind=kind.title, old=_name(before_item), new=_name(after_item)
            )
            yield _change(text, after_item, new.version, _reason([before_item]))
            removed.remove(before_item)
            added.remove(after_item)
        if added:
            text = phrase("{kind} added: {names}", kind=kind.plural, names=_names(added))
            yield _change(text, added[0], new.version, None)
        if removed:
            text = phrase("{kind} removed: {names}", kind=kind.plural, names=_names(removed))
            yield _change(text, removed[0], old.version, _reason(removed))


def _change(text: Phrase, item: SourceName, version: Version, reason: Phrase | None) -> Change:
    path = version.relative(item.span.file)
    location = None if path is None else Location(path, item.span.line, item.span.column, version.is_old)
    return Change(text, Effect.CHANGED if reason is None else Effect.BREAKING, reason, location)


def _name(item: SourceName) -> str:
    """Return a name with the type of its messages, or the default of a parameter."""
    return f"'{item.name}' ({item.type})" if item.type else f"'{item.name}'"


def _names(items: Sequence[SourceName]) -> Phrase:
    return joined_first(map(_name, items), _MAX_NAMES)


def _renamed(removed: Sequence[SourceName], added: Sequence[SourceName]) -> list[tuple[SourceName, SourceName]]:
    """Return the removed and added names that are the same thing: the only ones, or the only ones of a type."""
    if len(removed) == len(added) == 1:
        return [(removed[0], added[0])]
    pairs = []
    for item in removed:
        same = [[other for other in items if other.type == item.type and item.type] for items in (removed, added)]
        if len(same[0]) == len(same[1]) == 1:
            pairs.append((item, same[1][0]))
    return pairs


def _reason(items: Sequence[SourceName]) -> Phrase | None:
    """Return why it is breaking that names are gone, or None if other programs do not use them."""
    kind = items[0].kind
    if kind in _CLIENTS:
        return None
    names = joined_first([item.name for item in items], _MAX_NAMES)
    if kind is NameKind.PARAMETER:
        return phrase("values that launch files and parameter files give to '{name}' have no effect", name=names)
    return name_reason(str(names))


def _type_changes(old: SourceName, new: SourceName, version: Version) -> Iterator[Change]:
    if old.type == new.type or not old.type or not new.type:
        return
    if new.kind is NameKind.PARAMETER:
        text = phrase("parameter '{name}': default {old} -> {new}", name=new.name, old=old.type, new=new.type)
        yield _change(text, new, version, None)
        return
    text = phrase(
        "{kind} '{name}': type {old} -> {new}", kind=new.kind.title, name=new.name, old=old.type, new=new.type
    )
    yield _change(text, new, version, phrase("programs that use '{name}' with the old type get nothing", name=new.name))
