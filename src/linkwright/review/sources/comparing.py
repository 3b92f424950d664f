"""Compare the names in both versions of each changed source."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.breaking import names_reason
from linkwright.review.changes import MAX_NAMES, Change, Effect, Location, Subject, SubjectKind
from linkwright.review.renames.packages import find_renamed_packages
from linkwright.review.sources.changed_sources import COMMUNICATION_KINDS, ChangedSources, get_comparison_name
from linkwright.review.sources.compared_files import is_compared_source
from linkwright.review.sources.conditions import ConditionChange, compare_conditions
from linkwright.review.sources.cpp.calls import GRAPH_KINDS
from linkwright.review.sources.cpp.default_arguments import find_default_argument
from linkwright.review.sources.cpp.members import read_included_headers
from linkwright.review.sources.cpp.text import blank_comments
from linkwright.review.sources.default_names import find_default_reason, is_set_in_package
from linkwright.review.sources.details import (
    compare_computed,
    compare_details,
    find_required_reason,
    format_added_names,
    format_computed,
    format_name,
    format_names,
    format_rename,
    make_scope_reason,
)
from linkwright.review.sources.given_frames import find_given_frame, format_given, take_given
from linkwright.review.sources.hardware_interfaces import find_description_without
from linkwright.review.sources.inherited_names import drop_inherited, list_new_expressions
from linkwright.review.sources.interface_patterns import find_claim_reason
from linkwright.review.sources.lost_patterns import find_lost_pattern_reason
from linkwright.review.sources.merged_renames import merge_renames
from linkwright.review.sources.moved_names import find_moved_names
from linkwright.review.sources.name_patterns import ends_with_name, extract_pattern, lists_names
from linkwright.review.sources.names import (
    DYNAMIC_SUFFIX,
    PYTHON_SUFFIX,
    DefaultName,
    Detail,
    NameKind,
    SourceName,
    SourceNames,
)
from linkwright.review.sources.new_users import describe_new_user
from linkwright.review.sources.node_namespaces import have_same_full_name
from linkwright.review.sources.other_ends import describe_new_end, find_left_reason, is_served
from linkwright.review.sources.other_nodes import (
    find_other_node_reason,
    has_only_in_other_nodes,
    is_new_in_plugin,
)
from linkwright.review.sources.paired_names import PairedNames
from linkwright.review.sources.pairing import (
    compute_similarity,
    drop_replaceable,
    has_other_class,
    has_same_types,
    is_same_frame,
    take_pairs,
)
from linkwright.review.sources.parameter_defaults import SUM, split_sum
from linkwright.review.sources.parameter_scopes import find_scoped
from linkwright.review.sources.python.package_imports import (
    is_installed_package,
)
from linkwright.review.sources.reasons import (
    find_message_frame_reason,
    find_removal_reason,
    is_used_by_others,
    make_reader_reason,
)
from linkwright.review.sources.shared_constants import find_constant_users
from linkwright.review.sources.statement_changes import compare_statements
from linkwright.review.sources.statements.frame_changes import drop_told_frames
from linkwright.review.sources.statements.function_changes import (
    NameChange,
    find_field_reason,
    find_ignored_reason,
    merge_function_changes,
)
from linkwright.review.sources.statements.unmet_conditions import find_unmet_parameter
from linkwright.review.sources.type_variants import TypeVariants
from linkwright.review.sources.unused_publishers import is_unused_publisher
from linkwright.review.versions import Versions

_MAIN = "main"
"""The function of a program that its build file or its last statement names."""
_DECLARED_KINDS = (NameKind.CLASS, NameKind.FUNCTION, NameKind.MEMBER)
"""The kinds that matter to others only if they can import or include the source."""


def source_subjects(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[Subject]:
    """Yield the changed sources of nodes whose names differ.

    Moving a name to another file is not a change. Names that are expressions are compared by their
    text.
    """
    files = [file for file in changed_files if is_compared_source(versions, file)]
    files += [file for file in find_constant_users(versions, files) if is_compared_source(versions, file)]
    packages = find_renamed_packages(versions)
    new_packages = {item.old_name: item.new_name for item in packages if item.old_name != item.new_name}
    sides = (
        ChangedSources(versions.old, [file.old_path for file in files], new_packages),
        ChangedSources(versions.new, [file.new_path for file in files]),
    )
    sides[0].connect(sides[1])
    for file in files:
        pair = _SourcePair(*sides, file)
        problems = list(pair.find_problems())
        changes = list(pair.find_parse_failure()) if problems else list(pair.find_changes())
        if changes or problems:
            yield Subject(SubjectKind.SOURCE, file.path, file.old_path, file.new_path, changes, problems=problems)


class _SourcePair(PairedNames):
    """Both versions of a changed source, whose names are compared."""

    def find_changes(self) -> Iterator[Change]:
        """Yield the differences."""
        old_names, new_names = self.old.get_names(self.file.old_path), self.new.get_names(self.file.new_path)
        changes = [*self.find_added_header(), *self.find_emptied(), *self.find_unbuilt()]
        changes += [change for kind in NameKind for change in self._compare_kind(kind, old_names, new_names)]
        changes += self.compare_rates(old_names, new_names)
        changes += self.find_unused_parameters(new_names)
        for change in compare_conditions(old_names, new_names):
            path = (self.file.old_path if change.is_old else self.file.new_path) or self.file.path
            reason = self._find_condition_reason(change, new_names)
            effect = Effect.CHANGED if reason is None else Effect.BREAKING
            changes.append(Change(change.text, effect, reason, Location(path, change.line, 1, change.is_old)))
        changes += self.find_changed_senders(changes)
        changes += self.compare_imports(old_names, new_names)
        changes += self.find_undefined(old_names, new_names)
        changes += self.compare_header(old_names, new_names)
        changes += self.compare_definitions()
        changes += self.compare_packages(are_headers_told=not changes)
        changes += compare_statements(self.old, self.new, self.file, changes)
        changes += self.find_changed_options(changes)
        yield from merge_renames(drop_told_frames(changes))

    def _compare_kind(self, kind: NameKind, old_names: SourceNames, new_names: SourceNames) -> Iterator[Change]:
        """Yield the changes to the names of a kind."""
        before = {get_comparison_name(item): item for item in old_names.of_kind(kind)}
        after = {get_comparison_name(item): item for item in new_names.of_kind(kind)}
        scoped = find_scoped(before, after, old_names, new_names) if kind is NameKind.PARAMETER else []
        variants = TypeVariants(kind, old_names, new_names)
        shown = {get_comparison_name(item): item.type for _, item in scoped}  # the lines of these have their defaults
        changed = [
            NameChange(item, *detail)
            for name, item in after.items()
            if name in before and not has_same_types(before[name], item, old_names, new_names)
            for detail in compare_details(
                variants.align(
                    self._rename_type(replace(before[name], type=shown.get(name, before[name].type)), item), item
                ),
                item,
                has_other_class=has_other_class(before[name], item, old_names, new_names),
            )
        ]
        if kind is NameKind.PARAMETER:
            changed += self._compare_moved([item for name, item in before.items() if name not in after])
        yield from self._report_details(kind, changed, old_names)
        for old, new in scoped:
            reason = self._find_removal_reason([old], old_names)
            yield self.make_change(format_rename(old, new), new.span, self.new, reason)
        if not self._is_reported(kind):
            return
        path, old_path = self.file.path, self.file.old_path or self.file.path
        only_old = {name: item for name, item in before.items() if name not in after}
        only_new = {name: item for name, item in after.items() if name not in before}
        if kind in (*COMMUNICATION_KINDS, NameKind.PARAMETER):
            only_old = drop_inherited(only_old, self.new.get_inherited(self.file.new_path) if only_old else ())
            only_new = drop_inherited(only_new, self.old.get_inherited(self.file.old_path) if only_new else ())
        left = [item for item in only_old.values() if self._is_left_to_others(item)]
        removed = [item for item in only_old.values() if item in left or self.new.lacks(item, path)]
        is_new_node = self.file.old_path is None and (new_names.makes_node or path.endswith(DYNAMIC_SUFFIX))
        lacks = self.old.lacks
        if is_new_node and kind in (*COMMUNICATION_KINDS, NameKind.PARAMETER):
            lacks = self._did_not_lose  # report everything that a new node uses, even if another node uses it
        is_sole_node = kind is NameKind.NODE and len(before) == len(after) == 1
        if is_sole_node and only_new and self.old.lacks(next(iter(only_new.values())), old_path):
            removed = list(only_old.values())  # even if another node of the package has the old name
        is_sole_node = is_sole_node and bool(removed)
        added = [
            item
            for item in only_new.values()
            if is_sole_node
            or lacks(item, old_path)
            or has_only_in_other_nodes(item, self.old, self.new, (old_path, path))
            or is_new_in_plugin(item, self.old, self.new, (old_path, path))
        ]
        kept = [item for item in only_old.values() if item not in removed]
        for text, item, reason in find_moved_names(kept, self.old, self.new, self.file):
            yield self.make_change(text, item.span, self.old, reason)
        removed = [i for i in removed if i.name not in new_names.passed_on and not new_names.has_default(i)]
        added = [i for i in added if i.name not in old_names.passed_on and not old_names.has_default(i)]
        removed, added = self.select_reported(kind, removed, added, old_names, new_names)
        # a different source of the package still has these names, or already had them
        remaining_old = [
            item for item in only_old.values() if item not in removed and self.new.has_in_unchanged(item, path)
        ]
        existing_new = [
            item for item in only_new.values() if item not in added and self.old.has_in_unchanged(item, old_path)
        ]
        pairs = self.pair_names(kind, [*removed, *remaining_old], [*added, *existing_new])
        for old_item, new_item in pairs:
            is_harmless = old_item in remaining_old or is_same_frame(old_item, new_item)
            reason = None if is_harmless else self._find_rename_reason(old_item, new_item, old_names)
            yield self.make_change(format_rename(old_item, new_item), new_item.span, self.new, reason)
            removed = [item for item in removed if item is not old_item]
            added = [item for item in added if item is not new_item]
        yield from self._compare_expressions(kind, removed, added)
        yield from self._report_given_frame(removed, old_names, new_names)
        removed, added = [*removed, *variants.removed], [*added, *variants.added]
        yield from self._report_unpaired(kind, removed, added, old_names)

    def _did_not_lose(self, item: SourceName, path: str) -> bool:
        """Return whether no changed source lost a name of a new node, so that it did not move to the node."""
        if item.kind is NameKind.PARAMETER and self.old.generates(item.name, path):
            return False
        return self.old.count_owners(item, path) <= self.new.count_owners(item, path)

    def _rename_type(self, item: SourceName, new: SourceName) -> SourceName:
        """Return an old name with the new name of the package of its type, unless the new source has the old one."""
        is_renamed = bool(item.full_type) and item.full_type != new.full_type
        return replace(item, full_type=self.old.rename_type(item.full_type)) if is_renamed else item

    def _compare_moved(self, items: Sequence[SourceName]) -> Iterator[NameChange]:
        """Yield the changes to parameters that another changed source of the package declares now."""
        for item in items:
            moved = self.new.find_moved(item, self.file.path)
            if moved is not None and self.old.find_moved(item, self.file.old_path or self.file.path) is None:
                yield from (NameChange(moved, *detail) for detail in compare_details(item, moved))

    def _is_reported(self, kind: NameKind) -> bool:
        """Return whether removed and added names of a kind matter outside of the file."""
        old_path = self.file.old_path or self.file.path
        is_python_class = kind is NameKind.CLASS and self.file.path.endswith(PYTHON_SUFFIX)
        if kind in _DECLARED_KINDS and not is_python_class:
            return self.is_interface(old_path)
        if kind is NameKind.IMPORT:
            has_both = self.file.old_path is not None and self.file.new_path is not None
            return has_both and is_installed_package(self.old.version, self.old.find_package(old_path), old_path)
        return True

    def _report_details(
        self, kind: NameKind, changed: Sequence[NameChange], old_names: SourceNames
    ) -> Iterator[Change]:
        """Yield the changes to names that both versions have.

        Functions count only if other files can call them.
        """
        is_program = self.file.path.endswith(PYTHON_SUFFIX) and old_names.is_program
        is_called = bool(changed) and not is_program and self.is_interface(self.file.old_path or self.file.path)
        if kind in (NameKind.FUNCTION, NameKind.MEMBER) and not is_called:
            return
        if kind is NameKind.FUNCTION:
            changed = list(merge_function_changes(changed, is_python=self.file.path.endswith(PYTHON_SUFFIX)))
        for item, text, reason, detail in changed:
            if detail is Detail.ARGUMENTS and reason is None:
                reason = find_ignored_reason(item, old_names, self.new.get_names(self.file.new_path))
                reason = reason or find_field_reason(item, old_names)
            is_breaking = is_called or kind is not NameKind.CLASS
            is_breaking = is_breaking and (kind is not NameKind.FUNCTION or self.can_be_linked(item.name))
            if kind is NameKind.PARAMETER and reason is None:
                reason = self._find_parameter_reason(item, old_names)
            yield self.make_change(text, item.span, self.new, reason if is_breaking else None)

    def _find_parameter_reason(self, item: SourceName, old_names: SourceNames) -> Phrase | None:
        """Return the reason why another default of a parameter is breaking; None if it is not."""
        package = self.new.find_package(self.file.path)
        new_names = self.new.get_names(self.file.new_path)
        reason = find_default_reason(
            item.name,
            old_names,
            new_names,
            lambda lost: self._find_rename_reason(
                SourceName(lost.kind, lost.name, "", item.span), SourceName(lost.kind, "", "", item.span), old_names
            ),
        )
        return (
            None
            if reason is None or is_set_in_package(self.new.version, package, item.name, self.file.path)
            else reason
        )

    def _find_condition_reason(self, change: ConditionChange, new_names: SourceNames) -> Phrase | None:
        """Return the reason why a new condition is breaking: a parameter does not fulfill it by default, or None."""
        if change.is_old or change.kind is NameKind.PARAMETER:
            return None
        text = self.new.version.text(self.file.new_path or "")
        parameter = find_unmet_parameter(change.conditions, new_names, text)
        package = self.new.find_package(self.file.path)
        if parameter is None or is_set_in_package(self.new.version, package, parameter, self.file.path):
            return None
        return phrase("by default, {reason}", reason=names_reason(change.names))

    def _report_unpaired(
        self, kind: NameKind, removed: Sequence[SourceName], added: Sequence[SourceName], old_names: SourceNames
    ) -> Iterator[Change]:
        if not is_used_by_others(kind, self.file.path, old_names):
            return
        if kind in (NameKind.FUNCTION, NameKind.MEMBER) and self.file.old_path is None:
            is_module = self.file.path.endswith(PYTHON_SUFFIX)
            is_told = is_module or kind is NameKind.FUNCTION
            added = [item for item in added if is_told and item.name.isidentifier() and item.name != _MAIN]
        if added:
            text = phrase("{kind} added: {names}", kind=kind.plural, names=format_added_names(added))
            reason = self._find_required_reason(added) if self.file.old_path is not None else None
            reason = reason or find_claim_reason(added, self.read_texts()[0], self.new.get_names(self.file.new_path))
            yield self.make_change(text, added[0].span, self.new, reason)
        new_names = self.new.get_names(self.file.new_path)
        non_public = new_names.non_public | new_names.hidden_classes
        old_path = self.file.old_path or self.file.path
        unused = [item for item in removed if is_unused_publisher(item, old_names, self.old.version, old_path)]
        if unused:
            text = phrase("publishers that published nothing removed: {names}", names=format_names(unused))
            yield self.make_change(text, unused[0].span, self.old, None)
        lost = [item for item in removed if item.name not in non_public and item not in unused]
        if lost:
            text = phrase("{kind} removed: {names}", kind=kind.plural, names=format_names(lost))
            used = describe_new_user(text, lost, self.old, self.new, old_path)
            reason = None if used is not None else self._find_removal_reason(lost, old_names)
            change = self.make_change(used or text, lost[0].span, self.old, reason)
            topics = [item.name for item in lost if kind in (NameKind.PUBLISHER, NameKind.SUBSCRIPTION)]
            yield replace(change, lost_topics=tuple(topics))
        newly_hidden = [item for item in removed if item.name in non_public]
        if newly_hidden:
            text = phrase("{kind} no longer public: {names}", kind=kind.plural, names=format_names(newly_hidden))
            yield self.make_change(
                text, newly_hidden[0].span, self.old, self._find_removal_reason(newly_hidden, old_names)
            )

    def _find_required_reason(self, added: Sequence[SourceName]) -> Phrase | None:
        """Return the reason why added names are breaking, with a description that lacks a required element, or None."""
        reason = find_required_reason(added)
        if reason is None or added[0].kind is not NameKind.HARDWARE_ELEMENT:
            return reason
        classes = [item.name for item in self.new.get_names(self.file.new_path).of_kind(NameKind.PLUGINLIB_CLASS)]
        path = find_description_without(self.new.version, classes, [item.name for item in added])
        return reason if path is None else phrase("{reason}, such as {file}", reason=reason, file=path)

    def _is_left_to_others(self, item: SourceName) -> bool:
        """Return whether only other nodes of the package still have a name that they had before.

        A removed source leaves its names to others in another sense: what it offered is one line.
        """
        paths = self.file.path, self.file.old_path or self.file.path
        return self.file.new_path is not None and has_only_in_other_nodes(item, self.new, self.old, paths)

    def _find_removal_reason(self, items: Sequence[SourceName], names: SourceNames) -> Phrase | None:
        path = self.file.old_path or self.file.path
        if items[0].kind is NameKind.CLASS and not self.is_interface(path):
            return None
        is_used = items[0].kind in (*_DECLARED_KINDS, NameKind.IMPORT)
        if not is_used and self.is_not_started():
            return None
        if items[0].kind in _DECLARED_KINDS:
            items = [item for item in items if self.can_be_linked(item.name, item.kind)]
        if items and items[0].kind is NameKind.PARAMETER:
            items = [item for item in items if not self.is_unread_parameter(item.name)]
        lost = [item for item in items if not self._is_left_to_others(item)]
        if not lost:
            return find_other_node_reason(items) if items else None
        reason = find_removal_reason(lost, names, self.new.get_names(self.file.new_path), path)
        if lost[0].kind is NameKind.PARAMETER:
            readers = ((item.name, self.new.find_undeclared_reader(item, self.file.path)) for item in lost)
            return next((make_reader_reason(name, reader) for name, reader in readers if reader is not None), reason)
        return reason if reason is None else find_left_reason(lost, self.old, self.new, path) or reason

    def _find_rename_reason(self, old_item: SourceName, new_item: SourceName, names: SourceNames) -> Phrase | None:
        """Return the reason why a new name is breaking, or None.

        A new name of a client is breaking, unless a source of the new version serves it.
        """
        if old_item.kind is NameKind.MESSAGE_FRAME:
            return find_message_frame_reason(old_item, names)
        if self._is_same_name(old_item, new_item):
            return None
        if old_item.kind is NameKind.CLAIMED_INTERFACE:
            return find_claim_reason([new_item], self.read_texts()[0], self.new.get_names(self.file.new_path))
        reason = self._find_removal_reason([old_item], names)
        if old_item.name.strip("/") == new_item.name.strip("/"):
            return None if reason is None else make_scope_reason(old_item, new_item)  # absolute before, or absolute now
        path = self.file.path
        if old_item.kind in (NameKind.CLIENT, NameKind.ACTION_CLIENT):
            if is_served(new_item, self.new, path):
                return None
            reason = find_left_reason([old_item], None, self.new, path)
            if reason is None and new_item.name:  # else the default of a parameter, whose new value is not known here
                reason = phrase("servers that offer '{name}' get no requests", name=old_item.name)
        return describe_new_end(reason, old_item, new_item, self.old, self.new, path)

    # --- expressions ------------------------------------------------------------------------------------------------

    def _compare_expressions(
        self, kind: NameKind, removed: list[SourceName], added: list[SourceName]
    ) -> Iterator[Change]:
        """Yield the names that change between literal and expression.

        These names are removed from the lists.
        """
        old_names, new_names = self.old.get_names(self.file.old_path), self.new.get_names(self.file.new_path)
        sides = [[item for item in names.expressions if item.kind is kind] for names in (old_names, new_names)]
        removed_expressions = [item for item in sides[0] if all(item.name != other.name for other in sides[1])]
        added_expressions = [item for item in sides[1] if all(item.name != other.name for other in sides[0])]
        yield from self._compare_expression_types(*sides)
        yield from self._compare_prefixed(kind, removed, added_expressions)
        inherited = self.new.get_inherited(self.file.new_path) if removed_expressions else []
        candidates = [*added_expressions, *list_new_expressions(kind, inherited, sides[0])]
        for item in list(removed_expressions):  # a different expression for the same name
            matching = [expression for expression in candidates if expression.type == item.type]
            if matching:
                other = max(matching, key=lambda expression: compute_similarity(item, expression))
                removed_expressions.remove(item)
                candidates.remove(other)
                added_expressions = [expression for expression in added_expressions if expression is not other]
                yield from self._compare_patterns(item, other, [new_names, *inherited])
        for item, other in take_pairs(removed, added_expressions):
            text = format_computed(item, other.name, new_names.choices.get(other.name, ()))
            default = new_names.find_default(other)
            if default is not None:
                text = format_given(item, default)
            reason = self._find_default_reason(item, item.name, new_names.defaults.get(other.name, ""), old_names)
            if default is not None and not default.name:
                reason = self._find_lost_reason(item, old_names)
            if reason is None and not new_names.can_give(other, item.name) and not self._is_same_name(item, other):
                reason = self._find_removal_reason([item], old_names)
            yield self.make_change(text, other.span, self.new, reason)
        for item, other in take_pairs(added, removed_expressions):
            text = phrase(
                "{kind} {name} had a computed name: {old}", kind=kind.title, name=format_name(item), old=other.name
            )
            reason = self._find_default_reason(other, old_names.defaults.get(other.name, ""), item.name, old_names)
            yield self.make_change(text, item.span, self.new, reason)
        added_expressions, removed_expressions = (
            list({item.name: item for item in items}.values()) for items in (added_expressions, removed_expressions)
        )
        added_expressions = [
            item for item in added_expressions if self.new.count_expressions(item) > self.old.count_expressions(item)
        ]
        removed_expressions = [
            item for item in removed_expressions if self.old.count_expressions(item) > self.new.count_expressions(item)
        ]
        drop_replaceable(removed, added_expressions)
        added += take_given(added_expressions, new_names)
        if added_expressions:
            text = phrase(
                "{kind} with computed names added: {names}", kind=kind.plural, names=format_names(added_expressions)
            )
            yield self.make_change(text, added_expressions[0].span, self.new, None)
        if removed_expressions:
            text = phrase(
                "{kind} with computed names removed: {names}",
                kind=kind.plural,
                names=format_names(removed_expressions),
            )
            reason = find_lost_pattern_reason(removed_expressions, self.old, self.new, self.file.path)
            yield self.make_change(text, removed_expressions[0].span, self.old, reason)
            drop_replaceable(added, removed_expressions)

    def _report_given_frame(
        self, removed: list[SourceName], old_names: SourceNames, new_names: SourceNames
    ) -> Iterator[Change]:
        """Yield a line about a frame that a parameter gives now. It is removed from the list."""
        given = find_given_frame(removed, old_names, new_names, self.read_texts())
        if given is None:
            return
        item, default = removed.pop(), given.default
        reason = self._find_lost_reason(item, old_names)
        yield self.make_change(format_given(item, default), given.span, self.new, reason)

    def _compare_prefixed(self, kind: NameKind, removed: list[SourceName], added: list[SourceName]) -> Iterator[Change]:
        """Yield a line about two or more names that are computed now, because another text precedes them.

        These names are removed from the lists.
        """
        candidates = ((item, [it for it in added if ends_with_name(it.name, item.name)]) for item in removed)
        pairs = [(item, matching[0]) for item, matching in candidates if len(matching) == 1]
        if len(pairs) < 2 or len({id(new) for _, new in pairs}) < len(pairs):
            return
        for old, new in pairs:
            removed.remove(old)
            added.remove(new)
        names = joined_first([f"{format_name(old)} -> {new.name}" for old, new in pairs], MAX_NAMES)
        text = phrase("{kind} that have computed names now: {names}", kind=kind.plural, names=names)
        new_names = self.new.get_names(self.file.new_path)
        lost = [it for it, new in pairs if not new_names.can_give(new, it.name) and not self._is_same_name(it, new)]
        reason = self._find_removal_reason(lost, self.old.get_names(self.file.old_path)) if lost else None
        reason = reason or next(filter(None, (self._find_argument_reason(old, new) for old, new in pairs)), None)
        yield self.make_change(text, pairs[0][1].span, self.new, reason)

    def _find_argument_reason(self, old: SourceName, new: SourceName) -> Phrase | None:
        """Return the reason why it is breaking that the default of an argument is a part of a name now, or None."""
        path = self.file.new_path or self.file.path
        if new.kind not in GRAPH_KINDS or path.endswith(PYTHON_SUFFIX) or not self.has_library():
            return None
        headers = [blank_comments(text) for text in read_included_headers(self.new.version.file(path))]
        found = find_default_argument(new.name, new.span.line, blank_comments(self.read_texts()[1]), headers)
        if found is None or found.name.strip("/") == old.name.strip("/"):
            return None
        return phrase(
            "callers that do not pass '{argument}' use the name '{new}' instead of '{old}'",
            argument=found.argument,
            new=found.name,
            old=old.name,
        )

    def _is_same_name(self, old: SourceName, new: SourceName) -> bool:
        """Return whether a topic or the like has the same full name with the namespace of its node."""
        return old.kind in GRAPH_KINDS and have_same_full_name(old.name, new.name, *self.read_texts())

    def _find_lost_reason(self, item: SourceName, names: SourceNames) -> Phrase | None:
        """Return the reason why it is breaking that a parameter gives another name by default; None if it is not."""
        reason = self._find_rename_reason(item, replace(item, name=""), names)
        return None if reason is None else phrase("by default, {reason}", reason=reason)

    def _find_default_reason(self, item: SourceName, old: str, new: str, names: SourceNames) -> Phrase | None:
        """Return the reason why another name by default is breaking; None if it is unknown or equal."""
        is_same = not old or not new or old.lstrip("/") == new.lstrip("/")
        return None if is_same else self._find_removal_reason([replace(item, name=old)], names)

    def _compare_expression_types(self, old: Sequence[SourceName], new: Sequence[SourceName]) -> Iterator[Change]:
        """Yield the names whose expression is unchanged but whose type differs.

        Expressions of several names are left out.
        """
        sources = self.old.get_names(self.file.old_path), self.new.get_names(self.file.new_path)
        for item in new:
            matching = [[expression for expression in items if expression.name == item.name] for items in (old, new)]
            if len(matching[0]) == len(matching[1]) == 1 and matching[0][0].type and item.type:
                defaults = [names.defaults.get(item.name, "") for names in sources]
                for text, reason, _ in compare_computed(self._rename_type(matching[0][0], item), item, defaults):
                    yield self.make_change(text, item.span, self.new, reason)

    def _compare_patterns(self, old: SourceName, new: SourceName, sources: Sequence[SourceNames]) -> Iterator[Change]:
        """Yield the change of the texts in an expression for a name, or of the parameter that gives it by default.

        The new name is in one of the sources.
        """
        old_default = self.old.get_names(self.file.old_path).find_default(old)
        new_default = next(filter(None, (names.find_default(new) for names in sources)), None)
        if old_default is not None and new_default is not None:
            yield from self._compare_defaults(old, new, old_default, new_default)
            return
        patterns = extract_pattern(old.name), extract_pattern(new.name)
        parts = split_sum(old.name), split_sum(new.name)
        if old.name in parts[1] or new.name in parts[0]:
            yield self.make_change(format_rename(old, new), new.span, self.new, None)
            return
        if None in patterns or patterns[0] == patterns[1]:
            return
        reason = phrase("the name is a pattern; programs that use one of the old names do not find it")
        is_lost = self._find_removal_reason([old], self.old.get_names(self.file.old_path)) is not None
        is_listed = new.kind is NameKind.PARAMETER and lists_names(*patterns, self.read_texts()[1])
        is_lost = is_lost and not is_listed
        yield self.make_change(format_rename(old, new), new.span, self.new, reason if is_lost else None)

    def _compare_defaults(
        self, old: SourceName, new: SourceName, old_default: DefaultName, new_default: DefaultName
    ) -> Iterator[Change]:
        """Yield the name that another parameter gives now. Another default of the same parameter has its own line."""
        patterns = (
            old_default.pattern or f"<{old_default.parameter}>",
            new_default.pattern or f"<{new_default.parameter}>",
        )
        if patterns[0] == patterns[1] or old_default.name == new_default.name:
            return
        package = self.new.find_package(self.file.path)
        joined = new_default.parameter.split(SUM)  # a value that a file sets is only a part of the name now
        is_set = old_default.parameter not in joined and any(
            is_set_in_package(self.new.version, package, item.parameter, self.file.path)
            for item in (old_default, new_default)
        )
        names = self.old.get_names(self.file.old_path)
        reason = None if is_set else self._find_default_reason(old, old_default.name, new_default.name, names)
        reason = None if reason is None else phrase("by default, {reason}", reason=reason)
        has_sum = bool(old_default.pattern and new_default.pattern)
        shown = patterns if has_sum else (old_default.name, new_default.name)
        text = format_rename(replace(old, name=shown[0]), replace(new, name=shown[1]))
        yield self.make_change(text, new.span, self.new, reason)
