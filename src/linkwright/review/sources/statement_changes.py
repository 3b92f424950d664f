"""Compare the statements of a changed source: values, long texts, code of functions, keys and constants."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.sources.changed_sources import ChangedSources
from linkwright.review.sources.names import CPP_SUFFIXES, DYNAMIC_SUFFIX, PYTHON_SUFFIX
from linkwright.review.sources.python.command_arguments import find_read_arguments
from linkwright.review.sources.python.deferred_imports import find_deferred_imports
from linkwright.review.sources.python.replaced_literals import find_replaced_literals
from linkwright.review.sources.python.unreached_code import find_unreached_code
from linkwright.review.sources.reading import try_parse_versions
from linkwright.review.sources.statements.added_texts import TextsChange, find_constant_changes, find_key_changes
from linkwright.review.sources.statements.attribute_changes import find_attribute_changes
from linkwright.review.sources.statements.changed_texts import find_text_changes
from linkwright.review.sources.statements.changed_values import find_value_changes
from linkwright.review.sources.statements.code import Code
from linkwright.review.sources.statements.code_changes import (
    CodeChange,
    ReportedLines,
    find_added_code,
    find_code_change,
)
from linkwright.review.sources.statements.deprecations import find_deprecations
from linkwright.review.sources.statements.frame_changes import find_frame_changes
from linkwright.review.sources.statements.lost_message_frames import find_lost_message_frames
from linkwright.review.sources.statements.moved_calls import find_moved_calls
from linkwright.review.sources.statements.moved_code import without_functions, without_statements
from linkwright.review.sources.statements.new_assertions import find_new_assertions
from linkwright.review.sources.statements.new_failures import FailureSide, find_new_failures
from linkwright.review.sources.statements.opened_files import describe_opened_files
from linkwright.review.sources.statements.opposite_signs import find_opposite_reason
from linkwright.review.sources.statements.renamed_classes import drop_reported, find_renamed_classes, rename_classes
from linkwright.review.sources.statements.renamed_variables import find_renamed_variables
from linkwright.review.sources.statements.renamed_words import rename_words
from linkwright.review.sources.statements.replaced_cpp_literals import find_replaced_cpp_literals
from linkwright.review.sources.statements.returned_codes import find_returned_codes
from linkwright.review.sources.statements.shown_statements import describe_outside_statements, find_shown_statements
from linkwright.review.sources.statements.started_commands import find_command_changes


def compare_statements(
    old: ChangedSources, new: ChangedSources, file: ChangedFile, reported: Sequence[Change]
) -> list[Change]:
    """Return the changed statements of a source that other lines do not report.

    Args:
        old: the changed sources of the old version.
        new: the changed sources of the new version.
        file: the source.
        reported: the other lines about the source.
    """
    changes = [*reported, *_compare_constants(old, new, file, reported)]
    if file.old_path is not None and file.new_path is not None:
        changes += _compare_frames(old, new, file, reported)
        changes += _find_failures(old, new, file.old_path, file.new_path)
        changes += _find_arguments(old, new, file.old_path, file.new_path)
        changes += _find_moved_calls(old, new, file.old_path, file.new_path)
        changes += _find_assertions(old, new, file.old_path, file.new_path)
        changes += _find_returned_codes(old, new, file.old_path, file.new_path)
        changes += _compare_values(old, new, file, changes)
        changes += _find_renamed_variables(old, new, file, changes)
        changes += _find_attributes(old, new, file, changes)
        changes += _compare_commands(old, new, file, changes)
        changes += _compare_code(old, new, file, changes)
        changes += _compare_keys(old, new, file, changes)
        changes += _find_deprecations(old, new, file)
        changes += _find_unreached_code(old, new, file.old_path, file.new_path)
    elif file.new_path is not None:
        changes += _compare_commands(old, new, file, changes)
        changes += _find_added_code(old, new, file.new_path, changes)
        if not changes and file.new_path.endswith(PYTHON_SUFFIX):
            changes += _find_opened_files(new, file.new_path)
    return changes[len(reported) :]


def _compare_values(
    old: ChangedSources, new: ChangedSources, file: ChangedFile, reported: Sequence[Change]
) -> Iterator[Change]:
    """Yield the functions in which only literals differ, and the texts of several lines that differ."""
    if file.old_path is None or file.new_path is None:
        return
    paths = old.version.file(file.old_path), new.version.file(file.new_path)
    if file.path.endswith(CPP_SUFFIXES):
        lines = [str(change.sentence) for change in reported]
        replaced = [*find_replaced_cpp_literals(*paths, new.get_names(file.new_path), lines)]
    else:
        parsed = try_parse_versions(*paths)
        replaced = [] if parsed is None else [*find_replaced_literals(*parsed), *find_deferred_imports(*parsed)]
    sentences = [*(str(change.sentence) for change in reported), *(str(text) for text, _ in replaced)]
    for text, span in (*replaced, *find_value_changes(*paths, sentences)):
        reason = find_opposite_reason(text, new.get_names(file.new_path))
        effect = Effect.CHANGED if reason is None else Effect.BREAKING
        yield Change(text, effect, reason, Location(file.new_path, span.line, span.column))
    for change in find_text_changes(*paths):
        path = file.old_path if change.is_old else file.new_path
        yield Change(change.sentence, location=Location(path, change.line, 1, change.is_old))


def _find_attributes(
    old: ChangedSources, new: ChangedSources, file: ChangedFile, reported: Sequence[Change]
) -> Iterator[Change]:
    """Yield the attributes with literal values that only one version of a constructor in Python sets."""
    before, after = old.codes.get(file.old_path or ""), new.codes.get(file.new_path or "")
    if before is None or after is None or file.path.endswith(CPP_SUFFIXES):
        return
    sentences = [str(change.sentence) for change in reported]
    for change in find_attribute_changes(before, after, (old.has_word, new.has_word), sentences):
        yield _make_code_change(change, file)


def _find_renamed_variables(
    old: ChangedSources, new: ChangedSources, file: ChangedFile, reported: Sequence[Change]
) -> Iterator[Change]:
    """Yield the variables of functions that have another name and another initial value, unless other lines do."""
    before, after = old.codes.get(file.old_path or ""), new.codes.get(file.new_path or "")
    told = {change.location.line for change in reported if change.location and not change.location.is_old}
    for item in find_renamed_variables(before, after) if before and after else ():
        if item.line not in told:
            text = phrase("values in {name}: {values}", name=item.function, values=item.text)
            yield Change(text, location=Location(file.new_path or "", item.line, 1))


def _find_returned_codes(old: ChangedSources, new: ChangedSources, old_path: str, new_path: str) -> Iterator[Change]:
    """Yield the constants that functions newly return."""
    before, after = old.codes.get(old_path), new.codes.get(new_path)
    for item in find_returned_codes(before, after) if before and after else ():
        yield Change(item.sentence, location=Location(new_path, item.line, 1))


def _compare_frames(
    old: ChangedSources, new: ChangedSources, file: ChangedFile, reported: Sequence[Change]
) -> Iterator[Change]:
    """Yield the messages whose frames come from another message or variable, or are no longer set."""
    before, after = old.codes.get(file.old_path or ""), new.codes.get(file.new_path or "")
    if before is None or after is None:
        return
    sentences = [str(change.sentence) for change in reported]
    for change in (*find_frame_changes(before, after, sentences), *find_lost_message_frames(before, after)):
        effect = Effect.CHANGED if change.reason is None else Effect.BREAKING
        yield Change(change.sentence, effect, change.reason, Location(file.new_path or "", change.line, 1))


def _find_failures(old: ChangedSources, new: ChangedSources, old_path: str, new_path: str) -> Iterator[Change]:
    """Yield the conditions under which functions newly throw an error or exit."""
    sides = []
    for sources, path in ((old, old_path), (new, new_path)):
        code = sources.codes.get(path)
        text = sources.version.text(path)
        if code is None:
            return
        sides.append(FailureSide(code, sources.get_names(path), text, is_cpp=path.endswith(CPP_SUFFIXES)))
    for change in find_new_failures(*sides):
        effect = Effect.CHANGED if change.reason is None else Effect.BREAKING
        yield Change(change.sentence, effect, change.reason, Location(new_path, change.line, 1))


def _find_arguments(old: ChangedSources, new: ChangedSources, old_path: str, new_path: str) -> Iterator[Change]:
    """Yield the argument of the command line that a program in Python newly needs."""
    if new_path.endswith(PYTHON_SUFFIX):
        parsed = try_parse_versions(old.version.file(old_path), new.version.file(new_path))
        for item in find_read_arguments(*parsed) if parsed is not None else ():
            location = Location(new_path, item.span.line, item.span.column)
            yield Change(item.sentence, Effect.BREAKING, item.reason, location)


def _find_moved_calls(old: ChangedSources, new: ChangedSources, old_path: str, new_path: str) -> Iterator[Change]:
    """Yield the calls that send something and that move into a condition, or out of one."""
    before, after = old.codes.get(old_path), new.codes.get(new_path)
    if before is not None and after is not None:
        for item in find_moved_calls(before, after, old.get_names(old_path), new.get_names(new_path)):
            yield Change(item.text, location=Location(new_path, item.line, 1))


def _find_assertions(old: ChangedSources, new: ChangedSources, old_path: str, new_path: str) -> Iterator[Change]:
    """Yield the conditions that functions newly assert."""
    before, after = old.codes.get(old_path), new.codes.get(new_path)
    for item in find_new_assertions(before, after, is_cpp=new_path.endswith(CPP_SUFFIXES)) if before and after else ():
        yield Change(item.sentence, location=Location(new_path, item.line, 1))


def _find_deprecations(old: ChangedSources, new: ChangedSources, file: ChangedFile) -> Iterator[Change]:
    """Yield the new texts that say that something is deprecated."""
    texts = old.version.text(file.old_path or ""), new.version.text(file.new_path or "")
    for text, line in find_deprecations(*texts, is_cpp=file.path.endswith(CPP_SUFFIXES)):
        yield Change(text, location=Location(file.path, line, 1))


def _find_unreached_code(old: ChangedSources, new: ChangedSources, old_path: str, new_path: str) -> Iterator[Change]:
    """Yield the statements of a Python source that a new exit keeps from running."""
    paths = old.version.file(old_path), new.version.file(new_path)
    parsed = try_parse_versions(*paths) if new_path.endswith(PYTHON_SUFFIX) else None
    for text, span in () if parsed is None else find_unreached_code(*parsed):
        yield Change(text, location=Location(new_path, span.line, span.column))


def _compare_code(
    old: ChangedSources, new: ChangedSources, file: ChangedFile, reported: Sequence[Change]
) -> Iterator[Change]:
    """Yield the functions whose code changes, with the changed statements that tell most, unless other lines do."""
    old_path, new_path = file.old_path or file.path, file.new_path or file.path
    before, after = old.codes.get(old_path), new.codes.get(new_path)
    if not before or not after:
        return
    renamed = drop_reported(find_renamed_classes(before, after), [str(change.sentence) for change in reported])
    words = {**old.new_packages, **new.find_renamed_words(old)}
    before = rename_words(rename_classes(before, renamed), after, words)
    before = old.rename_imports(before, after)

    def has_moved(name: str, code: Code) -> bool:
        side, path = (new, new_path) if code is before else (old, old_path)
        return side.has_function(name, code, path)

    moved = new.find_moved_code(old).get(new_path)
    if moved is not None:
        line = before.outside[""][0].first_line
        moving = Change(moved.format(new_path), location=Location(old_path, line, 1, is_old=True), is_code=True)
        yield moving
        reported = [*reported, moving]
        own = [moved.function] if moved.path == new_path else []
        before, after = without_statements(before), without_functions(without_statements(after), own)
    names = new.get_names(new_path)
    found = find_shown_statements(before, after, ReportedLines(reported), names)
    shown = [_make_code_change(change, file) for change in found]
    yield from shown
    all_reported = [*reported, *shown]
    describe_outside = partial(describe_outside_statements, before, after, all_reported)
    change = find_code_change(before, after, all_reported, has_moved, names, renamed, describe_outside)
    if change is not None:
        location = Location(old_path if change.is_old else new_path, change.line, 1, change.is_old)
        yield Change(change.text, location=location, is_code=True)


def _find_opened_files(new: ChangedSources, path: str) -> Iterator[Change]:
    """Yield the files that an added script reads and writes of which no other line tells anything."""
    found = describe_opened_files(new.version.file(path))
    if found is not None:
        yield Change(found[0], location=Location(path, found[1].line, found[1].column))


def _find_added_code(
    old: ChangedSources, new: ChangedSources, path: str, reported: Sequence[Change]
) -> Iterator[Change]:
    """Yield the functions of an added program that no other line names."""
    code = new.codes.get(path)
    if code is None or not new.get_names(path).is_program:
        return
    moved = [(item.path, item.function) for item in new.find_moved_code(old).values()]

    def has_moved(name: str, own: Code) -> bool:
        return old.has_function(name, own, path) or (path, name) in moved

    change = find_added_code(code, reported, has_moved, new.get_names(path))
    if change is not None:
        yield Change(change.text, location=Location(path, change.line, 1, change.is_old), is_code=True)


def _compare_keys(
    old: ChangedSources, new: ChangedSources, file: ChangedFile, reported: Sequence[Change]
) -> Iterator[Change]:
    if file.old_path is None or file.new_path is None or file.new_path.endswith(DYNAMIC_SUFFIX):
        return
    paths = old.version.file(file.old_path), new.version.file(file.new_path)
    sentences = [str(change.sentence) for change in reported]
    for change in find_key_changes(paths, (old.has_text, new.has_text), sentences):
        yield _make_change(change, file)


def _compare_commands(
    old: ChangedSources, new: ChangedSources, file: ChangedFile, reported: Sequence[Change]
) -> Iterator[Change]:
    """Yield the commands and programs that only one version of a source starts."""
    paths = old.version.file(file.old_path or ""), new.version.file(file.new_path or "")
    sentences = [str(change.sentence) for change in reported]
    for change in find_command_changes(paths, (old.has_text, new.has_text), sentences):
        yield _make_change(change, file)


def _compare_constants(
    old: ChangedSources, new: ChangedSources, file: ChangedFile, reported: Sequence[Change]
) -> Iterator[Change]:
    if file.new_path is None or file.new_path.endswith(DYNAMIC_SUFFIX):
        return
    old_file = None if file.old_path is None else old.version.file(file.old_path)
    sentences = [str(change.sentence) for change in reported]
    paths = old_file, new.version.file(file.new_path)
    for change in find_constant_changes(paths, (old.has_word, new.has_word), sentences):
        yield _make_change(change, file)


def _make_code_change(change: CodeChange, file: ChangedFile) -> Change:
    path = (file.old_path if change.is_old else file.new_path) or file.path
    return Change(change.text, location=Location(path, change.line, 1, change.is_old))


def _make_change(change: TextsChange, file: ChangedFile) -> Change:
    path = (file.old_path if change.is_old else file.new_path) or file.path
    return Change(change.sentence, location=Location(path, change.span.line, change.span.column, change.is_old))
