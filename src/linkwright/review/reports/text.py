"""Write the report of a review as text for a terminal."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Phrase, counted, phrase
from linkwright.diagnostics.phrase import count_shown
from linkwright.diagnostics.render import make_printable
from linkwright.diagnostics.translation import localized
from linkwright.review.changes import Effect, Review
from linkwright.review.reports.finding_groups import group_findings
from linkwright.review.reports.sections import Section, divide_report, format_summary
from linkwright.review.reports.sentences import (
    format_alike,
    format_cases_of,
    format_change,
    format_figure_name,
    format_repeated,
    get_path_state,
    list_other_files,
)
from linkwright.review.texts.excerpts import shorten

_MAX_OTHER_FILES = 20
"""The maximum number of files that are listed although they were not compared."""
_MAX_CHARACTERS = 1000
"""The maximum number of characters of a change or reason."""
_NEWLINE = "\N{SYMBOL FOR NEWLINE}"
"""The character that replaces a newline in the name of a file."""


def as_text(review: Review) -> str:
    """Return the report as text in the user's language, a line for each change."""
    return "".join(make_printable(line).replace("\n", _NEWLINE) + "\n" for line in _format_report(review))


def _format_report(review: Review) -> Iterator[str]:
    for section in divide_report(review):
        yield from _format_section(section)
    if review.other_files:
        yield localized(phrase("other changed files"))
        files = list_other_files(review)
        shown = count_shown(len(files), _MAX_OTHER_FILES)
        for path, state in files[:shown]:
            yield f"  {path}" if state is None else f"  {path} ({localized(state)})"
        remaining_count = len(files) - shown
        if remaining_count > 0:
            yield f"  {localized(counted('{count} more file', '{count} more files', remaining_count))}"
        yield ""
    for title, findings in (
        (phrase("new findings"), review.new_findings),
        (phrase("fixed findings"), review.fixed_findings),
    ):
        if findings:
            yield localized(title)
            yield from map(_format_finding, group_findings(findings))
            yield ""
    for note in review.notes:
        yield localized(phrase("note: {text}", text=note))
    yield localized(format_summary(review))


def _format_section(section: Section) -> Iterator[str]:
    subject = section.subject
    state = get_path_state(subject)
    yield subject.path if state is None else f"{subject.path} ({localized(state)})"
    for change, cases in zip(section.changes, format_cases_of(section.changes, subject), strict=True):
        mark = "!" if change.effect is Effect.BREAKING else "-"
        text = shorten(localized(format_change(change)), _MAX_CHARACTERS)
        yield f"  {mark} {text}{f' ({localized(cases)})' if cases else ''}"
        if change.reason is not None:
            yield f"    {shorten(localized(phrase('breaking: {reason}', reason=change.reason)), _MAX_CHARACTERS)}"
        if change.location is not None:
            place = f"{change.location.file}:{change.location.line}:{change.location.column}"
            yield f"    {localized(phrase('{place} (old)', place=place)) if change.location.is_old else place}"
    for repeat in section.repeated:
        yield f"  - {localized(format_repeated(repeat))}"
    alike = format_alike(section.alike)
    if alike is not None:
        yield f"  = {localized(alike)}"
    for figure in subject.figures:
        name = localized(format_figure_name(figure))
        yield f"  # {name}: {figure.old or '-'} -> {figure.new or '-'} {figure.unit}".rstrip()
    for problem in subject.problems:
        yield f"  ? {localized(problem.text)}"
    yield ""


def _format_finding(finding: Diagnostic) -> str:
    location = "" if finding.span is None else f"{finding.span.file}:{finding.span.line}: "
    message: Phrase | str = finding.message
    text = localized(message) if isinstance(message, Phrase) else message
    return f"  {location}{finding.severity.value}[{finding.code}] {' '.join(text.split())}"
