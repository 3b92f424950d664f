"""Write the report of a review as Markdown for a comment on a pull request (GitHub, GitLab, Gitea)."""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import replace

from linkwright.diagnostics import Diagnostic, Phrase, counted, joined, phrase
from linkwright.diagnostics.render import make_printable
from linkwright.diagnostics.translation import localized
from linkwright.review.changes import Change, Effect, Figure, Review, Subject
from linkwright.review.reports.finding_groups import group_findings
from linkwright.review.reports.sections import (
    Section,
    divide_report,
    format_summary,
    merge_breaking_changes,
    separate_code,
)
from linkwright.review.reports.sentences import (
    format_alike,
    format_cases_of,
    format_change,
    format_code_heading,
    format_figure_name,
    format_location,
    format_paths,
    format_repeated,
    format_title,
    get_path_state,
    list_other_files,
    split_heading,
)
from linkwright.review.texts.excerpts import differing_excerpts, shorten

MARKER = "<!-- linkwright review -->"
"""The first line, by which a program finds the comment to update."""
_MAX_OPEN_CHANGES = 8
"""The maximum number of changes to a file that are shown without a click."""
_MAX_OPEN_BREAKING = 16
"""The maximum number of breaking changes that are shown without a click."""
_MAX_OPEN_FINDINGS = 8
"""The maximum number of new findings that are shown without a click."""
_MAX_LINE = 300
"""The maximum number of characters of a change or reason. The other reports have the rest."""
_MAX_VALUE = 60
"""The maximum number of characters of a changed value that is shown in full."""
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
    title = _escape(format_title(review))
    return f"### {title}\n\n{_escape(format_summary(review))}"


def _format_parts(review: Review) -> Iterator[str]:
    breaking = merge_breaking_changes(review)
    if breaking:
        title = _escape(phrase("Breaking changes"))
        lines = [_format_breaking_change(paths, change) for paths, change in breaking]
        yield "\n".join([f"#### {title}", "", *_fold(lines, _MAX_OPEN_BREAKING, _count_more_breaking_changes)]).rstrip()
    if review.new_findings:
        lines = list(map(_format_finding, group_findings(review.new_findings)))
        yield "\n".join(
            [f"#### {_escape(phrase('New findings'))}", "", *_fold(lines, _MAX_OPEN_FINDINGS, _count_more_findings)]
        )
    sections, code_sections = separate_code(divide_report(review))
    yield from filter(None, map(_format_section, sections))
    if code_sections:
        title = _escape(format_code_heading(len(code_sections)))
        yield _format_details(title, list(map(_format_code_section, code_sections)))
    if review.fixed_findings:
        title = phrase("{title} ({count})", title=phrase("Fixed findings"), count=len(review.fixed_findings))
        yield _format_details(_escape(title), list(map(_format_finding, group_findings(review.fixed_findings))))
    if review.other_files:
        yield _format_details(
            _escape(phrase("Other changed files ({count})", count=len(review.other_files))),
            [f"- {_format_path(path, state)}" for path, state in list_other_files(review)],
        )
    if review.notes:
        yield "\n".join(f"> {_escape(note)}" for note in review.notes)


def _format_path(path: str, state: Phrase | None) -> str:
    return _format_code(path) + ("" if state is None else f" ({_escape(state)})")


def _format_breaking_change(paths: Sequence[str], change: Change) -> str:
    reason = "" if change.reason is None else f": {_escape(change.reason, _MAX_LINE)}"
    heading, rest = split_heading(shorten(localized(format_change(_shorten_values(change))), _MAX_LINE))
    text = f"**{_escape(heading)}** {_escape(rest)}" if rest else f"**{_escape(heading)}**"
    return f"- {text}{reason} ({_format_code(localized(format_paths(paths)))})"


def _format_section(section: Section) -> str:
    """Return the part about a file.

    The result is empty if all its changes are breaking: these are listed at the beginning.
    """
    subject = section.subject
    lines: list[str] = []
    if subject.figures:
        lines += [*_format_figures(subject.figures), ""]
    others = [change for change in section.changes if change.effect is not Effect.BREAKING]
    changes = _format_changes(_join_actions(others), subject)
    lines += _fold(changes, _MAX_OPEN_CHANGES, _count_more_changes)
    lines += [f"- {_escape(format_repeated(repeat))}" for repeat in section.repeated]
    lines += [f"> {_escape(problem.text)}" for problem in subject.problems]
    if not lines:
        return ""
    alike = format_alike(section.alike)
    lines += [] if alike is None else [f"- {_escape(alike)}"]
    heading = f"#### {_format_path(subject.path, get_path_state(subject))}"
    return "\n".join([heading, "", *lines]).rstrip()


def _format_code_section(section: Section) -> str:
    """Return the functions of a source with other code, in one line."""
    subject = section.subject
    changes = "; ".join(line.removeprefix("- ") for line in _format_changes(section.changes, subject))
    alike = format_alike(section.alike)
    path = _format_path(subject.path, get_path_state(subject))
    return f"- {path}: {changes}{'' if alike is None else f'; {_escape(alike)}'}"


def _fold(lines: Sequence[str], limit: int, format_title: Callable[[int], Phrase]) -> list[str]:
    """Return lines, of which those above the limit are shown with a click if there are several."""
    hidden = lines[limit:]
    if len(hidden) <= 1:
        return list(lines)
    return [*lines[:limit], "", _format_details(_escape(format_title(len(hidden))), hidden), ""]


def _count_more_changes(count: int) -> Phrase:
    return counted("{count} more change", "{count} more changes", count)


def _count_more_breaking_changes(count: int) -> Phrase:
    return counted("{count} more breaking change", "{count} more breaking changes", count)


def _count_more_findings(count: int) -> Phrase:
    return counted("{count} more finding", "{count} more findings", count)


def _format_changes(changes: Sequence[Change], subject: Subject) -> list[str]:
    cases = format_cases_of(changes, subject)
    return [_format_change(change, subject, case) for change, case in zip(changes, cases, strict=True)]


def _format_change(change: Change, subject: Subject, cases: Phrase | None) -> str:
    place = None if change.location is None else format_location(change.location, subject.path)
    location = "" if place is None else f" ({_escape(place) if isinstance(place, Phrase) else _format_code(place)})"
    text = _escape(format_change(_shorten_values(change)), _MAX_LINE)
    return f"- {text}{'' if cases is None else ' ' + _escape(cases)}{location}"


def _join_actions(changes: Sequence[Change]) -> list[Change]:
    """Return the changes, with those to one action of a launch file, such as a node, in one line."""
    groups: dict[Hashable, list[Change]] = {}
    for number, change in enumerate(changes):
        is_action = change.sentence.template == "{entry}: {change}" and not change.other_locations
        key = str(change.sentence.arguments["entry"]) if is_action else number
        groups.setdefault(key, []).append(_shorten_values(change))
    return [_join_action(group) for group in groups.values()]


def _join_action(changes: Sequence[Change]) -> Change:
    sentence = changes[0].sentence
    if len(changes) == 1:
        return changes[0]
    texts = joined([text for change in changes if isinstance(text := change.sentence.arguments["change"], str)], "; ")
    return replace(changes[0], sentence=sentence.with_arguments(change=texts))


def _shorten_values(change: Change) -> Change:
    """Return a change with only the differing parts of both values if they are long, such as types in C++."""
    arguments = change.sentence.arguments
    old, new = arguments.get("old"), arguments.get("new")
    if not isinstance(old, str) or not isinstance(new, str):
        return change
    old, new = differing_excerpts(old, new, _MAX_VALUE)
    return replace(change, sentence=change.sentence.with_arguments(old=old, new=new))


def _format_figures(figures: Sequence[Figure]) -> list[str]:
    head = " | ".join(map(_escape, (phrase("quantity"), phrase("before"), phrase("after"), phrase("unit"))))
    rows = [
        f"| {_escape(format_figure_name(figure))} | {_escape(figure.old)} | {_escape(figure.new)} | {figure.unit} |"
        for figure in figures
    ]
    return [f"| {head} |", "| --- | ---: | ---: | --- |", *rows]


def _format_finding(finding: Diagnostic) -> str:
    location = "" if finding.span is None else f" ({_format_code(f'{finding.span.file}:{finding.span.line}')})"
    return f"- {finding.severity.value} {finding.code}: {_escape(finding.message)}{location}"


def _format_details(title: str, lines: Sequence[str]) -> str:
    return "\n".join([f"<details><summary>{title}</summary>", "", *lines, "", "</details>"])


def _escape(text: str, limit: int | None = None) -> str:
    """Return a translated text without markup, mentions and references to issues, cut at a limit of characters."""
    shown = localized(text) if isinstance(text, Phrase) else text
    shown = shown if limit is None else shorten(shown, limit)
    return _SPECIAL.sub(_to_entity, _MENTION.sub("\\1\u200b", make_printable(" ".join(shown.split()))))


def _to_entity(match: re.Match[str]) -> str:
    return f"&#{ord(match[0])};"


def _format_code(text: str) -> str:
    """Return a name as inline code. Backticks in the name cannot end it."""
    return f"<code>{_escape(text)}</code>"
