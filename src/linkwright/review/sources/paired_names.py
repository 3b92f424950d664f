"""Decide which names of a changed source are the same thing in both versions, and which names count."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.review.sources.callbacks import pair_by_callback
from linkwright.review.sources.cpp.members import has_class
from linkwright.review.sources.gazebo_topics import GAZEBO_KINDS, select_gazebo_topics
from linkwright.review.sources.interface_patterns import INTERFACE_KINDS, select_interfaces
from linkwright.review.sources.names import PYTHON_SUFFIX, NameKind, SourceName, SourceNames
from linkwright.review.sources.pairing import pair_edited_alike, pair_similar
from linkwright.review.sources.parameter_uses import ParameterUses
from linkwright.review.sources.python.attributes import select_attributes
from linkwright.review.sources.python.bases import select_methods
from linkwright.review.sources.python.package_imports import drop_defined_imports, is_installed_module
from linkwright.review.sources.statements.renamed_classes import find_renamed_classes
from linkwright.review.sources.whole_sources import WholeSourcePair


class PairedNames(WholeSourcePair):
    """Both versions of a changed source, whose names are paired."""

    def select_reported(
        self,
        kind: NameKind,
        removed: list[SourceName],
        added: list[SourceName],
        old_names: SourceNames,
        new_names: SourceNames,
    ) -> tuple[list[SourceName], list[SourceName]]:
        """Return the removed and added names without those of classes that only one version has."""
        if kind is NameKind.IMPORT:
            return (
                drop_defined_imports(removed, old_names, new_names, self.new.version.file(self.file.new_path or "")),
                drop_defined_imports(added, new_names, old_names, self.old.version.file(self.file.old_path or "")),
            )
        if kind in INTERFACE_KINDS:
            return select_interfaces(removed, new_names), select_interfaces(added, old_names)
        if kind is NameKind.YAML_KEY:
            return [i for i in removed if not self.new.has_text(i.name)], [
                i for i in added if not self.old.has_text(i.name)
            ]
        if kind in GAZEBO_KINDS:
            return select_gazebo_topics(removed, new_names), select_gazebo_topics(added, old_names)
        is_python = self.file.path.endswith(PYTHON_SUFFIX)
        if kind not in (NameKind.FUNCTION, NameKind.MEMBER):
            return removed, added
        if is_python and kind is NameKind.MEMBER:
            old_path, path = self.file.old_path or self.file.path, self.file.path
            packages = self.old.find_package(old_path) or "", self.new.find_package(path) or ""
            return (
                select_attributes(removed, old_names, new_names, self.old.version, packages[0]),
                select_attributes(added, new_names, old_names, self.new.version, packages[1]),
            )
        if is_python:
            path = self.file.old_path or self.file.path
            is_installed = is_installed_module(self.old.version, self.old.find_package(path), path)
            inherited = (old_names.inherited_names, new_names.inherited_names) if is_installed else ({}, {})
            return select_methods(removed, *inherited), select_methods(added, *reversed(inherited))
        old_classes, new_classes = (
            {item.name for item in names.of_kind(NameKind.CLASS)} for names in (old_names, new_names)
        )
        common = old_classes & new_classes
        return [item for item in removed if has_class(item, common)], [
            item for item in added if has_class(item, common)
        ]

    def pair_names(
        self, kind: NameKind, old_items: Sequence[SourceName], new_items: Sequence[SourceName]
    ) -> list[tuple[SourceName, SourceName]]:
        """Return the pairs of an old and a new name of the same thing."""
        if kind in (NameKind.PARAMETER, NameKind.HARDWARE_PARAMETER) and old_items and new_items:
            if kind is NameKind.PARAMETER:
                old_items = [item for item in old_items if not self.is_unread_parameter(item.name)]
            pairs = pair_edited_alike(old_items, new_items)
            old_items, new_items = _drop_paired(pairs, old_items, new_items)
            return [*pairs, *pair_similar(old_items, new_items, self._read_uses(old_items, new_items).differ)]
        if kind is NameKind.FUNCTION:
            pairs = list(self._pair_by_code(old_items, new_items))
        elif kind is NameKind.CLASS and not self.file.path.endswith(PYTHON_SUFFIX):
            pairs = self._pair_renamed_classes(old_items, new_items)
        else:
            old_names, new_names = self.old.get_names(self.file.old_path), self.new.get_names(self.file.new_path)
            pairs = pair_by_callback(old_items, new_items, old_names, new_names)
        return [*pairs, *pair_similar(*_drop_paired(pairs, old_items, new_items))]

    def _read_uses(self, old_items: Sequence[SourceName], new_items: Sequence[SourceName]) -> ParameterUses:
        return ParameterUses(*self.read_texts(), [item.name for item in old_items], [item.name for item in new_items])

    def read_texts(self) -> tuple[str, str]:
        """Return the texts of both versions, empty for one that lacks the source."""
        old_path, new_path = self.file.old_path, self.file.new_path
        old_text = "" if old_path is None else self.old.version.text(old_path)
        return old_text, "" if new_path is None else self.new.version.text(new_path)

    def _pair_by_code(
        self, removed: Sequence[SourceName], added: Sequence[SourceName]
    ) -> Iterator[tuple[SourceName, SourceName]]:
        """Yield the removed and added functions with equal arguments and code.

        Functions with several matches are left out.
        """
        old, new = self.old.codes.get(self.file.old_path or ""), self.new.codes.get(self.file.new_path or "")
        if old is None or new is None:
            return
        for item in removed:
            body = old.get_body(item.name)
            matching = [other for other in added if other.details == item.details and new.get_body(other.name) == body]
            if body and len(matching) == 1 and sum(old.get_body(other.name) == body for other in removed) == 1:
                yield item, matching[0]

    def _pair_renamed_classes(
        self, removed: Sequence[SourceName], added: Sequence[SourceName]
    ) -> list[tuple[SourceName, SourceName]]:
        """Return the removed and added classes that have the same methods or statements."""
        old, new = self.old.codes.get(self.file.old_path or ""), self.new.codes.get(self.file.new_path or "")
        renamed = {} if old is None or new is None or not (removed and added) else find_renamed_classes(old, new)
        return [(item, other) for item in removed for other in added if renamed.get(item.name) == other.name]


def _drop_paired(
    pairs: Sequence[tuple[SourceName, SourceName]], *sides: Sequence[SourceName]
) -> tuple[list[SourceName], list[SourceName]]:
    """Return the old and the new names that are in no pair."""
    paired = [item for pair in pairs for item in pair]
    old, new = ([item for item in items if item not in paired] for items in sides)
    return old, new
