"""Write the report of a review as text for a terminal."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Phrase, counted, phrase
from linkwright.diagnostics.render import make_printable
from linkwright.diagnostics.translation import localized
from linkwright.review.changes import Effect, Review
from linkwright.review.reports.sections import (
    Section,
    alike_text,
    cases_text,
    group_findings,
    other_files,
    repeated_text,
    sections_of,
    sentence_of,
    summary_text,
)

_MAX_OTHER_FILES = 20
"""The maximum number of files that are listed although they were not compared."""
_NEWLINE = "\N{SYMBOL FOR NEWLINE}"
"""The character that replaces a newline in the name of a file."""


def as_text(review: Review) -> str:
    """Return the report as text in the user's language, a line for each change."""
    return "".join(make_printable(line).replace("\n", _NEWLINE) + "\n" for line in _report_lines(review))


def _report_lines(review: Review) -> Iterator[str]:
    for section in sections_of(review):
        yield from _section_lines(section)
    if review.other_files:
        yield localized(phrase("other changed files"))
        files = other_files(review)
        for path, state in files[:_MAX_OTHER_FILES]:
            yield f"  {path}" if state is None else f"  {path} ({localized(state)})"
        rest = len(files) - _MAX_OTHER_FILES
        if rest > 0:
            yield f"  {localized(counted('{count} more file', '{count} more files', rest))}"
        yield ""
    for title, findings in (
        (phrase("new findings"), review.new_findings),
        (phrase("fixed findings"), review.fixed_findings),
    ):
        if findings:
            yield localized(title)
            yield from map(_finding_text, group_findings(findings))
            yield ""
    for note in review.notes:
        yield localized(phrase("note: {text}", text=note))
    yield localized(summary_text(review))


def _section_lines(section: Section) -> Iterator[str]:
    subject = section.subject
    yield subject.path
    for change in section.changes:
        mark = "!" if change.effect is Effect.BREAKING else "-"
        cases = cases_text(change, subject)
        yield f"  {mark} {localized(sentence_of(change))}{f' ({localized(cases)})' if cases else ''}"
        if change.reason is not None:
            yield f"    {localized(phrase('breaking: {reason}', reason=change.reason))}"
        if change.location is not None:
            yield f"    {change.location.file}:{change.location.line}:{change.location.column}"
    for path, count in section.repeated:
        yield f"  - {localized(repeated_text(path, count))}"
    alike = alike_text(section)
    if alike is not None:
        yield f"  = {localized(alike)}"
    for figure in subject.figures:
        yield f"  # {localized(figure.name)}: {figure.old or '-'} -> {figure.new or '-'} {figure.unit}".rstrip()
    for problem in subject.problems:
        yield f"  ? {localized(problem.text)}"
    yield ""


def _finding_text(finding: Diagnostic) -> str:
    location = "" if finding.span is None else f"{finding.span.file}:{finding.span.line}: "
    message: Phrase | str = finding.message
    text = localized(message) if isinstance(message, Phrase) else message
    return f"  {location}{finding.severity.value}[{finding.code}] {' '.join(text.split())}"
