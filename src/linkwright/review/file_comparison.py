"""Compare a file in both versions, or list the contents of a file that only one of them has."""

from __future__ import annotations

from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError, Phrase, phrase
from linkwright.review.changes import Change, Effect, PathChange, Problem, Subject, SubjectKind, ViewImages
from linkwright.review.drawings.images import lone_images
from linkwright.review.drawings.scene_images import lone_world_images
from linkwright.review.failures import failure_problem
from linkwright.review.file_pair import Drawings, FilePair, UnreadableFileError
from linkwright.review.installed_paths import keeps_installed_path, keeps_type
from linkwright.review.kinds import KindRule, rule_of_contents
from linkwright.review.robots.lone_robots import read_lone_robot, robot_text
from linkwright.review.versions import Version, Versions


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
    if old_path is None or new_path is None:
        return _compare_lone_file(versions, rule, old_path, new_path, drawings)
    pair = FilePair(versions, old_path, new_path, drawings)
    try:
        if old_path != new_path:
            pair.changes.append(_renaming_change(versions, rule, old_path, new_path))
        rule.compare(pair)
    except Exception as error:  # noqa: BLE001 - whatever it is, the other files are compared
        pair.problems.append(failure_problem(error))
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
    )


def _compare_lone_file(
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
        rule = rule_of_contents(rule, version, path)
        text = rule.added if new_path is not None else rule.removed
        if new_path is not None or rule.shows_removed:
            text = _text_with_contents(rule, text, version, path)
        changes, images = _lone_contents(version, kind, path, drawings)
    except Exception as error:  # noqa: BLE001
        problems.append(failure_problem(error))
    if rule.needs_contents and not problems and "items" not in text.arguments:
        return Subject(kind, path, old_path, new_path)
    change = Change(text, Effect.CHANGED if reason is None else Effect.BREAKING, reason)
    return Subject(kind, path, old_path, new_path, [change, *changes], problems=problems, images=images)


def _renaming_change(versions: Versions, rule: KindRule, old_path: str, new_path: str) -> Change:
    """Return the change that reports a renamed or moved file."""
    old, new = PurePosixPath(old_path), PurePosixPath(new_path)
    if old.name == new.name and rule.removal_reason is not None and keeps_installed_path(versions, old_path, new_path):
        text = phrase("moved from {folder}, installed at the same place", folder=f"{old.parent}/")
        return Change(text, path_change=PathChange.MOVED)
    if rule.kind is SubjectKind.INTERFACE and keeps_type(versions, old_path, new_path):
        text = phrase("moved from {folder}, the type keeps its name", folder=f"{old.parent}/")
        return Change(text, path_change=PathChange.MOVED)
    effect = Effect.CHANGED if rule.removal_reason is None else Effect.BREAKING
    text = phrase("renamed from {path}", path=old_path)
    return Change(text, effect, rule.removal_reason, path_change=PathChange.RENAMED)


def _text_with_contents(rule: KindRule, text: Phrase, version: Version, path: str) -> Phrase:
    """Return the line about an added or removed file, with its contents if they are known."""
    try:
        contents = None if rule.contents is None else rule.contents(version, path)
    except (LinkwrightError, UnreadableFileError, OSError, ValueError, RecursionError, MemoryError):
        contents = None
    return text if contents is None else phrase("{change}: {items}", change=text, items=contents)


def _lone_contents(
    version: Version, kind: SubjectKind, path: str, drawings: Drawings
) -> tuple[list[Change], list[ViewImages]]:
    """Return the change about the contents of a file that only one version has, and images of it."""
    if kind is SubjectKind.WORLD:
        return [], lone_world_images(version, path) if drawings.images else []
    found = read_lone_robot(version, path) if kind is SubjectKind.DESCRIPTION else None
    if found is None:
        return [], []
    model, robot = found
    images = lone_images(model, robot, is_old=version.is_old) if drawings.images else []
    return [Change(robot_text(robot))], images
