"""Compare launch files: their arguments, nodes and included files, with their settings."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from difflib import SequenceMatcher
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import Phrase, counted, joined, joined_first, phrase
from linkwright.diagnostics.phrase import count_shown
from linkwright.packages.readers.launch_files import LAUNCH_FUNCTION
from linkwright.packages.readers.python_values import parse_python
from linkwright.review.breaking import name_reason
from linkwright.review.changes import MAX_NAMES, Effect
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.added_nodes import explain_addition, find_missing_package_reason, may_be_offered
from linkwright.review.launches.arguments.fixed import report_fixed_arguments
from linkwright.review.launches.arguments.kinds import report_changed_kinds
from linkwright.review.launches.arguments.repeated import report_repeated_arguments
from linkwright.review.launches.arguments.undeclared import find_new_undeclared_arguments, report_undeclared_arguments
from linkwright.review.launches.arguments.unused import report_unused_arguments
from linkwright.review.launches.bridged_topics import explain_lost_topics
from linkwright.review.launches.effects import explain_argument_removal, find_removal_reason, is_made_by_default
from linkwright.review.launches.environment_readers import explain_removed_reading
from linkwright.review.launches.failing_files import find_failure, report_repair
from linkwright.review.launches.file_choices import FileChoices
from linkwright.review.launches.harmless_removals import explain_harmless_removal
from linkwright.review.launches.imports import compare_imports
from linkwright.review.launches.include_trees import (
    IncludeTree,
    find_moved_remapping,
    find_other_include,
    find_same_parameter,
)
from linkwright.review.launches.included import (
    IncludedActions,
    compare_moved_transform,
    find_files_with_moved_action,
    find_moved_settings,
)
from linkwright.review.launches.including_files import IncludingFiles, describe_opposite_change
from linkwright.review.launches.lost_values import explain_lost_value
from linkwright.review.launches.matching import MIN_SIMILARITY, find_replacements, match_entries, start_same_program
from linkwright.review.launches.outlines import (
    FAILURES,
    PASSES_ALL_ARGUMENTS,
    READING,
    SERVER_PARAMETER,
    CodePart,
    Entry,
    LaunchOutline,
    imply,
)
from linkwright.review.launches.programs.missing import find_missing_file, lacks_included_file, lacks_program
from linkwright.review.launches.programs.renamed import find_renamed_programs
from linkwright.review.launches.python.builders import separate_builders
from linkwright.review.launches.python.conditions import report_object_tests
from linkwright.review.launches.python.object_texts import report_object_texts
from linkwright.review.launches.python.old_keywords import report_old_keywords
from linkwright.review.launches.python.other_code import drop_common_parts, outside
from linkwright.review.launches.python.undefined import report_undefined_names
from linkwright.review.launches.reading import read_outline
from linkwright.review.launches.removed_together import RemovedArguments
from linkwright.review.launches.renamed_code import rename_packages_in_code
from linkwright.review.launches.renames import (
    find_renamed_names,
    rename_commands,
    rename_in_entry,
    rename_in_outline,
)
from linkwright.review.launches.repeated_nodes import report_repeated_nodes
from linkwright.review.launches.settings import SettingChanges
from linkwright.review.launches.simple_launch import report_declared_arguments
from linkwright.review.launches.titles import (
    format_added_entry,
    format_removed_entry,
    format_settings,
    format_title,
    join_titles,
)
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.texts.excerpts import differing_excerpts, shorten_middle

_MAX_STATEMENT_CHARACTERS = 120
"""The maximum number of characters of a statement that are shown."""
_COLLECTION = re.compile(r"(\w+) = [\[{]")
"""The beginning of a statement that gives a name to a dictionary or list."""
_SETTING_STATEMENT = re.compile(r"\w+\[.+?\] = |\w+\.(?:append|extend|update|insert|setdefault|pop|remove)\(")
"""The start of a statement that changes an item of a dictionary or list."""
_MAX_CONDITION_CHARACTERS = 240
_MAX_SHOWN_STATEMENTS = 3
"""The maximum number of changed statements that are shown separately."""
_CODE_NAME = re.compile(r"(?<=\bname )\w+\b|(?<=\barg=')\w+\b(?=')")
"""The names of variables and parameters in the texts of statements."""


def compare_launch_files(pair: FilePair) -> None:
    """Compare two versions of a launch file, without running them."""
    roots = {pair.old_file: pair.versions.old.root, pair.new_file: pair.versions.new.root}
    outlines = pair.read(lambda path: read_outline(path, roots[path]))
    if outlines is None:
        return
    old, new = outlines
    undeclared = find_new_undeclared_arguments(pair, old, new)
    renamed = find_renamed_names(old, new)
    old, new = separate_builders(rename_in_outline(old, renamed), new)
    old_names = {new_name: old_name for old_name, new_name in renamed.items()}
    included = (
        IncludedActions(pair.versions.old, pair.old_path, old),
        IncludedActions(pair.versions.new, pair.new_path, new),
    )
    settings = SettingChanges(pair, old, new, renamed, included)
    choices = FileChoices(pair, old, new, renamed.values())
    settings.report_renamed()
    removed: list[Entry] = []
    added: list[Entry] = []
    paired_old: list[Entry] = []
    for old_entry, new_entry in rename_commands(list(match_entries(old.entries, new.entries))):
        if old_entry is not None and new_entry is not None:
            settings.compare(old_entry, new_entry)
            choices.compare(old_entry, new_entry)
            paired_old.append(old_entry)
        elif old_entry is not None:
            removed.append(old_entry)
        elif new_entry is not None:
            added.append(new_entry)
    removed, added = ([entry for entry in entries if not _remaps_to_itself(entry)] for entries in (removed, added))
    replaced = find_replacements(removed, added, find_renamed_programs(pair.versions), (old, new))
    for old_entry, new_entry in replaced:
        _report_replaced(pair, rename_in_entry(old_entry, old_names), new_entry, outlines)
        settings.compare(old_entry, new_entry)
        choices.compare(old_entry, new_entry)
    settings.report_groups()
    removed = [entry for entry in removed if all(entry is not other for other, _ in replaced)]
    added = [entry for entry in added if all(entry is not other for _, other in replaced)]
    if pair.new_file.suffix == PYTHON_SUFFIX:  # callers of either version must pass a required argument
        required = {entry.name for entry in removed if entry.kind == "argument" and "default" not in entry.settings}
        undeclared = {name: argument for name, argument in undeclared.items() if name not in required}
    report_undeclared_arguments(pair, undeclared, removed, is_ros1=new.is_ros1)
    reported = {name for name, argument in undeclared.items() if argument.is_certain}
    removed = [
        entry
        for entry in removed
        if entry.kind != "argument" or not (new.has_unknown_actions or entry.name in reported)
    ]
    report_repeated_arguments(pair, new)
    report_repeated_nodes(pair, old, new)
    report_changed_kinds(pair, old, new)
    report_fixed_arguments(pair, old, new)
    report_unused_arguments(pair, old, included[1], [*paired_old, *(entry for entry, _ in replaced)], removed)
    if removed or added:
        _report_unpaired_entries(pair, removed, added, included, old_names)
    if pair.old_file.suffix == pair.new_file.suffix:
        _compare_code(pair, old, new)
        if pair.new_file.suffix == PYTHON_SUFFIX:
            compare_imports(pair)
            report_object_tests(pair)
            report_object_texts(pair)
            report_old_keywords(pair)
        report_undefined_names(pair)
    failure = find_failure(pair.versions.old, pair.old_path, outlines[0])
    if failure is not None or _is_refused_by_default(old):
        _mark_unbreaking(pair, keeps_renaming=True)
    report_repair(pair, failure, *outlines)
    if old.is_ros1 and not new.is_ros1 and PurePosixPath(pair.old_path).name != PurePosixPath(pair.new_path).name:
        _mark_unbreaking(pair, keeps_renaming=True)  # no user starts the file by its old name


def _is_refused_by_default(outline: LaunchOutline) -> bool:
    """Return whether a launch file has an action with wrong arguments that the defaults make."""
    failing = (entry for entry in outline.entries if not entry.settings.keys().isdisjoint(FAILURES))
    return any(is_made_by_default(entry, outline) for entry in failing)


def compare_launch_tests(pair: FilePair) -> None:
    """Compare two versions of a test of ROS 1, whose names no other program uses."""
    compare_launch_files(pair)
    if not pair.is_lost:
        _mark_unbreaking(pair)


def _mark_unbreaking(pair: FilePair, *, keeps_renaming: bool = False) -> None:
    """Mark the changes of a file as changes that break nothing.

    Args:
        pair: both versions of the file.
        keeps_renaming: whether the new name of the file stays breaking.
    """
    pair.changes[:] = [
        change
        if keeps_renaming and change.path_change is not None
        else replace(change, effect=Effect.CHANGED, reason=None)
        for change in pair.changes
    ]


def _report_replaced(
    pair: FilePair, old_entry: Entry, new_entry: Entry, outlines: tuple[LaunchOutline, LaunchOutline]
) -> None:
    """Report an action that replaces a different one, or a parameter with a new name."""
    location = pair.location(new_entry.span)
    if old_entry.kind != SERVER_PARAMETER:
        text = phrase("{old} replaced by {new}", old=format_title(old_entry), new=format_title(new_entry))
        if start_same_program(old_entry, new_entry, outlines):
            text = phrase("{change}, by default the same", change=text)
        is_lost = lacks_included_file(pair.versions.new, new_entry)
        is_lost = is_lost and not lacks_included_file(pair.versions.old, old_entry)
        reason = phrase("the launch file does not find the file") if is_lost else None
        pair.add(text, location, reason or find_missing_package_reason(pair, new_entry, outlines[1]))
        return
    old, new = outlines
    text = phrase("{entry} renamed to '{name}'", entry=format_title(old_entry), name=new_entry.name)
    name = old.resolve(old_entry.name)
    names = {new.resolve(entry.name).strip("/") for entry in new.entries if entry.kind == SERVER_PARAMETER}
    pair.add(text, location, None if name.strip("/") in names else name_reason(name))


def _report_unpaired_entries(
    pair: FilePair,
    removed: Sequence[Entry],
    added: Sequence[Entry],
    included: tuple[IncludedActions, IncludedActions],
    old_names: Mapping[str, str],
) -> None:
    """Report the added, removed and moved actions."""
    old_included, new_included = included
    stopped = old_included.count_all_started_programs() - new_included.count_all_started_programs()
    trees = IncludeTree(old_included), IncludeTree(new_included)
    moved: dict[tuple[str, bool], list[Entry]] = {}
    for entry in added:
        file = old_included.find_unmatched_file(entry, new_included)
        moves = find_files_with_moved_action(
            entry, pair.versions, pair.new_path, old_included.outline, is_removed=False
        )
        other_file = next(moves, None)
        is_included, file = file is not None, file or other_file
        differences = None if file is None else find_moved_settings(entry, pair.versions, file, is_included=is_included)
        if file is not None and differences is not None:
            _report_changed_move(pair, entry, file, *differences)
            continue
        if file is None:
            text, reason = format_added_entry(entry), explain_addition(pair, entry, removed, included)
            if reason is not None and entry.kind == "remapping":
                target = new_included.outline.resolve(entry.settings.get("to", ""))
                text, reason = _explain_opposite_change(pair, entry, text, reason, (None, target))
            pair.add(text, pair.location(entry.span), reason)
        else:
            moved.setdefault((file, False), []).append(entry)
    removed_arguments = RemovedArguments(removed, old_included.outline)
    for entry in removed:
        file = new_included.find_unmatched_file(entry, old_included)
        if file is not None:
            if _loses_callers(entry, new_included.outline):
                text = phrase("{entry} moved to {file}", entry=format_title(entry), file=file)
                reason = explain_argument_removal(entry.name, is_ros1=True)
                pair.add(text, pair.location(entry.span, is_old=True), reason)
            else:
                moved.setdefault((file, True), []).append(entry)
            continue
        written = rename_in_entry(entry, old_names)
        text, location = format_removed_entry(written), pair.location(entry.span, is_old=True)
        if entry.kind == READING:
            reader, reason = explain_removed_reading(pair, entry.name)
            text = text if reader is None else phrase("{change}; {path} uses it", change=text, path=reader)
            pair.add(text, location, reason)
            continue
        moves = find_files_with_moved_action(entry, pair.versions, pair.old_path, new_included.outline, is_removed=True)
        files = list(moves)
        file = joined(files[:MAX_NAMES], last=" or ") if files else None
        if file is not None:
            text = phrase("{entry} moved to {file}", entry=format_title(written), file=file)
        explained = explain_harmless_removal(pair, entry, (text, format_title(written)), included, added)
        if explained is not None:
            pair.add(explained, location)
            continue
        replacing = None if file is not None else new_included.find_replacing_node(entry, old_included)
        if replacing is not None:
            other, path = format_title(replacing[0]), replacing[1]
            text = phrase("{old} replaced by {new} in {path}", old=format_title(written), new=other, path=path)
        stops_nodes = entry.kind == "include" and bool(old_included.count_started_programs(entry) & stopped)
        outlines = old_included.outline, new_included.outline
        reason = find_removal_reason(entry, *outlines, stops_nodes=stops_nodes) or explain_lost_value(entry, *outlines)
        if entry.kind == "remapping" and not may_be_offered(pair, entry, included):
            reason = None
        has_known_topics, topics_reason = explain_lost_topics(entry, *outlines)
        if has_known_topics and file is None:
            reason = topics_reason
        if reason is not None and file is not None:
            reason = phrase("where the file is started without {file}, {reason}", file=file, reason=reason)
        if reason is not None and lacks_program(pair.versions.old, entry):
            text, reason = phrase("{change}; its package never had the program", change=text), None
        if reason is not None and find_missing_file(pair.versions.old, entry, pair.old_file) is not None:
            text, reason = phrase("{change}; its package does not have the file", change=text), None
        if file is not None or not removed_arguments.add(entry, reason):
            _report_removed(pair, entry, text, reason, trees)
    removed_arguments.report(pair)
    _report_moved(pair, moved)


def _loses_callers(entry: Entry, new: LaunchOutline) -> bool:
    """Return whether an argument of ROS 1 moved to an included file to which the file does not pass the callers' value.

    In ROS 2, an included file gets the value from the callers of the including file.
    """
    passes_all = any(PASSES_ALL_ARGUMENTS in other.settings for other in new.entries if other.kind == "include")
    return new.is_ros1 and entry.kind == "argument" and "value" not in entry.settings and not passes_all


def _report_removed(
    pair: FilePair, entry: Entry, text: Phrase, reason: Phrase | None, trees: tuple[IncludeTree, IncludeTree]
) -> None:
    """Report a removed action, which breaks nothing if an included file now does the same."""
    if reason is not None and entry.kind == SERVER_PARAMETER:
        parameter = find_same_parameter(entry, *trees)
        if parameter is not None and parameter.path is not None:
            text, reason = phrase("{change}; {file} sets it now", change=text, file=parameter.path), None
    if reason is not None and entry.kind == "remapping":
        file = find_moved_remapping(entry, *trees)
        if file is not None:
            text, reason = phrase("{change}; {file} sets it now", change=text, file=file), None
    if reason is not None and entry.kind in ("remapping", SERVER_PARAMETER):
        target = trees[0].resolve(entry.settings.get("to", ""))
        text, reason = _explain_opposite_change(pair, entry, text, reason, (target, None))
    other = None if reason is None or entry.kind != "include" else find_other_include(entry, *trees)
    if other is not None and other[0].includer is not None:
        other_file, has_same_namespace = other
        text = phrase("{change}; {file} includes it with the same arguments", change=text, file=other_file.includer)
        reason = None
        if not has_same_namespace:
            text = phrase("{change}, in the namespace '{name}'", change=text, name=other_file.namespace)
            reason = phrase("programs that use the names of the node, its topics or its services do not find them")
    pair.add(text, pair.location(entry.span, is_old=True), reason)


def _explain_opposite_change(
    pair: FilePair, entry: Entry, text: Phrase, reason: Phrase, values: tuple[str | None, str | None]
) -> tuple[Phrase, Phrase]:
    """Return the line and the reason for a value that also moves to or from a file that includes this one.

    Args:
        pair: both versions of the launch file.
        entry: the action that sets the value.
        text: the line.
        reason: the reason why the change is breaking.
        values: the old and the new value; None for the version that does not set it.
    """
    includer = IncludingFiles(pair).find_opposite_change(entry, "", *values)
    if includer is None:
        return text, reason
    return describe_opposite_change(text, reason, includer, is_removed=values[1] is None)


def _report_changed_move(pair: FilePair, entry: Entry, file: str, changed: Entry, lost: Sequence[str]) -> None:
    """Report an action that moved from another launch file and has other settings there.

    Args:
        pair: both versions of the launch file.
        entry: the action.
        file: the other launch file.
        changed: the action with only its new and changed settings.
        lost: the names of the settings that it no longer has.
    """
    text = phrase("{entry} moved from {file}", entry=format_title(entry), file=file)
    transform = compare_moved_transform(entry, pair.versions, file)
    if transform is not None:
        text = phrase("{change}; {note}", change=text, note=transform)
        changed = replace(changed, settings={k: v for k, v in changed.settings.items() if k != "arguments"})
    settings = format_settings(changed)
    if settings is not None:
        text = phrase("{change}, now with {items}", change=text, items=settings)
    if lost:
        text = phrase("{change}, without {items}", change=text, items=joined_first(lost, MAX_NAMES))
    pair.add(text, pair.location(entry.span))


def _report_moved(pair: FilePair, moved: Mapping[tuple[str, bool], Sequence[Entry]]) -> None:
    """Report the actions that moved between the launch file and other launch files.

    Args:
        pair: both versions of the launch file.
        moved: the moved actions, by the other file and whether they moved to it.
    """
    for (file, is_old), entries in moved.items():
        titles = join_titles(entries)
        text = phrase("{entry} moved from {file}", entry=titles, file=file)
        if is_old:
            text = phrase("{entry} moved to {file}", entry=titles, file=file)
        pair.add(text, pair.location(entries[0].span, is_old=is_old))


def _remaps_to_itself(entry: Entry) -> bool:
    return entry.is_identity_remapping("to", None, entry.settings.get("to"))


def _compare_code(pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> None:
    """Compare the code besides the actions.

    A few changed statements are reported one by one, more of them in one sentence.

    A statement that uses a name with a different value differs although its text is the same. The value is reported.
    """
    old = rename_packages_in_code(pair.versions, old, new)
    if [part.text for part in old.code] == [part.text for part in new.code]:
        return
    equal = {name for name, source in old.scope_sources.items() if new.scope_sources.get(name) == source}
    removed, added = drop_common_parts(old.code, new.code, equal), drop_common_parts(new.code, old.code, equal)
    if _differ_in_names(removed, added):
        return
    removed, added = report_declared_arguments(pair, removed, added, old, new)
    common_sources = {part.source for part in removed} & {part.source for part in added}
    if common_sources:
        removed, added = ([part for part in parts if part.source not in common_sources] for parts in (removed, added))
        old_sources, new_sources = ({part.source for part in outline.definitions} for outline in (old, new))
        for parts, outline, others in ((removed, old, new_sources), (added, new, old_sources)):
            changed = [part for part in outside(outline.definitions, equal) if part.source not in others]
            parts += _find_used_definitions(common_sources, outline, changed) or changed
    removed, added = _drop_definitions(removed, new), _drop_definitions(added, old)
    added = _report_failures(pair, added, old, new)
    removed, added = _report_changed_definitions(pair, removed, added)
    if not removed and not added:
        return
    location = pair.location(added[0].span) if added else None
    if removed and not added:
        location = pair.location(removed[0].span, is_old=True)
    if 1 <= len(removed) == len(added) <= _MAX_SHOWN_STATEMENTS and all(
        map(_are_versions_of_one_statement, removed, added)
    ):
        for old_part, new_part in zip(removed, added, strict=True):
            old_excerpt, new_excerpt = differing_excerpts(old_part.source, new_part.source)
            pair.add(
                phrase("other code: {old} -> {new}", old=old_excerpt, new=new_excerpt), pair.location(new_part.span)
            )
    else:
        removed, added = _add_definitions(removed, old, new), _add_definitions(added, new, old)
        is_shown_in_function = any(_find_functions(pair.new_file, added[:1]))
        functions = [*_find_functions(pair.new_file, added), *_find_functions(pair.old_file, removed)]
        functions = functions if is_shown_in_function else []
        pair.add(_format_code_change(removed, added, list(dict.fromkeys(functions))), location)


def _report_changed_definitions(
    pair: FilePair, removed: Sequence[CodePart], added: Sequence[CodePart]
) -> tuple[list[CodePart], list[CodePart]]:
    """Report the dictionaries and lists that a name gets in both versions, and return the other statements.

    Their values may be parameters of nodes, which other statements compute.
    """
    old, new = ({_find_collection_name(part): part for part in parts} for parts in (removed, added))
    changed = [(old[name], part) for name, part in new.items() if name is not None and name in old]
    for old_part, new_part in changed:
        name, _, new_value = new_part.source.partition(" = ")
        before, after = differing_excerpts(old_part.source.partition(" = ")[2], new_value)
        pair.add(
            phrase("values of '{name}': {old} -> {new}", name=name, old=before, new=after), pair.location(new_part.span)
        )
    told = {id(part) for parts in changed for part in parts}
    return [part for part in removed if id(part) not in told], [part for part in added if id(part) not in told]


def _find_collection_name(part: CodePart) -> str | None:
    match = _COLLECTION.match(part.source)
    return None if match is None else match[1]


def _drop_definitions(parts: Sequence[CodePart], other: LaunchOutline) -> list[CodePart]:
    """Return the statements without those that assign a name in the other version, where it is assigned only once."""
    sources = {part.source for part in other.definitions}
    return [part for part in parts if part.source not in sources]


def _find_used_definitions(
    sources: Collection[str], outline: LaunchOutline, definitions: Collection[CodePart]
) -> list[CodePart]:
    """Return the definitions whose names statements use, also through other names of the file."""
    used = " ".join(sources)
    found = []
    for part in reversed(outline.definitions):
        name = re.match(r"\w+", part.source)
        if name is not None and re.search(rf"\b{name[0]}\b", used):
            used += f" {part.source}"
            found += [part] if part in definitions else []
    return found[::-1]


def _add_definitions(parts: Sequence[CodePart], own: LaunchOutline, other: LaunchOutline) -> list[CodePart]:
    """Return changed statements and the assignments of the names that they use and the other version does not have."""
    sources = {part.source for part in (*parts, *other.code)}
    other_names = {part.source.split(maxsplit=1)[0] for part in other.definitions}
    result = list(parts)
    used = " ".join(part.source for part in parts)
    for part in reversed(own.definitions):
        name = re.match(r"\w+", part.source)
        is_new = part.source not in sources and part.source.split(maxsplit=1)[0] not in other_names
        if is_new and name is not None and re.search(rf"\b{name[0]}\b", used):
            result.append(part)
            used += f" {part.source}"
    return sorted(result, key=lambda part: (part.span.line, part.span.column))


def _report_failures(
    pair: FilePair, added: Sequence[CodePart], old: LaunchOutline, new: LaunchOutline
) -> list[CodePart]:
    """Report new conditions under which the launch fails, and return the other new statements.

    A condition is not new if the old file failed under it, too. The default of a new argument is taken as valid, and so
    are unknown arguments of a helper function.
    """
    old_failures = [part.failing_tests for part in old.code if part.failing_tests]
    old_names = {entry.name for entry in old.entries if entry.kind == "argument"}
    optional = {
        entry.name for entry in new.entries if entry.kind == "argument" and {"default", "value"} & entry.settings.keys()
    }
    other_statements = list(added)
    for part in added:
        tests = part.failing_tests
        is_known = any(all(imply(tests, other) for other in failure) for failure in old_failures)
        is_harmless = any(not test.is_known or test.arguments & (optional - old_names) for test in tests)
        if tests and not is_known and not is_harmless:
            condition = " and ".join(f"({test.text})" if " or " in test.text else test.text for test in tests)
            condition = shorten_middle(condition, _MAX_CONDITION_CHARACTERS)
            reason = phrase("the launch file fails if `{condition}`", condition=condition)
            text = phrase("added: {code}", code=shorten_middle(part.source, _MAX_STATEMENT_CHARACTERS))
            pair.add(text, pair.location(part.span), reason)
            headers = {f"if {test.text}: ..." for test in tests}
            other_statements = [
                other for other in other_statements if other is not part and other.source not in headers
            ]
    return other_statements


def _find_functions(file: Path, parts: Sequence[CodePart]) -> Iterator[str]:
    """Yield the functions of a Python file that contain statements, except the one that returns the actions."""
    try:
        is_python = file.suffix == PYTHON_SUFFIX
        tree = parse_python(file.read_text("utf-8", errors="replace")) if is_python else ast.Module([], [])
    except (OSError, SyntaxError, ValueError):
        return
    functions = [node for node in ast.walk(tree) if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))]
    for part in parts:
        around = [node for node in functions if node.lineno <= part.span.line <= (node.end_lineno or node.lineno)]
        innermost = max(around, key=lambda node: node.lineno, default=None)
        if innermost is not None and innermost.name != LAUNCH_FUNCTION:
            yield innermost.name


def _format_code_change(removed: Sequence[CodePart], added: Sequence[CodePart], functions: Sequence[str]) -> Phrase:
    """Return the sentence about changed statements, which names their functions and quotes the first statement."""
    parts = added or removed
    code: str | Phrase = shorten_middle(parts[0].source, _MAX_STATEMENT_CHARACTERS)
    settings = _list_setting_statements(removed, added)
    if (removed and added) or (settings is not None and len(parts) > 1):
        code = settings or code
        if functions:
            names = joined_first([f"'{name}()'" for name in functions], MAX_NAMES)
            return phrase("other code changed in {names}, such as {code}", names=names, code=code)
        return phrase("other code changed, such as {code}", code=code)
    if len(parts) == count_shown(len(parts), 1):
        code = "; ".join(shorten_middle(part.source, _MAX_STATEMENT_CHARACTERS) for part in parts)
    text = phrase("other code added: {code}", code=code) if added else phrase("other code removed: {code}", code=code)
    more = len(parts) - count_shown(len(parts), 1)
    if not more:
        return text
    return counted("{change} and {count} more statement", "{change} and {count} more statements", more, change=text)


def _list_setting_statements(removed: Sequence[CodePart], added: Sequence[CodePart]) -> Phrase | None:
    """Return the statements that change an item of a dictionary or list, each with its condition.

    Such statements set parameters and remappings of nodes. The result is None if there are none.
    """
    texts = [phrase("`{code}` added", code=code) for code in _select_setting_statements(added)]
    texts += [phrase("`{code}` removed", code=code) for code in _select_setting_statements(removed)]
    return joined_first(texts, MAX_NAMES) if texts else None


def _select_setting_statements(parts: Sequence[CodePart]) -> Iterator[str]:
    for part in parts:
        if _SETTING_STATEMENT.match(part.source):
            condition = f"{shorten_middle(part.condition, _MAX_STATEMENT_CHARACTERS)}: " if part.condition else ""
            yield condition + shorten_middle(part.source, _MAX_STATEMENT_CHARACTERS)


def _differ_in_names(removed: Sequence[CodePart], added: Sequence[CodePart]) -> bool:
    """Return whether statements differ only in consistently renamed variables and parameters."""
    old, new = ("\n".join(part.text for part in parts) for parts in (removed, added))
    if _CODE_NAME.sub("", old) != _CODE_NAME.sub("", new):
        return False
    pairs = set(zip(_CODE_NAME.findall(old), _CODE_NAME.findall(new), strict=True))
    return len({before for before, _ in pairs}) == len({after for _, after in pairs}) == len(pairs)


def _are_versions_of_one_statement(old: CodePart, new: CodePart) -> bool:
    """Return whether two statements differ and are probably versions of the same one."""
    return (
        old.source != new.source
        and SequenceMatcher(None, old.source, new.source, autojunk=False).ratio() >= MIN_SIMILARITY
    )
