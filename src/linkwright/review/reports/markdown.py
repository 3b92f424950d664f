"""Write the report of a review as Markdown for a comment on a pull request (GitHub, GitLab, Gitea)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Diagnostic, Phrase, counted, phrase
from linkwright.diagnostics.render import make_printable
from linkwright.diagnostics.translation import localized
from linkwright.review.changes import Change, Effect, Figure, Review, Subject
from linkwright.review.reports.sections import (
    Section,
    divide_report,
    format_alike,
    format_cases,
    format_change,
    format_location,
    format_paths,
    format_repeated,
    format_summary,
    get_path_state,
    group_findings,
    list_other_files,
    merge_breaking_changes,
)

MARKER = "<!-- linkwright review -->"
"""The first line, by which a program finds the comment to update."""
_MAX_OPEN_CHANGES = 8
"""The maximum number of changes to a file that are shown without a click."""
_MAX_CHARACTERS = 60_000
"""The maximum length of the report. GitHub refuses comments of more than 65 536 characters."""
_SPECIAL = re.compile(r"[&\\`*_{}\[\]<>|~]")
_MENTION = re.compile(r"([@#])(?=\w)")


def as_markdown(review: Review) -> str:
    """Return the report as Markdown in the user's language.

    Names from the repository cannot form links, mentions or HTML. A report too long for a comment is cut, with a
    line about the missing parts at its end.
    """
    parts = [f"{MARKER}\n{_format_heading(review)}", *_format_parts(review)]
    text = ""
    for index, part in enumerate(parts):
        if len(text) + len(part) > _MAX_CHARACTERS:
            return text + "\n" + _escape(_format_omission(len(parts) - index)) + "\n"
        text += ("\n" if text else "") + part + "\n"
    return text


def _format_omission(count: int) -> Phrase:
    return counted(
        "{count} more part does not fit into a comment; the HTML report has it",
        "{count} more parts do not fit into a comment; the HTML report has them",
        count,
    )


def _format_heading(review: Review) -> str:
    new = review.new_name or localized(phrase("working tree"))
    title = _escape(phrase("Robot review: {old} to {new}", old=review.old_name, new=new))
    return f"### {title}\n\n{_escape(format_summary(review))}"


def _format_parts(review: Review) -> Iterator[str]:
    breaking = merge_breaking_changes(review)
    if breaking:
        title = _escape(phrase("Breaking changes"))
        yield "\n".join([f"#### {title}", "", *(_format_breaking_change(paths, change) for paths, change in breaking)])
    yield from filter(None, map(_format_section, divide_report(review)))
    for title, findings in (
        (phrase("New findings"), review.new_findings),
        (phrase("Fixed findings"), review.fixed_findings),
    ):
        if findings:
            heading = _escape(phrase("{title} ({count})", title=title, count=len(findings)))
            yield _format_details(heading, map(_format_finding, group_findings(findings)))
    if review.other_files:
        title = phrase("Other changed files ({count})", count=len(review.other_files))
        yield _format_details(
            _escape(title),
            [f"- {_format_path(path, state)}" for path, state in list_other_files(review)],
        )
    if review.notes:
        yield "\n".join(f"> {_escape(note)}" for note in review.notes)


def _format_path(path: str, state: Phrase | None) -> str:
    return _format_code(path) + ("" if state is None else f" ({_escape(state)})")


def _format_breaking_change(paths: Sequence[str], change: Change) -> str:
    reason = "" if change.reason is None else f": {_escape(change.reason)}"
    return f"- **{_escape(format_change(change))}**{reason} ({_format_code(localized(format_paths(paths)))})"


def _format_section(section: Section) -> str:
    """Return the part about a file.

    The result is empty if all its changes are breaking: these are listed at the beginning.
    """
    subject = section.subject
    lines: list[str] = []
    if subject.figures:
        lines += [*_format_figures(subject.figures), ""]
    changes = [_format_change(change, subject) for change in section.changes if change.effect is not Effect.BREAKING]
    lines += changes[:_MAX_OPEN_CHANGES]
    hidden = changes[_MAX_OPEN_CHANGES:]
    if hidden:
        title = counted("{count} more change", "{count} more changes", len(hidden))
        lines += ["", _format_details(_escape(title), hidden)]
    lines += [f"- {_escape(format_repeated(path, count))}" for path, count in section.repeated]
    alike_line = format_alike(section)
    lines += [] if alike_line is None else [f"- {_escape(alike_line)}"]
    lines += [f"> {_escape(problem.text)}" for problem in subject.problems]
    heading = f"#### {_format_path(subject.path, get_path_state(subject))}"
    return "\n".join([heading, "", *lines]).rstrip() if lines else ""


def _format_change(change: Change, subject: Subject) -> str:
    cases = format_cases(change, subject)
    place = None if change.location is None else format_location(change.location, subject.path)
    location = "" if place is None else f" ({_escape(place) if isinstance(place, Phrase) else _format_code(place)})"
    return f"- {_escape(format_change(change))}{'' if cases is None else ' ' + _escape(cases)}{location}"


def _format_figures(figures: Sequence[Figure]) -> list[str]:
    head = " | ".join(map(_escape, (phrase("quantity"), phrase("before"), phrase("after"), phrase("unit"))))
    rows = [
        f"| {_escape(figure.name)} | {_escape(figure.old)} | {_escape(figure.new)} | {figure.unit} |"
        for figure in figures
    ]
    return [f"| {head} |", "| --- | ---: | ---: | --- |", *rows]


def _format_finding(finding: Diagnostic) -> str:
    location = "" if finding.span is None else f" ({_format_code(f'{finding.span.file}:{finding.span.line}')})"
    return f"- {finding.severity.value} {finding.code}: {_escape(finding.message)}{location}"


def _format_details(title: str, lines: Iterator[str] | Sequence[str]) -> str:
    return "\n".join([f"<details><summary>{title}</summary>", "", *lines, "", "</details>"])


def _escape(text: str) -> str:
    """Return a translated text without markup, mentions and references to issues."""
    shown = localized(text) if isinstance(text, Phrase) else text
    return _SPECIAL.sub(_to_entity, _MENTION.sub("\\1\u200b", make_printable(" ".join(shown.split()))))


def _to_entity(match: re.Match[str]) -> str:
    return f"&#{ord(match[0])};"


def _format_code(text: str) -> str:
    """Return a name as inline code. Backticks in the name cannot end it."""
    return f"<code>{_escape(text)}</code>"
