"""Write the report of a review as Markdown for a comment on a pull request (GitHub, GitLab, Gitea)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Diagnostic, Phrase, counted, phrase
from linkwright.diagnostics.render import make_printable
from linkwright.diagnostics.translation import localized
from linkwright.review.changes import Change, Effect, Figure, Location, Review, Subject
from linkwright.review.reports.sections import (
    Section,
    alike_text,
    breaking_changes,
    cases_text,
    group_findings,
    other_files,
    paths_text,
    repeated_text,
    sections_of,
    sentence_of,
    summary_text,
)

MARKER = "<!-- linkwright review -->"
"""The first line, by which a program finds the comment to update."""
_MAX_OPEN_CHANGES = 8
"""The maximum number of changes of a file that are shown without a click."""
_MAX_CHARACTERS = 60_000
"""The maximum length of the report. GitHub refuses comments of more than 65 536 characters."""
_SPECIAL = re.compile(r"[&\\`*_{}\[\]<>|~]")
_MENTION = re.compile(r"([@#])(?=\w)")


def as_markdown(review: Review) -> str:
    """Return the report as Markdown in the user's language.

    Names from the repository cannot form links, mentions or HTML. A report too long for a comment is cut, with a
    line about the missing parts at its end.
    """
    parts = [f"{MARKER}\n{_heading_text(review)}", *_report_parts(review)]
    text = ""
    for index, part in enumerate(parts):
        if len(text) + len(part) > _MAX_CHARACTERS:
            return text + "\n" + _escape(_left_out(len(parts) - index)) + "\n"
        text += ("\n" if text else "") + part + "\n"
    return text


def _left_out(count: int) -> Phrase:
    return counted(
        "{count} more part does not fit into a comment; the HTML report has it",
        "{count} more parts do not fit into a comment; the HTML report has them",
        count,
    )


def _heading_text(review: Review) -> str:
    new = review.new_name or localized(phrase("working tree"))
    title = _escape(phrase("Robot review: {old} to {new}", old=review.old_name, new=new))
    return f"### {title}\n\n{_escape(summary_text(review))}"


def _report_parts(review: Review) -> Iterator[str]:
    breaking = breaking_changes(review)
    if breaking:
        title = _escape(phrase("Breaking changes"))
        yield "\n".join([f"#### {title}", "", *(_breaking_line(paths, change) for paths, change in breaking)])
    yield from filter(None, map(_section_text, sections_of(review)))
    for title, findings in (
        (phrase("New findings"), review.new_findings),
        (phrase("Fixed findings"), review.fixed_findings),
    ):
        if findings:
            heading = _escape(phrase("{title} ({count})", title=title, count=len(findings)))
            yield _details_block(heading, map(_finding_text, group_findings(findings)))
    if review.other_files:
        title = phrase("Other changed files ({count})", count=len(review.other_files))
        yield _details_block(
            _escape(title),
            (
                f"- {_inline_code(path)}{'' if state is None else f' ({_escape(state)})'}"
                for path, state in other_files(review)
            ),
        )
    if review.notes:
        yield "\n".join(f"> {_escape(note)}" for note in review.notes)


def _other_file(path: str, state: Phrase | None) -> str:
    return f"- {_inline_code(path)}" + ("" if state is None else f" ({_escape(state)})")


def _breaking_line(paths: Sequence[str], change: Change) -> str:
    reason = "" if change.reason is None else f": {_escape(change.reason)}"
    return f"- **{_escape(sentence_of(change))}**{reason} ({_inline_code(localized(paths_text(paths)))})"


def _section_text(section: Section) -> str:
    """Return the part about a file; empty if all its changes are breaking and thus listed at the beginning."""
    subject = section.subject
    lines: list[str] = []
    if subject.figures:
        lines += [*_figure_lines(subject.figures), ""]
    changes = [_change_text(change, subject) for change in section.changes if change.effect is not Effect.BREAKING]
    lines += changes[:_MAX_OPEN_CHANGES]
    rest = changes[_MAX_OPEN_CHANGES:]
    if rest:
        title = counted("{count} more change", "{count} more changes", len(rest))
        lines += ["", _details_block(_escape(title), rest)]
    lines += [f"- {_escape(repeated_text(path, count))}" for path, count in section.repeated]
    alike = alike_text(section)
    lines += [] if alike is None else [f"- {_escape(alike)}"]
    lines += [f"> {_escape(problem.text)}" for problem in subject.problems]
    return "\n".join([f"#### {_inline_code(subject.path)}", "", *lines]).rstrip() if lines else ""


def _change_text(change: Change, subject: Subject) -> str:
    cases = cases_text(change, subject)
    location = "" if change.location is None else f" ({_inline_code(_location_text(change.location))})"
    return f"- {_escape(sentence_of(change))}{'' if cases is None else ' ' + _escape(cases)}{location}"


def _location_text(location: Location) -> str:
    return f"{location.file}:{location.line}"


def _figure_lines(figures: Sequence[Figure]) -> list[str]:
    head = " | ".join(map(_escape, (phrase("quantity"), phrase("before"), phrase("after"), phrase("unit"))))
    rows = [
        f"| {_escape(figure.name)} | {_escape(figure.old)} | {_escape(figure.new)} | {figure.unit} |"
        for figure in figures
    ]
    return [f"| {head} |", "| --- | ---: | ---: | --- |", *rows]


def _finding_text(finding: Diagnostic) -> str:
    location = "" if finding.span is None else f" ({_inline_code(f'{finding.span.file}:{finding.span.line}')})"
    return f"- {finding.severity.value} {finding.code}: {_escape(finding.message)}{location}"


def _details_block(title: str, lines: Iterator[str] | Sequence[str]) -> str:
    return "\n".join([f"<details><summary>{title}</summary>", "", *lines, "", "</details>"])


def _escape(text: str) -> str:
    """Return a translated text without markup, mentions and references to issues."""
    shown = localized(text) if isinstance(text, Phrase) else text
    return _SPECIAL.sub(_to_entity, _MENTION.sub("\\1\u200b", make_printable(" ".join(shown.split()))))


def _to_entity(match: re.Match[str]) -> str:
    return f"&#{ord(match[0])};"


def _inline_code(text: str) -> str:
    """Return a name as inline code. Backticks in the name cannot end it."""
    return f"<code>{_escape(text)}</code>"
