"""Compare all changed files with unexpanded descriptions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

from linkwright.diagnostics import LinkwrightError, Phrase, joined_first, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import FILE, MAX_NAMES, Change, Effect, ExpandedElement, Subject, SubjectKind
from linkwright.review.failures import make_problem
from linkwright.review.parts.contents import compare_contents
from linkwright.review.parts.include_graph import IncludeGraph, IncludeGraphs
from linkwright.review.parts.interface import (
    compare_arguments,
    compare_macros,
    find_renamed_macros,
    make_macro_removal_reason,
)
from linkwright.review.parts.item_comparisons import make_comparison
from linkwright.review.parts.left_uses import find_left_uses
from linkwright.review.parts.links_without_prefix import compare_links_without_prefix
from linkwright.review.parts.mesh_addresses import compare_mesh_addresses
from linkwright.review.parts.moved_to_callers import compare_moved_to_callers
from linkwright.review.parts.name_substitution import CALL, ComparedContent
from linkwright.review.parts.outline import MacroOutline, Outline, read_outline
from linkwright.review.parts.part_pair import PartPair
from linkwright.review.parts.properties import compare_properties
from linkwright.review.parts.readings import compare_readings
from linkwright.review.parts.unreadable_includes import includes_unreadable_file
from linkwright.review.parts.unused_parts import is_unused_part
from linkwright.review.parts.written_contents import MAX_MACROS, format_added_macro, format_written_contents
from linkwright.review.unprefixed_calls import compare_prefixes
from linkwright.review.versions import Version, Versions

_SUFFIXES = (".xacro", ".urdf", ".macro", ".gazebo", ".trans", ".inc")
"""The name endings of files with descriptions or parts of descriptions."""
_XACRO = ".xacro"
_SEMANTIC = ".srdf.xacro"
_UNREADABLE = "can no longer be read: {reason}"
"""The change to a robot whose new version fails to expand."""
_MIN_SIMILARITY = 0.5
"""The minimum share of equal elements of a renamed macro."""


def compare_parts(
    versions: Versions,
    files: Sequence[ChangedFile],
    subjects: Sequence[Subject],
    is_complete: Callable[[str], bool],
) -> list[Subject]:
    """Return the subjects with the changes in unexpanded descriptions.

    Changes that a compared robot shows are left out.

    Args:
        versions: the repository before and after the change.
        files: the changed files of the review.
        subjects: the subjects compared so far.
        is_complete: a function that returns whether a path is a complete robot.
    """
    expanded = {element for subject in subjects for element in subject.expanded}
    result = list(subjects)
    indexes = {subject.path: number for number, subject in enumerate(subjects)}
    shown = [subject.path for subject in subjects if subject.old_path is None and len(subject.changes) > 1]
    comparer = _Comparer(versions, files, expanded, shown, is_complete)
    for file in files:
        if not file.path.endswith(_SUFFIXES) or file.is_submodule:
            continue
        number = indexes.get(file.path)
        try:
            part = comparer.compare_file(file, is_compared=number is not None)
        except Exception as error:  # noqa: BLE001 - any error; the other files are still compared
            problems = [make_problem(error)]
            part = Subject(SubjectKind.PART, file.path, file.old_path, file.new_path, [], problems=problems)
        if number is None:
            result.append(part)
        else:
            existing = result[number]
            result[number] = replace(
                existing,
                changes=[*existing.changes, *part.changes],
                problems=list(dict.fromkeys([*existing.problems, *part.problems])),
            )
    return _add_left_uses(result, comparer.find_left_uses(files))


def _add_left_uses(subjects: Sequence[Subject], changes: Iterable[tuple[str, Change]]) -> list[Subject]:
    """Return the subjects with the uses of lost files and macros, except at a place that a robot cannot read."""
    unreadable = {
        (change.location.file, change.location.line)
        for subject in subjects
        for change in subject.changes
        if change.location is not None and change.sentence.template == _UNREADABLE
    }
    result = {subject.path: subject for subject in subjects}
    for path, change in changes:
        assert change.location is not None
        if (path, change.location.line) in unreadable:
            continue
        subject = result.get(path, Subject(SubjectKind.PART, path, path, path))
        result[path] = replace(subject, changes=[*subject.changes, change])
    return list(result.values())


class _Comparer:
    """Compare the changed files of a review, with the include graphs of both versions."""

    def __init__(
        self,
        versions: Versions,
        files: Sequence[ChangedFile],
        expanded: Collection[ExpandedElement],
        shown_robots: Collection[str],
        is_complete: Callable[[str], bool],
    ) -> None:
        self._versions = versions
        self._shown_robots = frozenset(shown_robots)
        self._files = files
        self._expanded = expanded
        self._is_complete = is_complete
        self._graphs = IncludeGraphs(IncludeGraph(versions.old), IncludeGraph(versions.new))

    def compare_file(self, file: ChangedFile, *, is_compared: bool) -> Subject:
        """Return a file with its changes.

        Args:
            file: the changed file.
            is_compared: whether the file is a complete robot that the review has already compared.
        """
        changes: list[Change] = []
        old = self._read_outline(self._versions.old, file.old_path)
        new = self._read_outline(self._versions.new, file.new_path)
        if not is_compared:
            graph = self._graphs.old if file.new_path is None else self._graphs.new
            is_unused = file.new_path is None and is_unused_part(self._versions.old, file.path)
            is_included = not is_unused and graph.is_included(file.path)
            changes += _compare_whole_file(file, old, new, is_included=is_included)
            if is_unused:
                return Subject(SubjectKind.PART, file.path, file.old_path, None, list(map(_make_harmless, changes)))
            if isinstance(new, Outline) and file.old_path is None:
                changes += self._report_added_file(file, new)
        if isinstance(old, Outline) and file.new_path is None and not is_compared:
            changes += _report_lost_macros(
                [name for name in old.macros if not self._graphs.new.find_files_with_macro(name)]
            )
        pair = self._make_pair(file)
        if pair is not None and file.old_path and file.new_path:
            pair.is_complete = is_compared or self._is_complete(file.new_path)
            pair.renamed_macros = self._renamed_macros
            pair.find_old_macros = self._graphs.old.find_macro_outlines
            pair.find_new_macros = self._graphs.new.find_macro_outlines
            pair.find_old_calls = self._graphs.old.find_calls
            pair.find_new_calls = self._graphs.new.find_call_places
            pair.robots = self._graphs.new.find_outlines_of_robots(file.new_path) or ()
            pair.defaults = self._graphs.new.find_defaults(file.new_path)
            self._compare(pair)
            if includes_unreadable_file(self._versions.old, file.old_path, pair.old):
                pair.changes = list(map(_make_harmless, pair.changes))
            changes += pair.changes
            versions = self._versions
            texts = versions.old.text(file.old_path), versions.new.text(file.new_path)
            changes += compare_prefixes(*texts, lambda: versions.old.macros, lambda: versions.new.macros)
        return Subject(SubjectKind.PART, file.path, file.old_path, file.new_path, changes)

    def _report_added_file(self, file: ChangedFile, outline: Outline) -> Iterator[Change]:
        """Yield the changes about the contents of an added file, unless a robot of the report shows them."""
        robots = self._graphs.new.find_robots_with(file.path)
        is_shown = ExpandedElement(file.path, FILE, is_old=False) in self._expanded
        if not is_shown and self._shown_robots.isdisjoint(robots) and not file.path.endswith(_SEMANTIC):
            contents = format_written_contents(outline)
            if contents is not None:
                yield Change(phrase("contains {contents}", contents=contents))
        yield from _report_added_macros(outline, lambda name: self._find_other_definitions(file.path, name))

    def _find_other_definitions(self, path: str, macro: str) -> list[str]:
        """Return the other files of the package of a file that define a macro, in both versions."""
        find_package = self._versions.new.package_of
        return [
            other
            for other in self._graphs.new.find_files_with_macro(macro)
            if other != path and find_package(other) == find_package(path)
            if macro in self._graphs.old.find_macros(other)
        ]

    def _make_pair(self, file: ChangedFile) -> PartPair | None:
        """Return both versions of a file, or None if one of them is missing or cannot be read."""
        old = self._read_outline(self._versions.old, file.old_path)
        new = self._read_outline(self._versions.new, file.new_path)
        if not (file.old_path and file.new_path and isinstance(old, Outline) and isinstance(new, Outline)):
            return None
        return PartPair(
            self._versions, file.old_path, file.new_path, old, new, is_complete=False, expanded=self._expanded
        )

    @cached_property
    def _renamed_macros(self) -> Mapping[str, str]:
        """The new names of the macros that the changed files rename, by old name."""
        files = [file for file in self._files if file.path.endswith(_SUFFIXES) and not file.is_submodule]
        pairs = (self._make_pair(file) for file in files)
        return {old: new for pair in pairs if pair is not None for old, new in _find_renamed_macros(pair)}

    def find_left_uses(self, files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
        """Yield the descriptions that use what the new version no longer has, each with a change."""
        changed = [file for file in files if file.path.endswith(_SUFFIXES) and not file.is_submodule]
        yield from find_left_uses(self._versions, changed, self._graphs)

    def _compare(self, pair: PartPair) -> None:
        renamed = dict(_find_renamed_macros(pair))
        if not pair.is_complete:
            compare_macros(pair, self._graphs, renamed)
        compare_arguments(pair, self._graphs)
        compare_properties(pair, self._graphs.new)
        compare_contents(pair, renamed)
        compare_mesh_addresses(pair)
        compare_links_without_prefix(pair)
        compare_moved_to_callers(pair, self._graphs, renamed)
        compare_readings(pair, self._graphs)

    def _read_outline(self, version: Version, path: str | None) -> Outline | Phrase | None:
        """Return the outline of a file, the reason why it cannot be read, or None for other files."""
        if path is None or not version.file(path).is_file():
            return None
        try:
            outline = read_outline(version.file(path), version.overlay)
        except LinkwrightError as error:
            return error.diagnostics[0].message
        return outline if path.endswith(_XACRO) or outline.is_description else None


def _find_renamed_macros(pair: PartPair) -> Iterator[tuple[str, str]]:
    """Yield the old and new names of renamed macros."""
    similarity: Mapping[tuple[str, str], float] = {
        (old.name, new.name): _compute_similarity(pair, old, new)
        for old in pair.old.macros.values()
        if old.name not in pair.new.macros
        for new in pair.new.macros.values()
        if new.name not in pair.old.macros
    }
    yield from find_renamed_macros(pair, similarity)


def _compute_similarity(pair: PartPair, old: MacroOutline, new: MacroOutline) -> float:
    """Return the share of equal elements of two macros, from 0 to 1; 0 if they are not similar.

    Calls of macros that only one version of the repository has are equal, because these may be renamed, too.
    """
    comparison = make_comparison(pair, old, new)
    names = pair.versions.old.macros ^ pair.versions.new.macros
    contents = [
        Counter(_mark_calls(substitution.normalize_element(child), names) for child in macro.element.elements())
        for substitution, macro in ((comparison.old, old), (comparison.new, new))
    ]
    total = sum(content.total() for content in contents)
    share = 2 * (contents[0] & contents[1]).total() / total if total else 0.0
    return share if share >= _MIN_SIMILARITY else 0.0


def _mark_calls(content: ComparedContent, macros: Collection[str]) -> ComparedContent:
    """Return the contents of an element with the same tag for calls of all macros with the given names."""
    tag = CALL if content.tag.removeprefix(CALL) in macros else content.tag
    return content._replace(tag=tag, children=tuple(_mark_calls(child, macros) for child in content.children))


def _make_harmless(change: Change) -> Change:
    return replace(change, effect=Effect.CHANGED, reason=None)


def _report_lost_macros(names: Sequence[str]) -> Iterator[Change]:
    """Yield the change that macros were removed with their file."""
    if names:
        text = phrase("macro '{name}' removed", name=names[0])
        yield Change(text, Effect.BREAKING, make_macro_removal_reason(), other_names=tuple(names[1:]))


def _report_added_macros(outline: Outline, find_others: Callable[[str], Sequence[str]]) -> Iterator[Change]:
    """Yield the changes that macros were added with their file, few of them with their parameters and contents.

    Args:
        outline: the added file.
        find_others: a function that returns the other files which define a macro.
    """
    macros = list(outline.macros.values())
    if len(macros) > MAX_MACROS:
        yield Change(format_added_macro(macros[0], shows_contents=False), other_names=tuple(outline.macros)[1:])
        return
    for macro in macros:
        text = format_added_macro(macro, shows_contents=True)
        others = find_others(macro.name)
        if others:
            text = phrase("{change}; also defined by {names}", change=text, names=joined_first(others, MAX_NAMES))
        yield Change(text)


def _compare_whole_file(
    file: ChangedFile, old: Outline | Phrase | None, new: Outline | Phrase | None, *, is_included: bool
) -> Iterator[Change]:
    """Yield the changes to a part as a whole: added, removed, renamed, or unreadable.

    Args:
        file: the changed file.
        old: the old outline, or the reason why it cannot be read.
        new: the new outline, or the reason why it cannot be read.
        is_included: whether a description of the version with the file may include it.
    """
    reason = phrase("launch files and descriptions that name the file do not find it")
    is_semantic = file.path.endswith(_SEMANTIC)
    if isinstance(old, Outline) and file.new_path is None:
        text = phrase("included description file removed") if is_included else phrase("description file removed")
        yield Change(phrase("semantic description removed") if is_semantic else text, Effect.BREAKING, reason)
    elif isinstance(old, Outline) and file.old_path and file.old_path != file.new_path:
        yield Change(phrase("renamed from {path}", path=file.old_path), Effect.BREAKING, reason)
    if isinstance(new, Outline) and file.old_path is None:
        text = phrase("included description file added") if is_included else phrase("description file added")
        yield Change(phrase("semantic description added") if is_semantic else text)
    if isinstance(old, Outline) and new is not None and not isinstance(new, Outline):
        text = phrase("the file can no longer be read: {reason}", reason=new)
        yield Change(text, Effect.BREAKING, phrase("descriptions that include the file cannot be expanded"))
