"""The comparison of launch files: which arguments, nodes and files they have, with their settings."""

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
from linkwright.review.launches.matching import MIN_SIMILARITY, matched_entries, replacements
from linkwright.review.launches.outlines import READING, SERVER_PARAMETER, CodePart, Entry, LaunchOutline
from linkwright.review.launches.readers_of_environment import reader_of
from linkwright.review.launches.reading import read_outline
from linkwright.review.launches.renames import renamed_entry, renamed_names, with_new_names
from linkwright.review.launches.settings import SettingChanges
from linkwright.review.launches.titles import added_entry, joined_titles, removed_entry, title
from linkwright.review.launches.transforms import other_publisher
from linkwright.review.launches.unused_arguments import add_unused_arguments
from linkwright.review.list_changes import excerpts, shortened

_MAX_SOURCE = 120
"""The number of characters of a statement that are shown."""
_MAX_STATEMENTS = 3
"""The maximum number of changed statements that are each shown."""
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
    renamed = renamed_names(old, new)
    old = with_new_names(old, renamed)
    old_names = {new_name: old_name for old_name, new_name in renamed.items()}
    included = (
        IncludedActions(pair.versions.old, pair.old_path, old),
        IncludedActions(pair.versions.new, pair.new_path, new),
    )
    settings = SettingChanges(pair, old, new, renamed, included[1])
    choices = FileChoices(pair, old, new)
    settings.add_renamed()
    gone: list[Entry] = []
    come: list[Entry] = []
    kept: list[Entry] = []
    for old_entry, new_entry in matched_entries(old.entries, new.entries):
        if old_entry is not None and new_entry is not None:
            settings.compare(old_entry, new_entry)
            choices.compare(old_entry, new_entry)
            kept.append(old_entry)
        elif old_entry is not None:
            gone.append(old_entry)
        elif new_entry is not None:
            come.append(new_entry)
    gone, come = ([entry for entry in entries if not _keeps_name(entry)] for entries in (gone, come))
    new_paths = {
        file.old_path: file.new_path for file in pair.versions.changed_files if file.old_path and file.new_path
    }
    replaced = replacements(gone, come, new_paths)
    for old_entry, new_entry in replaced:
        _add_replaced(pair, renamed_entry(old_entry, old_names), new_entry, outlines)
        settings.compare(old_entry, new_entry)
        choices.compare(old_entry, new_entry)
    settings.add_groups()
    gone = [entry for entry in gone if all(entry is not other for other, _ in replaced)]
    come = [entry for entry in come if all(entry is not other for _, other in replaced)]
    for name in {entry.name for entry in gone if entry.kind == "argument"} & undeclared.keys():
        text = phrase("argument '{name}' removed", name=name)
        reason = phrase("the launch file still uses '{name}', and fails if no other file declares it", name=name)
        pair.add(text, pair.location(undeclared.pop(name).span), reason)
        gone = [entry for entry in gone if (entry.kind, entry.name) != ("argument", name)]
    for name, entry in undeclared.items():
        text = phrase("{entry} uses argument '{name}', which is not declared", entry=title(entry), name=name)
        reason = phrase("the launch file fails if no other file declares '{name}'", name=name)
        pair.add(text, pair.location(entry.span), reason)
    add_unused_arguments(pair, old, new, [*kept, *(entry for entry, _ in replaced)])
    if gone or come:
        _add_lone_entries(pair, gone, come, included, old_names)
    if pair.old_file.suffix == pair.new_file.suffix:
        _compare_code(pair, old, new)


def _add_replaced(pair: FilePair, old_entry: Entry, new_entry: Entry, outlines: tuple[LaunchOutline, ...]) -> None:
    """Add an action that replaces another one, or a parameter with a new name."""
    location = pair.location(new_entry.span)
    if old_entry.kind != SERVER_PARAMETER:
        pair.add(phrase("{old} replaced by {new}", old=title(old_entry), new=title(new_entry)), location)
        return
    old, new = outlines
    text = phrase("{entry} renamed to '{name}'", entry=title(old_entry), name=new_entry.name)
    name = old.resolved(old_entry.name)
    names = {new.resolved(entry.name).strip("/") for entry in new.entries if entry.kind == SERVER_PARAMETER}
    pair.add(text, location, None if name.strip("/") in names else name_reason(name))


def _add_lone_entries(
    pair: FilePair,
    gone: Sequence[Entry],
    come: Sequence[Entry],
    included: tuple[IncludedActions, IncludedActions],
    old_names: Mapping[str, str],
) -> None:
    """Add the actions that only one version has, and those that are in an included file of the other version."""
    old_included, new_included = included
    stopped = old_included.all_started() - new_included.all_started()
    moved: dict[tuple[str, bool], list[Entry]] = {}
    for entry in come:
        file = old_included.lone_file(entry, new_included)
        file = file or file_with_moved_action(entry, pair.versions, pair.new_path, is_removed=False)
        if file is None:
            pair.add(added_entry(entry), pair.location(entry.span), addition_reason(entry))
        else:
            moved.setdefault((file, False), []).append(entry)
    for entry in gone:
        file = new_included.lone_file(entry, old_included)
        if file is not None:
            moved.setdefault((file, True), []).append(entry)
            continue
        written = renamed_entry(entry, old_names)
        text, location = removed_entry(written), pair.location(entry.span, is_old=True)
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
        stops_nodes = entry.kind == "include" and bool(old_included.started(entry) & stopped)
        pair.add(
            text, location, removal_reason(entry, old_included.outline, new_included.outline, stops_nodes=stops_nodes)
        )
    for (file, is_old), entries in moved.items():
        titles = joined_titles(entries)
        text = phrase("{entry} moved from {file}", entry=titles, file=file)
        if is_old:
            text = phrase("{entry} moved to {file}", entry=titles, file=file)
        pair.add(text, pair.location(entries[0].span, is_old=is_old))


def _undeclared_arguments(pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> dict[str, Entry]:
    """Return the arguments that only the new version uses without declaring them, each with an action that uses it."""
    if not is_launch_file_name(pair.new_path):
        return {}
    old_names = IncludedActions(pair.versions.old, pair.old_path, old).undeclared()
    new_names = IncludedActions(pair.versions.new, pair.new_path, new).undeclared()
    names = {name: entry for name, entry in new_names.items() if name not in old_names}
    return {name: entry for name, entry in names.items() if not _is_declared_by_caller(pair, name)}


def _is_declared_by_caller(pair: FilePair, name: str) -> bool:
    """Return whether a launch file that includes this one passes an argument, or has one of this name itself."""
    return any(
        name in include.settings or (not outline.is_ros1 and name in outline.values)
        for outline, include in callers_of(pair.versions.new, pair.new_path, name)
    )


def _keeps_name(entry: Entry) -> bool:
    return entry.is_same_name("to", None, entry.settings.get("to"))


def _compare_code(pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> None:
    """Compare what is not an action: one changed statement as it is written, others in one sentence.

    A statement that uses a name with another value differs although it is written as before. The value is reported.
    """
    if [part.text for part in old.code] == [part.text for part in new.code]:
        return
    gone, come = _without_common(old.code, new.code), _without_common(new.code, old.code)
    if _differ_in_names(gone, come):
        return
    same = {part.source for part in gone} & {part.source for part in come}
    if same:
        gone, come = ([part for part in parts if part.source not in same] for parts in (gone, come))
        old_sources, new_sources = ({part.source for part in outline.definitions} for outline in (old, new))
        gone += [part for part in old.definitions if part.source not in new_sources]
        come += [part for part in new.definitions if part.source not in old_sources]
    come = _without_failures(pair, gone, come)
    if not gone and not come:
        return
    location = pair.location(come[0].span) if come else None
    if gone and not come:
        location = pair.location(gone[0].span, is_old=True)
    if 1 <= len(gone) == len(come) <= _MAX_STATEMENTS and all(map(_are_versions, gone, come)):
        for old_part, new_part in zip(gone, come, strict=True):
            before, after = excerpts(old_part.source, new_part.source)
            pair.add(phrase("other code: {old} -> {new}", old=before, new=after), pair.location(new_part.span))
    else:
        pair.add(_code_text(gone, come), location)


def _without_failures(pair: FilePair, gone: Sequence[CodePart], come: Sequence[CodePart]) -> list[CodePart]:
    """Add the new conditions under which the launch ends with an error, and return the other new statements."""
    known = {part.failing_condition for part in gone}
    others = list(come)
    for part in come:
        condition = part.failing_condition
        if condition and condition not in known:
            reason = phrase("the launch file fails if `{condition}`", condition=condition)
            text = phrase("added: {code}", code=shortened(part.source, _MAX_SOURCE))
            pair.add(text, pair.location(part.span), reason)
            others = [other for other in others if other is not part and other.source != f"if {condition}: ..."]
    return others


def _code_text(gone: Sequence[CodePart], come: Sequence[CodePart]) -> Phrase:
    """Return the sentence about changed statements, with the first one."""
    parts = come or gone
    code = shortened(parts[0].source, _MAX_SOURCE)
    if gone and come:
        return phrase("other code changed, such as {code}", code=code)
    text = phrase("other code added: {code}", code=code) if come else phrase("other code removed: {code}", code=code)
    more = len(parts) - 1
    if not more:
        return text
    return counted("{change} and {count} more statement", "{change} and {count} more statements", more, change=text)


def _differ_in_names(gone: Sequence[CodePart], come: Sequence[CodePart]) -> bool:
    """Return whether statements only have other names of variables and parameters, each everywhere the same."""
    old, new = ("\n".join(part.text for part in parts) for parts in (gone, come))
    if _VARIABLE.sub("", old) != _VARIABLE.sub("", new):
        return False
    pairs = set(zip(_VARIABLE.findall(old), _VARIABLE.findall(new), strict=True))
    return len({before for before, _ in pairs}) == len({after for _, after in pairs}) == len(pairs)


def _are_versions(old: CodePart, new: CodePart) -> bool:
    """Return whether two statements are probably versions of the same one, and differ as they are written."""
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
