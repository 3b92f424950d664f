"""Compare a file in both versions, or list the contents of a file that only one of them has."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError, Phrase, foreign, phrase
from linkwright.diagnostics.phrase import as_phrase
from linkwright.review.changes import Change, Effect, PathChange, Problem, Subject, SubjectKind, ViewImages
from linkwright.review.drawings.images import render_unpaired_robot
from linkwright.review.drawings.scene_images import render_unpaired_world
from linkwright.review.failures import make_problem
from linkwright.review.file_pair import Drawings, FilePair, UnreadableFileError
from linkwright.review.files.build.unbuilt_interfaces import is_unbuilt
from linkwright.review.files.interfaces import find_syntax_errors
from linkwright.review.files.parameters.generated import generates_code
from linkwright.review.files.parameters.yaml_values import compose_yaml, read_yaml_text
from linkwright.review.installed_paths import (
    is_without_manifest,
    keeps_installed_path,
    keeps_type,
)
from linkwright.review.kinds import KindRule, adapt_rule_to_contents
from linkwright.review.launches.imports import find_failing_imports
from linkwright.review.launches.python.undefined import find_undefined_names
from linkwright.review.launches.reading import read_outline
from linkwright.review.robots.unpaired_robots import format_robot, read_unpaired_robot, read_with_argument_names
from linkwright.review.texts.folders import without_folder
from linkwright.review.users.unused_test_files import is_test_file, is_unused_file, is_unused_test_file
from linkwright.review.versions import Version, Versions
from linkwright.sdf.text import parse_as_gazebo
from linkwright.xacro.cache import read_document
from linkwright.xmltree.reader import read_bytes

_TESTED_KINDS = (SubjectKind.PARAMETERS, SubjectKind.LAUNCH_FILE)
"""The kinds of files whose changes are not breaking if only tests use the files."""

_INSTALLED_KINDS = frozenset(
    {
        *(SubjectKind.DESCRIPTION, SubjectKind.WORLD, SubjectKind.TEMPLATE, SubjectKind.SEMANTICS),
        *(SubjectKind.LAUNCH_FILE, SubjectKind.BEHAVIOR_TREE, SubjectKind.PARAMETERS, SubjectKind.MAP),
        *(SubjectKind.RVIZ, SubjectKind.MUJOCO),
    }
)
"""The kinds of files that programs and users find in the share folder of their package."""
_COPIED_KINDS = (SubjectKind.PARAMETERS, SubjectKind.RVIZ)
"""The kinds of added files that, as copies of other files, are shown without contents."""
_MIN_COPIED_CHARACTERS = 100


def compare_file(
    versions: Versions, rule: KindRule, old_path: str | None, new_path: str | None, drawings: Drawings
) -> Subject:
    """Compare a file in both versions.

    Args:
        versions: both versions of the repository.
        rule: the rule for the file.
        old_path: the path in the old version; None for an added file.
        new_path: the path in the new version; None for a removed file.
        drawings: the kinds of drawings of robots that look different.
    """
    if old_path is not None and old_path != new_path:
        is_unused = rule.kind in _INSTALLED_KINDS and is_unused_file(versions, old_path)
        if is_unused or _is_without_users(versions.old, rule, old_path):
            rule = replace(rule, removal_reason=None)
    is_test = rule.kind in _TESTED_KINDS and old_path is not None and is_test_file(versions.old, old_path)
    if old_path is None or new_path is None:
        rule = replace(rule, removal_reason=None) if is_test else rule
        return _describe_unpaired_file(versions, rule, old_path, new_path, drawings)
    pair = FilePair(versions, old_path, new_path, drawings)
    try:
        if old_path != new_path:
            pair.changes.append(_make_renaming_change(versions, rule, old_path, new_path))
        rule.compare(pair)
        if pair.is_gained and rule.kind in _TESTED_KINDS:
            _show_contents(pair, rule)
    except Exception as error:  # noqa: BLE001 - the other files are still compared
        pair.problems.append(make_problem(error))
    if is_test and not pair.is_lost:  # no other package uses its names
        pair.changes = [
            change if change.path_change is not None else replace(change, effect=Effect.CHANGED, reason=None)
            for change in pair.changes
        ]
    return Subject(
        rule.kind,
        new_path,
        old_path,
        new_path,
        pair.changes,
        pair.figures,
        pair.problems,
        pair.cases,
        pair.images,
        scene=pair.scene,
        expanded=pair.expanded,
        missing=tuple(pair.missing),
        is_lost=pair.is_lost,
        added_topics=pair.added_topics,
    )


def _is_without_users(version: Version, rule: KindRule, path: str) -> bool:
    """Return whether no program can use a file by its installed path or as a type."""
    if rule.kind is SubjectKind.INTERFACE and is_unbuilt(version, path):
        return True
    return is_without_manifest(version, path) or generates_code(version, path)


def _show_contents(pair: FilePair, rule: KindRule) -> None:
    """Append the contents of a file that only the new version can read to the last change, which tells this."""
    change = pair.changes[-1]
    contents = _find_contents(rule, pair.versions.new, pair.new_path)
    if contents is not None:
        text = phrase("{change}; contents: {items}", change=change.sentence, items=contents)
        pair.changes[-1] = replace(change, sentence=text)


def _describe_unpaired_file(
    versions: Versions, rule: KindRule, old_path: str | None, new_path: str | None, drawings: Drawings
) -> Subject:
    """Return the subject of an added or removed file, with its contents."""
    kind, path = rule.kind, new_path or old_path or ""
    version = versions.old if new_path is None else versions.new
    text = rule.added if new_path is not None else rule.removed
    reason = rule.removal_reason if new_path is None else None
    problems: list[Problem] = []
    changes: list[Change] = []
    images: list[ViewImages] = []
    try:
        rule = adapt_rule_to_contents(rule, version, path)
        text = rule.added if new_path is not None else rule.removed
        copied = None if new_path is None or kind not in _COPIED_KINDS else _find_copied_file(versions, new_path)
        if copied is not None:
            text = phrase("{change}: {items}", change=text, items=copied)
        elif new_path is not None or rule.shows_removed:
            text = _add_contents(rule, text, version, path)
        changes, images = _describe_contents(version, kind, path, drawings)
        if kind is SubjectKind.LAUNCH_FILE and new_path is not None:
            changes += [*find_undefined_names(version, path), *find_failing_imports(versions, path)]
        elif kind is SubjectKind.INTERFACE and new_path is not None:
            changes += find_syntax_errors(version, path)
        problems += [] if new_path is None else _find_unreadable(version, kind, path, text, changes)
    except Exception as error:  # noqa: BLE001
        problems.append(make_problem(error))
    if rule.needs_contents and not problems and "items" not in text.arguments:
        return Subject(kind, path, old_path, new_path)
    change = Change(text, Effect.CHANGED if reason is None else Effect.BREAKING, reason)
    return Subject(kind, path, old_path, new_path, [change, *changes], problems=problems, images=images)


def _find_unreadable(
    version: Version, kind: SubjectKind, path: str, text: Phrase, contents: Sequence[Change]
) -> list[Problem]:
    """Return the problem that an added file of these kinds cannot be read; an empty list if it can.

    A description may need values that only its callers know, so that only XML counts.
    """
    file = version.file(path)
    try:
        if kind is SubjectKind.WORLD:
            parse_as_gazebo(read_bytes(str(file)), str(file))
        elif kind in (SubjectKind.DESCRIPTION, SubjectKind.SEMANTICS) and not contents:
            read_document(str(file))
        elif kind is SubjectKind.LAUNCH_FILE and "items" not in text.arguments:
            read_outline(file, version.root)
        elif kind is SubjectKind.PARAMETERS and not text.arguments:
            compose_yaml(read_yaml_text(file))
    except LinkwrightError as error:
        reason: Phrase = as_phrase(error.diagnostics[0].message)
    except (UnreadableFileError, ValueError) as error:
        reason = error.reason if isinstance(error, UnreadableFileError) else foreign(str(error))
    else:
        return []
    return [Problem(phrase("the file cannot be read: {reason}", reason=without_folder(reason, version.root)))]


def _make_renaming_change(versions: Versions, rule: KindRule, old_path: str, new_path: str) -> Change:
    """Return the change that reports a renamed or moved file."""
    old, new = PurePosixPath(old_path), PurePosixPath(new_path)
    if old.name == new.name and rule.removal_reason is not None and keeps_installed_path(versions, old_path, new_path):
        text = phrase("moved from {folder}, installed at the same place", folder=f"{old.parent}/")
        return Change(text, path_change=PathChange.MOVED)
    if rule.kind is SubjectKind.INTERFACE and keeps_type(versions, old_path, new_path):
        text = phrase("moved from {folder}, the type keeps its name", folder=f"{old.parent}/")
        return Change(text, path_change=PathChange.MOVED)
    reason = None if is_unused_test_file(versions, old_path, new_path) else rule.removal_reason
    effect = Effect.CHANGED if reason is None else Effect.BREAKING
    text = phrase("renamed from {path}", path=old_path)
    return Change(text, effect, reason, path_change=PathChange.RENAMED)


def _find_copied_file(versions: Versions, path: str) -> Phrase | None:
    """Return the file of the same folder of which an added file is a copy, or None."""
    text, folder = versions.new.text(path), PurePosixPath(path).parent.as_posix()
    if len(text) < _MIN_COPIED_CHARACTERS or not versions.old.file(folder).is_dir():
        return None
    for other in versions.old.paths((PurePosixPath(path).suffix,), "" if folder == "." else folder):
        if PurePosixPath(other).parent.as_posix() == folder and versions.old.text(other) == text:
            is_kept = versions.new.text(other) == text
            return phrase("a copy of {path}", path=other) if is_kept else phrase("a copy of the old {path}", path=other)
    return None


def _add_contents(rule: KindRule, text: Phrase, version: Version, path: str) -> Phrase:
    """Return the line about an added or removed file, with its contents if they are known."""
    contents = _find_contents(rule, version, path)
    return text if contents is None else phrase("{change}: {items}", change=text, items=contents)


def _find_contents(rule: KindRule, version: Version, path: str) -> Phrase | None:
    """Return the contents of a file in one line, or None if they are unknown."""
    try:
        return None if rule.contents is None else rule.contents(version, path)
    except (LinkwrightError, UnreadableFileError, OSError, ValueError, RecursionError, MemoryError):
        return None


def _describe_contents(
    version: Version, kind: SubjectKind, path: str, drawings: Drawings
) -> tuple[list[Change], list[ViewImages]]:
    """Return a change with the contents of a file that only one version has, and images."""
    if kind is SubjectKind.WORLD:
        return [], render_unpaired_world(version, path) if drawings.images else []
    model_and_robot = read_unpaired_robot(version, path) if kind is SubjectKind.DESCRIPTION else None
    if model_and_robot is None:
        return [], []
    model, robot = model_and_robot
    images = render_unpaired_robot(model, robot, is_old=version.is_old) if drawings.images else []
    return [Change(format_robot(read_with_argument_names(model, robot)))], images
