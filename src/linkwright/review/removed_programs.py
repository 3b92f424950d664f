"""Leave the options of a removed program to the line that reports the removal of the program."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.review.changes import Change, Effect, Subject, SubjectKind
from linkwright.review.sources.names import NameKind

_QUOTED = re.compile(r"'([^']+)'")


def merge_removed_options(subjects: Sequence[Subject]) -> list[Subject]:
    """Return the subjects, with options that are not breaking beside the removal of their program.

    The build file of the package reports the removal of the program.
    """
    builds = [subject for subject in subjects if subject.kind is SubjectKind.BUILD]
    result = []
    for subject in subjects:
        is_program = subject.kind is SubjectKind.SOURCE and subject.new_path is None
        if is_program and any(_reports_removal(build, PurePosixPath(subject.path)) for build in builds):
            changes = [
                replace(change, effect=Effect.CHANGED, reason=None) if _is_of_options(change) else change
                for change in subject.changes
            ]
            subject = replace(subject, changes=changes)
        result.append(subject)
    return result


def _reports_removal(build: Subject, program: PurePosixPath) -> bool:
    """Return whether a build file of the package of a program reports its removal as breaking."""
    return program.is_relative_to(PurePosixPath(build.path).parent) and any(
        not {program.name, program.stem}.isdisjoint(_QUOTED.findall(str(change.sentence)))
        for change in build.changes
        if change.effect is Effect.BREAKING
    )


def _is_of_options(change: Change) -> bool:
    return change.sentence.arguments.get("kind") == NameKind.OPTION.plural
