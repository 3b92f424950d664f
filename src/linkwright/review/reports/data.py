"""Write the report of a review as data for programs."""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import Diagnostic, Severity, Span, phrase, to_data
from linkwright.review.changes import Change, Effect, Location, Review, Subject
from linkwright.review.paths import PathComparison
from linkwright.review.reports.sentences import format_change

BREAKING_CODE = "REV201"
FAILURE_CODE = "REV202"
_DIGITS = 6
"""The digits after the decimal point of times in s and positions in m."""


def as_data(review: Review) -> dict[str, Any]:
    """Return the review as JSON-ready data.

    Texts are in English; lines and columns count from 1.
    """
    return {
        "old": review.old_name,
        "new": review.new_name or None,
        "subjects": [_subject_to_data(subject) for subject in review.subjects],
        "other_files": list(review.other_files),
        "new_findings": [to_data(finding) for finding in review.new_findings],
        "fixed_findings": [to_data(finding) for finding in review.fixed_findings],
        "notes": list(review.notes),
    }


def as_diagnostics(review: Review) -> list[Diagnostic]:
    """Return the results for SARIF.

    They are the breaking changes (REV201), the failed comparisons (REV202) and the new findings.
    """
    breaking = [
        Diagnostic(
            BREAKING_CODE,
            phrase("{change}: {reason}", change=format_change(change), reason=change.reason or ""),
            severity=Severity.WARNING,
            span=_location_to_span(change.location),
        )
        for _, change in review.breaking_changes
    ]
    failed = [
        Diagnostic(FAILURE_CODE, problem.text, severity=Severity.WARNING, span=Span(subject.path, 1, 1, 1, 1))
        for subject in review.subjects
        for problem in subject.problems
        if problem.is_bug
    ]
    return [*breaking, *failed, *review.new_findings]


def _location_to_span(location: Location | None) -> Span | None:
    """Return the location in the new version, or None for a removed element."""
    if location is None or location.is_old:
        return None
    return Span(location.file, location.line, location.column, location.line, location.column)


def _subject_to_data(subject: Subject) -> dict[str, Any]:
    return {
        "kind": subject.kind.value,
        "path": subject.path,
        "old_path": subject.old_path,
        "new_path": subject.new_path,
        "argument_sets": list(subject.cases),
        "changes": [_change_to_data(change) for change in subject.changes],
        "figures": [
            {"name": str(figure.name), "old": figure.old, "new": figure.new, "unit": figure.unit}
            for figure in subject.figures
        ],
        "paths": [_paths_to_data(comparison) for comparison in subject.paths],
        "problems": [str(problem.text) for problem in subject.problems],
        "is_complete": not any(problem.is_bug for problem in subject.problems),
    }


def _paths_to_data(comparison: PathComparison) -> dict[str, Any]:
    """Return the paths of runs with the same parameters as data: times in s, positions in m."""
    return {
        "name": comparison.name,
        "parameters": comparison.parameters,
        "runs": [
            {
                "seed": pair.seed,
                "distance": _round(pair.distance),
                "time": _round(pair.time),
                "old": [list(map(_round, point)) for point in pair.old],
                "new": [list(map(_round, point)) for point in pair.new],
            }
            for pair in comparison.shown
        ],
    }


def _round(number: float) -> float:
    return round(number, _DIGITS) + 0.0


def _change_to_data(change: Change) -> dict[str, Any]:
    location = change.location
    return {
        "text": str(change.sentence),
        "is_breaking": change.effect is Effect.BREAKING,
        "reason": None if change.reason is None else str(change.reason),
        "also": list(change.other_names),
        "argument_sets": list(change.cases),
        "location": None
        if location is None
        else {
            "file": location.file,
            "line": location.line,
            "column": location.column,
            "version": "old" if location.is_old else "new",
        },
    }
