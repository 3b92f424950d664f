"""Compare the sources of nodes: topics, services, actions, parameters, frames, options and classes."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from difflib import SequenceMatcher
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, Span, joined_first, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.review.changes import MAX_NAMES, Change, Effect, Location, Problem, Subject, SubjectKind
from linkwright.review.installed_paths import is_exported_header
from linkwright.review.sources.callbacks import with_same_callback
from linkwright.review.sources.changed_sources import COMMUNICATION_KINDS, ChangedSources, comparison_name
from linkwright.review.sources.changed_values import value_changes
from linkwright.review.sources.code import Code
from linkwright.review.sources.code_changes import code_change
from linkwright.review.sources.details import detail_changes
from linkwright.review.sources.name_patterns import pattern_of
from linkwright.review.sources.names import (
    PYTHON_SUFFIX,
    YES,
    Detail,
    NameKind,
    SourceName,
    SourceNames,
)
from linkwright.review.sources.package_imports import find_failing_imports, is_installed_module, is_installed_package
from linkwright.review.sources.reading import is_program_text
from linkwright.review.sources.reasons import is_used_by_others, removal_reason
from linkwright.review.sources.shared_constants import users_of_changed_constants
from linkwright.review.sources.unchanged_sources import user_reason
from linkwright.review.versions import TEST_FOLDERS, Versions

_SKIPPED = frozenset({"setup.py", "conf.py"})
_MAX_ARGUMENTS = 80
"""The maximum number of characters of shown arguments of an added function or class."""
_MAX_FUNCTIONS = 3
"""The maximum number of functions with changed arguments in a file that have lines of their own."""
_UNITS = re.compile(
    r"\b(?:ros|rospy|rclcpp|rclpy|std|chrono|(?:nano|micro|milli)?seconds|duration|Duration|from_sec|to_sec|n?secs|"
    r"[num]?s|Hz|from_seconds|float|int)\b"
)
_MIN_SIMILARITY = 0.6
"""The minimum ratio of equal characters of similar names of the same kind."""
_MAX_COMPARED = 10_000
"""The maximum number of pairs of names among which similar names are searched."""
_UNTYPED = (NameKind.PARAMETER, NameKind.ELEMENT, NameKind.CLASS, NameKind.FUNCTION, NameKind.OPTION)
"""The kinds whose names are not alike because their types are equal."""
_DECLARED = (NameKind.CLASS, NameKind.FUNCTION, NameKind.MEMBER)
"""The kinds that matter to others only if they can import or include the source."""


def source_subjects(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[Subject]:
    """Yield the changed sources of nodes whose names differ.

    Moving a name to another file is not a change. Names that are expressions are compared by their
    text.
    """
    files = [file for file in changed_files if _is_source(versions, file)]
    files += [file for file in users_of_changed_constants(versions, files) if _is_source(versions, file)]
    sides = (
        ChangedSources(versions.old, [file.old_path for file in files]),
        ChangedSources(versions.new, [file.new_path for file in files]),
    )
    for file in files:
        pair = _Pair(*sides, file)
        problems = list(pair.problems())
        changes = list(pair.lost_source()) if problems else list(pair.changes())
        if changes or problems:
            yield Subject(SubjectKind.SOURCE, file.path, file.old_path, file.new_path, changes, problems=problems)


def _is_source(versions: Versions, file: ChangedFile) -> bool:
    path = PurePosixPath(file.path)
    if path.name in _SKIPPED or path.name.startswith(("test_", ".")) or file.is_submodule:
        return False
    if not TEST_FOLDERS.isdisjoint(path.parts) or is_launch_file_name(path.name):
        return False
    version = versions.new if file.new_path else versions.old
    return is_program_text(version.file(file.path))


@dataclass(frozen=True)
class _Pair:
    """Both versions of a changed source.

    Attributes:
        old: the names of the old version.
        new: the names of the new version.
        file: the source.
    """

    old: ChangedSources
    new: ChangedSources
    file: ChangedFile

    def changes(self) -> Iterator[Change]:
        """Yield the differences."""
        old_names, new_names = self.old.names(self.file.old_path), self.new.names(self.file.new_path)
        changes = [change for kind in NameKind for change in self._changes_of(kind, old_names, new_names)]
        changes += self._rate_changes(old_names, new_names)
        changes += self._import_changes(old_names, new_names)
        changes += self._undefined_changes(old_names, new_names)
        if self.file.old_path is not None and self.file.new_path is not None:
            old_path, new_path = self.old.version.file(self.file.old_path), self.new.version.file(self.file.new_path)
            reported = [str(change.sentence) for change in changes]
            values = value_changes(old_path, new_path, reported)
            changes += [self._change(text, span, self.new, None) for text, span in values]
            changes += self._code_changes(self.file.old_path, self.file.new_path, changes)
        yield from changes

    def _code_changes(self, old_path: str, new_path: str, reported: Sequence[Change]) -> Iterator[Change]:
        """Yield the functions whose code changes, unless other lines report it."""
        old, new = self.old.codes.get(old_path), self.new.codes.get(new_path)
        if not old or not new:
            return

        def has_moved(name: str, code: Code) -> bool:
            side, path = (self.new, new_path) if code is old else (self.old, old_path)
            return side.has_function(name, code, path)

        change = code_change(old, new, reported, has_moved, self.new.names(new_path))
        if change is not None:
            location = Location(old_path if change.is_old else new_path, change.line, 1, change.is_old)
            yield Change(change.text, location=location)

    def problems(self) -> Iterator[Problem]:
        """Yield the reason why the names of one version are unknown, if the names of the other version are known."""
        lines = [
            self.old.names(self.file.old_path).error_line,
            self.new.names(self.file.new_path).error_line,
        ]
        if None in (self.file.old_path, self.file.new_path) or bool(lines[0]) == bool(lines[1]):
            return
        if lines[0]:
            text = phrase("the old version has a syntax error in line {line}; its names are not known", line=lines[0])
            yield Problem(text, is_of_old=True)
        else:
            yield Problem(
                phrase("the new version has a syntax error in line {line}; its names are not known", line=lines[1])
            )

    def lost_source(self) -> Iterator[Change]:
        """Yield the change that the new version cannot be parsed, unless another version of Python may parse it."""
        names = self.new.names(self.file.new_path)
        if names.error_line and names.is_error_certain:
            text = phrase("cannot be parsed any more")
            reason = phrase("programs that run or import the file fail")
            yield Change(text, Effect.BREAKING, reason, Location(self.file.path, names.error_line, 1))

    def _changes_of(self, kind: NameKind, old_names: SourceNames, new_names: SourceNames) -> Iterator[Change]:
        before = {comparison_name(item): item for item in old_names.of_kind(kind)}
        after = {comparison_name(item): item for item in new_names.of_kind(kind)}
        changed = [(item, *detail) for name, item in after.items() if name in before
                   for detail in detail_changes(before[name], item)]  # fmt: skip
        yield from self._detail_changes(kind, changed, old_names)
        is_python = self.file.path.endswith(PYTHON_SUFFIX)
        path = self.file.path
        removed = [item for name, item in before.items() if name not in after and self.new.lacks(item, path)]
        old_path = self.file.old_path or path
        is_lacking = self.old.lacks
        if self.file.old_path is None and new_names.makes_node and kind in (*COMMUNICATION_KINDS, NameKind.PARAMETER):
            is_lacking = self.old.lacks_in_changed  # what a new node uses matters although another one uses it, too
        is_only = kind is NameKind.NODE and len(before) == len(after) == 1 and bool(removed)
        added = [item for name, item in after.items() if name not in before and (is_only or is_lacking(item, old_path))]
        is_told = kind is NameKind.CLASS and is_python
        if kind in _DECLARED and not is_told and not self._is_interface(old_path):
            return
        if kind is NameKind.IMPORT:
            if None in (self.file.old_path, self.file.new_path) or not is_installed_package(
                self.old.version, self.old.package(old_path), old_path
            ):
                return
            removed, added = _other_imports(removed, new_names), _other_imports(added, old_names)
        if kind in (NameKind.FUNCTION, NameKind.MEMBER) and not is_python:
            classes = [{item.name for item in names.of_kind(NameKind.CLASS)} for names in (old_names, new_names)]
            removed = [item for item in removed if _has_class(item, classes[0] & classes[1])]
            added = [item for item in added if _has_class(item, classes[0] & classes[1])]
        if kind is NameKind.FUNCTION and is_python:
            is_installed = is_installed_module(self.old.version, self.old.package(old_path), old_path)
            plain = old_names.plain_classes & new_names.plain_classes if is_installed else set()
            removed = [item for item in removed if _is_method_of(item, plain)]
            added = [item for item in added if _is_method_of(item, plain)]
        kept = [item for name, item in before.items() if name not in after and self.new.keeps(item, path)]
        used = [item for name, item in after.items() if name not in before and self.old.keeps(item, old_path)]
        pairs = with_same_callback([*removed, *kept], [*added, *used], old_names, new_names)
        if kind is NameKind.FUNCTION:
            pairs = list(self._with_same_code(removed, added))
        taken = [item for pair in pairs for item in pair]
        rest = [[item for item in items if item not in taken] for items in ([*removed, *kept], [*added, *used])]
        for old_item, new_item in [*pairs, *_pair_renamed(*rest)]:
            text = phrase(
                "{kind} {old} renamed to {new}", kind=kind.title, old=_name_text(old_item), new=_name_text(new_item)
            )
            is_same = kind is NameKind.FRAME and old_item.name.strip("/") == new_item.name.strip("/")
            # tf takes both names for the same
            reason = None if is_same or old_item in kept else self._rename_reason(old_item, new_item, old_names)
            yield self._change(text, new_item.span, self.new, reason)
            removed = [item for item in removed if item is not old_item]
            added = [item for item in added if item is not new_item]
        yield from self._expression_changes(kind, removed, added)
        yield from self._lone_changes(kind, removed, added, old_names)

    def _with_same_code(
        self, removed: Sequence[SourceName], added: Sequence[SourceName]
    ) -> Iterator[tuple[SourceName, SourceName]]:
        """Yield the removed and added functions with equal arguments and code, unless several are alike."""
        old, new = self.old.codes.get(self.file.old_path or ""), self.new.codes.get(self.file.new_path or "")
        if old is None or new is None:
            return
        for item in removed:
            body = old.body(item.name)
            same = [other for other in added if other.details == item.details and new.body(other.name) == body]
            if body and len(same) == 1 and sum(old.body(other.name) == body for other in removed) == 1:
                yield item, same[0]

    def _detail_changes(
        self, kind: NameKind, changed: Sequence[tuple[SourceName, Phrase, Phrase | None]], old_names: SourceNames
    ) -> Iterator[Change]:
        """Yield the changes of names that both versions have. Functions count only if other files can call them."""
        is_program = self.file.path.endswith(PYTHON_SUFFIX) and old_names.is_program
        is_called = not is_program and self._is_interface(self.file.old_path or self.file.path)
        if kind in (NameKind.FUNCTION, NameKind.MEMBER) and not is_called:
            return
        if kind is NameKind.FUNCTION and len(changed) > _MAX_FUNCTIONS:
            yield self._merged_functions(changed)
            return
        for item, text, reason in changed:
            is_breaking = is_called or kind is not NameKind.CLASS
            yield self._change(text, item.span, self.new, reason if is_breaking else None)

    def _merged_functions(self, changed: Sequence[tuple[SourceName, Phrase, Phrase | None]]) -> Change:
        """Return one change for many functions whose arguments changed."""
        names = joined_first(dict.fromkeys(item.name for item, _, _ in changed), MAX_NAMES)
        text = phrase("functions with other arguments: {names}", names=names)
        reason = next((reason for _, _, reason in changed if reason is not None), None)
        if reason is not None:
            reason = phrase("code that calls them with the old arguments does not build")
            if self.file.path.endswith(PYTHON_SUFFIX):
                reason = phrase("programs that call them with the old arguments fail")
        return self._change(text, changed[0][0].span, self.new, reason)

    def _is_interface(self, path: str) -> bool:
        """Return whether other packages can use the definitions of a file: it is a module or an installed header."""
        package = self.old.package(path)
        if path.endswith(PYTHON_SUFFIX):
            return package is not None and (self.old.version.file(path).parent / "__init__.py").is_file()
        return package is not None and is_exported_header(self.old.version, package, path)

    def _lone_changes(
        self, kind: NameKind, removed: Sequence[SourceName], added: Sequence[SourceName], old_names: SourceNames
    ) -> Iterator[Change]:
        if not is_used_by_others(kind, self.file.path, old_names):
            return
        if added and (kind not in (NameKind.FUNCTION, NameKind.MEMBER) or self.file.old_path is not None):
            text = phrase("{kind} added: {names}", kind=kind.plural, names=_names_text(added))
            reason = _required_reason(added) if self.file.old_path is not None else None
            yield self._change(text, added[0].span, self.new, reason)
        hidden = self.new.names(self.file.new_path).hidden
        lost = [item for item in removed if item.name not in hidden]
        if lost:
            text = phrase("{kind} removed: {names}", kind=kind.plural, names=_names_text(lost))
            yield self._change(text, lost[0].span, self.old, self._removal_reason(lost, old_names))
        kept = [item for item in removed if item.name in hidden]
        if kept:
            text = phrase("{kind} not public any more: {names}", kind=kind.plural, names=_names_text(kept))
            yield self._change(text, kept[0].span, self.old, self._removal_reason(kept, old_names))

    def _removal_reason(self, items: Sequence[SourceName], names: SourceNames) -> Phrase | None:
        path = self.file.old_path or self.file.path
        if items[0].kind is NameKind.CLASS and not self._is_interface(path):
            return None
        reason = removal_reason(items, names, path)
        users = ((item, self.new.user(item, path)) for item in (items if reason is not None else ()))
        return next((user_reason(item.kind, user, item.name) for item, user in users if user is not None), reason)

    def _rename_reason(self, old_item: SourceName, new_item: SourceName, names: SourceNames) -> Phrase | None:
        """Return the reason why a new name is breaking. For a client, it is if the package serves only the old name."""
        reason = self._removal_reason([old_item], names)
        if reason is not None or old_item.kind not in (NameKind.CLIENT, NameKind.ACTION_CLIENT):
            return reason
        path = self.file.path
        server = None if self.new.user(new_item, path) is not None else self.new.user(old_item, path)
        return None if server is None else user_reason(old_item.kind, server, old_item.name)

    # --- expressions ------------------------------------------------------------------------------------------------

    def _expression_changes(
        self, kind: NameKind, removed: list[SourceName], added: list[SourceName]
    ) -> Iterator[Change]:
        """Yield the names that change between literal and expression, and remove them from the lists."""
        old_names, new_names = self.old.names(self.file.old_path), self.new.names(self.file.new_path)
        sides = [[item for item in names.expressions if item.kind is kind] for names in (old_names, new_names)]
        removed_expressions = [item for item in sides[0] if all(item.name != other.name for other in sides[1])]
        added_expressions = [item for item in sides[1] if all(item.name != other.name for other in sides[0])]
        yield from self._expression_types(*sides)
        for item in list(removed_expressions):  # another expression for the same thing
            same = [expression for expression in added_expressions if expression.type == item.type]
            if same:
                other = max(same, key=lambda expression: _name_similarity(item, expression))
                removed_expressions.remove(item)
                added_expressions.remove(other)
                yield from self._changed_pattern(item, other)
        for item, other in _take_pairs(removed, added_expressions):
            text = phrase(
                "{kind} {name} has a computed name now: {new}", kind=kind.title, name=_name_text(item), new=other.name
            )
            reason = self._default_reason(item, item.name, new_names.defaults.get(other.name, ""), old_names)
            yield self._change(text, other.span, self.new, reason)
        for item, other in _take_pairs(added, removed_expressions):
            text = phrase(
                "{kind} {name} had a computed name: {old}", kind=kind.title, name=_name_text(item), old=other.name
            )
            reason = self._default_reason(other, old_names.defaults.get(other.name, ""), item.name, old_names)
            yield self._change(text, item.span, self.new, reason)
        added_expressions = [item for item in added_expressions if self.new.count(item) > self.old.count(item)]
        removed_expressions = [item for item in removed_expressions if self.old.count(item) > self.new.count(item)]
        if added_expressions:
            text = phrase(
                "{kind} with computed names added: {names}", kind=kind.plural, names=_names_text(added_expressions)
            )
            yield self._change(text, added_expressions[0].span, self.new, None)
            removed.clear()
        if removed_expressions:
            text = phrase(
                "{kind} with computed names removed: {names}", kind=kind.plural, names=_names_text(removed_expressions)
            )
            yield self._change(text, removed_expressions[0].span, self.old, None)
            added.clear()

    def _default_reason(self, item: SourceName, old: str, new: str, names: SourceNames) -> Phrase | None:
        """Return the reason why another name by default is breaking, or None if it is unknown or equal."""
        is_same = not old or not new or old.lstrip("/") == new.lstrip("/")
        return None if is_same else self._removal_reason([replace(item, name=old)], names)

    def _expression_types(self, old: Sequence[SourceName], new: Sequence[SourceName]) -> Iterator[Change]:
        """Yield the names with the same expression but another type, if only one name has the expression."""
        for item in new:
            same = [[expression for expression in items if expression.name == item.name] for items in (old, new)]
            if len(same[0]) == len(same[1]) == 1 and same[0][0].type != item.type and same[0][0].type and item.type:
                ((_, text, reason),) = ((item, *change) for change in detail_changes(same[0][0], item))
                yield self._change(text, item.span, self.new, reason)

    def _changed_pattern(self, old: SourceName, new: SourceName) -> Iterator[Change]:
        """Yield the change of the texts in an expression for a name."""
        patterns = pattern_of(old.name), pattern_of(new.name)
        if None in patterns or patterns[0] == patterns[1]:
            return
        text = phrase("{kind} {old} renamed to {new}", kind=new.kind.title, old=_name_text(old), new=_name_text(new))
        reason = phrase("the name is a pattern; programs that use one of the old names do not find it")
        is_lost = self._removal_reason([old], self.old.names(self.file.old_path)) is not None
        yield self._change(text, new.span, self.new, reason if is_lost else None)

    def _rate_changes(self, old_names: SourceNames, new_names: SourceNames) -> Iterator[Change]:
        """Yield the changed rates and periods, if both versions have equally many, and all rates of a new node."""
        old_rates, new_rates = old_names.rates, new_names.rates
        if self.file.old_path is None and new_rates and new_names.makes_node:
            texts = joined_first(dict.fromkeys(text for text, _ in new_rates), MAX_NAMES)
            yield self._change(phrase("rates and periods: {texts}", texts=texts), new_rates[0][1], self.new, None)
        if len(old_rates) != len(new_rates):
            return
        for (old_text, _), (new_text, span) in zip(old_rates, new_rates, strict=True):
            is_same_call = old_text.partition("(")[0] == new_text.partition("(")[0]
            if is_same_call and old_text != new_text and (_is_number(old_text) or _is_number(new_text)):
                text = phrase("rate or period: {old} -> {new}", old=old_text, new=new_text)
                yield self._change(text, span, self.new, None)

    def _import_changes(self, old_names: SourceNames, new_names: SourceNames) -> Iterator[Change]:
        """Yield new absolute imports of modules of the same package. They fail once the package is installed."""
        path = self.file.new_path or ""
        package = self.new.package(path)
        if package is None or not is_installed_package(self.new.version, package, path):
            return
        before = {name for name, _ in old_names.absolute_imports}
        for index in find_failing_imports(self.new.version, package, path, new_names):
            name, span = new_names.absolute_imports[index]
            if name not in before:
                text = phrase("absolute import of '{name}', a module of the same package", name=name)
                yield self._change(text, span, self.new, phrase("the package cannot be imported once it is installed"))

    def _undefined_changes(self, old_names: SourceNames, new_names: SourceNames) -> Iterator[Change]:
        """Yield the names and methods that are still used but no longer defined or imported."""
        for name, span in new_names.undefined.items() if self.file.old_path is not None else ():
            if name in old_names.bound:
                text = phrase("'{name}' is used, but nothing defines or imports it any more", name=name)
                yield self._change(text, span, self.new, phrase("the code that uses the name fails"))
        for name, span in new_names.undefined_methods.items():
            if name in old_names.attributes:
                text = phrase("calls its method '{name}', which nothing defines any more", name=name)
                yield self._change(text, span, self.new, phrase("the call fails"))

    @staticmethod
    def _change(text: Phrase, span: Span, side: ChangedSources, reason: Phrase | None) -> Change:
        path = side.version.relative(span.file)
        location = None if path is None else Location(path, span.line, span.column, side.version.is_old)
        return Change(text, Effect.CHANGED if reason is None else Effect.BREAKING, reason, location)


def _is_number(rate: str) -> bool:
    """Return whether the argument of a rate has no names except units."""
    argument = rate.partition("(")[2]
    return re.search(r"[A-Za-z_]{2,}", _UNITS.sub("", re.sub(r"(\d)[a-z]+", r"\1", argument))) is None


def _name_text(item: SourceName) -> str:
    """Return a name with its message type, the default of a parameter, or the arguments of a function."""
    arguments = dict(item.details).get(Detail.ARGUMENTS, "()")
    if arguments != "()" and len(arguments) <= _MAX_ARGUMENTS:
        return f"'{item.name}' {arguments}"
    return f"'{item.name}' ({item.type})" if item.type else f"'{item.name}'"


def _names_text(items: Sequence[SourceName]) -> Phrase:
    return joined_first(map(_name_text, items), MAX_NAMES)


def _required_reason(items: Sequence[SourceName]) -> Phrase | None:
    """Return the reason why added names are breaking, or None if none of them is required."""
    names = [item.name for item in items if (Detail.REQUIRED, YES) in item.details]
    if not names:
        return None
    if items[0].kind is NameKind.FUNCTION:
        return phrase("classes that derive from the class and do not define it do not build")
    return phrase("callers that do not pass '{name}' get an error", name=joined_first(names, MAX_NAMES))


def _other_imports(items: Sequence[SourceName], names: SourceNames) -> list[SourceName]:
    """Return the imported names that the other version of the file neither defines nor may import by ``*``."""
    defined = {item.name for kind in (NameKind.CLASS, NameKind.FUNCTION) for item in names.of_kind(kind)}
    return [] if names.has_star else [item for item in items if item.name not in defined]


def _has_class(function: SourceName, classes: Collection[str]) -> bool:
    """Return whether a C++ function is in one of the given classes or in no class."""
    names = function.name.split("::")[:-1]
    return not names or names[-1] in classes


def _is_method_of(function: SourceName, classes: Collection[str]) -> bool:
    """Return whether a Python function is a method of one of the given classes or no method."""
    class_name, _, _ = function.name.rpartition(".")
    return not class_name or class_name in classes


def _pair_renamed(removed: Sequence[SourceName], added: Sequence[SourceName]) -> list[tuple[SourceName, SourceName]]:
    """Return the pairs of a removed and an added name of the same thing.

    A pair is a single removed and added name that are alike, the only names of a type, or the most similar names.
    """
    pairs: list[tuple[SourceName, SourceName]] = []
    if len(removed) == len(added) == 1:
        (old,), (new,) = removed, added
        has_types = old.kind not in _UNTYPED
        is_same = old.type == new.type and (has_types or bool(old.type))
        return [(old, new)] if is_same or _name_similarity(old, new) >= _MIN_SIMILARITY else []
    rest = list(added)
    is_compared = len(removed) * len(added) <= _MAX_COMPARED
    for item in removed:
        similar = [candidate for candidate in rest if _has_compatible_type(item, candidate)] if is_compared else []
        candidates = [candidate for candidate in similar if _name_similarity(item, candidate) >= _MIN_SIMILARITY]
        same = [
            [candidate for candidate in items if candidate.type == item.type and item.type] for items in (removed, rest)
        ]
        is_typed = item.kind not in (NameKind.PARAMETER, NameKind.ELEMENT, NameKind.MEMBER)
        if is_typed and len(same[0]) == len(same[1]) == 1:
            candidates = same[1]
        if candidates:
            best = max(candidates, key=lambda candidate: _name_similarity(item, candidate))
            pairs.append((item, best))
            rest.remove(best)
    return pairs


def _take_pairs(literals: list[SourceName], expressions: list[SourceName]) -> Iterator[tuple[SourceName, SourceName]]:
    """Remove the names and expressions that are probably the same thing from both lists, and yield them as pairs."""
    for item in list(literals):
        is_only = len(literals) == len(expressions) == 1
        other = next((expression for expression in expressions if is_only or expression.type == item.type), None)
        if other is not None:
            literals.remove(item)
            expressions.remove(other)
            yield item, other


def _has_compatible_type(old: SourceName, new: SourceName) -> bool:
    return old.type == new.type or not old.type or not new.type


def _name_similarity(old: SourceName, new: SourceName) -> float:
    old_name, new_name = (item.name.rpartition("::")[2].casefold() for item in (old, new))
    return SequenceMatcher(None, old_name, new_name, autojunk=False).ratio()
