"""Compare launch files: their arguments, nodes and included files, with their settings."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from difflib import SequenceMatcher

from linkwright.diagnostics import Phrase, counted, phrase
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.review.breaking import name_reason
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.effects import addition_reason, removal_reason
from linkwright.review.launches.file_choices import FileChoices
from linkwright.review.launches.included import IncludedActions, callers_of, file_with_moved_action
from linkwright.review.launches.matching import MIN_SIMILARITY, find_replacements, match_entries
from linkwright.review.launches.outlines import READING, SERVER_PARAMETER, CodePart, Entry, LaunchOutline
from linkwright.review.launches.readers_of_environment import reader_of
from linkwright.review.launches.reading import read_outline
from linkwright.review.launches.renames import find_renamed_names, rename_in_entry, rename_in_outline
from linkwright.review.launches.settings import SettingChanges
from linkwright.review.launches.titles import added_entry_text, join_titles, removed_entry_text, title
from linkwright.review.launches.transforms import other_publisher
from linkwright.review.launches.unused_arguments import report_unused_arguments
from linkwright.review.list_changes import differing_excerpts, shorten
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.sources.reading import read_source_names

_MAX_SOURCE = 120
"""The maximum number of characters of a statement that are shown."""
_MAX_STATEMENTS = 3
"""The maximum number of changed statements that are shown separately."""
_VARIABLE = re.compile(r"(?<=\bname )\w+\b|(?<=\barg=')\w+\b(?=')")
"""The names of variables and parameters in the texts of statements."""


def compare_launch_files(pair: FilePair) -> None:
    """Compare two versions of a launch file, without running them."""
    roots = {pair.old_file: pair.versions.old.root, pair.new_file: pair.versions.new.root}
    outlines = pair.read(lambda path: read_outline(path, roots[path]))
    if outlines is None:
        return
    old, new = outlines
    undeclared = _undeclared_arguments(pair, old, new)
    renamed = find_renamed_names(old, new)
    old = rename_in_outline(old, renamed)
    old_names = {new_name: old_name for old_name, new_name in renamed.items()}
    included = (
        IncludedActions(pair.versions.old, pair.old_path, old),
        IncludedActions(pair.versions.new, pair.new_path, new),
    )
    settings = SettingChanges(pair, old, new, renamed, included[1])
    choices = FileChoices(pair, old, new)
    settings.add_renamed()
    removed: list[Entry] = []
    added: list[Entry] = []
    kept: list[Entry] = []
    for old_entry, new_entry in match_entries(old.entries, new.entries):
        if old_entry is not None and new_entry is not None:
            settings.compare(old_entry, new_entry)
            choices.compare(old_entry, new_entry)
            kept.append(old_entry)
        elif old_entry is not None:
            removed.append(old_entry)
        elif new_entry is not None:
            added.append(new_entry)
    removed, added = ([entry for entry in entries if not _keeps_name(entry)] for entries in (removed, added))
    new_paths = {
        file.old_path: file.new_path for file in pair.versions.changed_files if file.old_path and file.new_path
    }
    replaced = find_replacements(removed, added, new_paths)
    for old_entry, new_entry in replaced:
        _report_replaced(pair, rename_in_entry(old_entry, old_names), new_entry, outlines)
        settings.compare(old_entry, new_entry)
        choices.compare(old_entry, new_entry)
    settings.add_groups()
    removed = [entry for entry in removed if all(entry is not other for other, _ in replaced)]
    added = [entry for entry in added if all(entry is not other for _, other in replaced)]
    for name in {entry.name for entry in removed if entry.kind == "argument"} & undeclared.keys():
        text = phrase("argument '{name}' removed", name=name)
        reason = phrase("the launch file still uses '{name}', and fails if no other file declares it", name=name)
        pair.add(text, pair.location(undeclared.pop(name).span), reason)
        removed = [entry for entry in removed if (entry.kind, entry.name) != ("argument", name)]
    for name, entry in undeclared.items():
        text = phrase("{entry} uses argument '{name}', which is not declared", entry=title(entry), name=name)
        reason = phrase("the launch file fails if no other file declares '{name}'", name=name)
        pair.add(text, pair.location(entry.span), reason)
    report_unused_arguments(pair, old, new, [*kept, *(entry for entry, _ in replaced)])
    if removed or added:
        _report_lone_entries(pair, removed, added, included, old_names)
    if pair.old_file.suffix == pair.new_file.suffix:
        _compare_code(pair, old, new)
        _report_undefined_names(pair)


def _report_undefined_names(pair: FilePair) -> None:
    """Report the names that a Python launch file still uses but no longer defines or imports."""
    if pair.new_file.suffix != PYTHON_SUFFIX:
        return
    bound = read_source_names(pair.old_file).bound
    for name, span in read_source_names(pair.new_file).undefined.items():
        if name in bound:
            text = phrase("'{name}' is used, but nothing defines or imports it any more", name=name)
            pair.add(text, pair.location(span), phrase("the code that uses the name fails"))


def _report_replaced(pair: FilePair, old_entry: Entry, new_entry: Entry, outlines: tuple[LaunchOutline, ...]) -> None:
    """Report an action that replaces another one, or a parameter with a new name."""
    location = pair.location(new_entry.span)
    if old_entry.kind != SERVER_PARAMETER:
        pair.add(phrase("{old} replaced by {new}", old=title(old_entry), new=title(new_entry)), location)
        return
    old, new = outlines
    text = phrase("{entry} renamed to '{name}'", entry=title(old_entry), name=new_entry.name)
    name = old.resolve(old_entry.name)
    names = {new.resolve(entry.name).strip("/") for entry in new.entries if entry.kind == SERVER_PARAMETER}
    pair.add(text, location, None if name.strip("/") in names else name_reason(name))


def _report_lone_entries(
    pair: FilePair,
    removed: Sequence[Entry],
    added: Sequence[Entry],
    included: tuple[IncludedActions, IncludedActions],
    old_names: Mapping[str, str],
) -> None:
    """Report the added, removed and moved actions."""
    old_included, new_included = included
    stopped = old_included.all_started_programs() - new_included.all_started_programs()
    moved: dict[tuple[str, bool], list[Entry]] = {}
    for entry in added:
        file = old_included.lone_file(entry, new_included)
        file = file or file_with_moved_action(entry, pair.versions, pair.new_path, is_removed=False)
        if file is None:
            pair.add(added_entry_text(entry), pair.location(entry.span), addition_reason(entry))
        else:
            moved.setdefault((file, False), []).append(entry)
    for entry in removed:
        file = new_included.lone_file(entry, old_included)
        if file is not None:
            moved.setdefault((file, True), []).append(entry)
            continue
        written = rename_in_entry(entry, old_names)
        text, location = removed_entry_text(written), pair.location(entry.span, is_old=True)
        reader = reader_of(pair.versions.new, entry.name, pair.new_path) if entry.kind == READING else None
        if reader is not None:
            pair.add(phrase("{change}; {path} uses it", change=text, path=reader), location)
            continue
        file = file_with_moved_action(entry, pair.versions, pair.old_path, is_removed=True)
        if file is not None:
            text = phrase("{entry} moved to {file}", entry=title(written), file=file)
        publisher = other_publisher(entry, old_included.outline, new_included.outline, pair.versions.new)
        if publisher is not None:
            pair.add(
                phrase("{change}; {entry} may publish its transform", change=text, entry=title(publisher)), location
            )
            continue
        stops_nodes = entry.kind == "include" and bool(old_included.started_programs(entry) & stopped)
        pair.add(
            text, location, removal_reason(entry, old_included.outline, new_included.outline, stops_nodes=stops_nodes)
        )
    for (file, is_old), entries in moved.items():
        titles = join_titles(entries)
        text = phrase("{entry} moved from {file}", entry=titles, file=file)
        if is_old:
            text = phrase("{entry} moved to {file}", entry=titles, file=file)
        pair.add(text, pair.location(entries[0].span, is_old=is_old))


def _undeclared_arguments(pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> dict[str, Entry]:
    """Return the arguments that only the new version uses undeclared, each with an action that uses it."""
    if not is_launch_file_name(pair.new_path):
        return {}
    old_names = IncludedActions(pair.versions.old, pair.old_path, old).undeclared_arguments()
    new_names = IncludedActions(pair.versions.new, pair.new_path, new).undeclared_arguments()
    names = {name: entry for name, entry in new_names.items() if name not in old_names}
    return {name: entry for name, entry in names.items() if not _is_declared_by_caller(pair, name)}


def _is_declared_by_caller(pair: FilePair, name: str) -> bool:
    """Return whether a launch file that includes this one passes or declares the argument."""
    return any(
        name in include.settings or (not outline.is_ros1 and name in outline.values)
        for outline, include in callers_of(pair.versions.new, pair.new_path, name)
    )


def _keeps_name(entry: Entry) -> bool:
    return entry.is_same_name("to", None, entry.settings.get("to"))


def _compare_code(pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> None:
    """Compare the code besides the actions: report a few changed statements as written, more of them in one sentence.

    A statement that uses a name with another value differs although it is written as before. The value is reported.
    """
    if [part.text for part in old.code] == [part.text for part in new.code]:
        return
    removed, added = _without_common(old.code, new.code), _without_common(new.code, old.code)
    if _differ_in_names(removed, added):
        return
    same = {part.source for part in removed} & {part.source for part in added}
    if same:
        removed, added = ([part for part in parts if part.source not in same] for parts in (removed, added))
        old_sources, new_sources = ({part.source for part in outline.definitions} for outline in (old, new))
        removed += [part for part in old.definitions if part.source not in new_sources]
        added += [part for part in new.definitions if part.source not in old_sources]
    added = _report_failures(pair, added, old, new)
    if not removed and not added:
        return
    location = pair.location(added[0].span) if added else None
    if removed and not added:
        location = pair.location(removed[0].span, is_old=True)
    if 1 <= len(removed) == len(added) <= _MAX_STATEMENTS and all(map(_are_versions, removed, added)):
        for old_part, new_part in zip(removed, added, strict=True):
            before, after = differing_excerpts(old_part.source, new_part.source)
            pair.add(phrase("other code: {old} -> {new}", old=before, new=after), pair.location(new_part.span))
    else:
        pair.add(_code_text(removed, added), location)


def _report_failures(
    pair: FilePair, added: Sequence[CodePart], old: LaunchOutline, new: LaunchOutline
) -> list[CodePart]:
    """Report new conditions under which the launch fails, and return the other new statements.

    A condition is not new if the old file failed under it, too. The default of a new argument is taken as valid.
    """
    known = [part.failing_tests for part in old.code if part.failing_tests]
    old_names = {entry.name for entry in old.entries if entry.kind == "argument"}
    optional = {
        entry.name for entry in new.entries if entry.kind == "argument" and {"default", "value"} & entry.settings.keys()
    }
    others = list(added)
    for part in added:
        tests = part.failing_tests
        is_known = any(all(any(test.implies(other) for test in tests) for other in failure) for failure in known)
        is_optional = any(test.arguments & (optional - old_names) for test in tests)
        if tests and not is_known and not is_optional:
            condition = " and ".join(f"({test.text})" if " or " in test.text else test.text for test in tests)
            reason = phrase("the launch file fails if `{condition}`", condition=condition)
            text = phrase("added: {code}", code=shorten(part.source, _MAX_SOURCE))
            pair.add(text, pair.location(part.span), reason)
            headers = {f"if {test.text}: ..." for test in tests}
            others = [other for other in others if other is not part and other.source not in headers]
    return others


def _code_text(removed: Sequence[CodePart], added: Sequence[CodePart]) -> Phrase:
    """Return the sentence about changed statements, which quotes the first one."""
    parts = added or removed
    code = shorten(parts[0].source, _MAX_SOURCE)
    if removed and added:
        return phrase("other code changed, such as {code}", code=code)
    text = phrase("other code added: {code}", code=code) if added else phrase("other code removed: {code}", code=code)
    more = len(parts) - 1
    if not more:
        return text
    return counted("{change} and {count} more statement", "{change} and {count} more statements", more, change=text)


def _differ_in_names(removed: Sequence[CodePart], added: Sequence[CodePart]) -> bool:
    """Return whether statements differ only in consistently renamed variables and parameters."""
    old, new = ("\n".join(part.text for part in parts) for parts in (removed, added))
    if _VARIABLE.sub("", old) != _VARIABLE.sub("", new):
        return False
    pairs = set(zip(_VARIABLE.findall(old), _VARIABLE.findall(new), strict=True))
    return len({before for before, _ in pairs}) == len({after for _, after in pairs}) == len(pairs)


def _are_versions(old: CodePart, new: CodePart) -> bool:
    """Return whether two statements differ and are probably versions of the same one."""
    return (
        old.source != new.source
        and SequenceMatcher(None, old.source, new.source, autojunk=False).ratio() >= MIN_SIMILARITY
    )


def _without_common(parts: Sequence[CodePart], others: Sequence[CodePart]) -> list[CodePart]:
    remaining = Counter(part.text for part in others)
    lone = []
    for part in parts:
        if remaining[part.text]:
            remaining[part.text] -= 1
        else:
            lone.append(part)
    return lone
