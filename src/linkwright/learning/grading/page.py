"""The marks of a class as one self-contained HTML page, in all languages."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape

from linkwright.diagnostics import Phrase, counted, phrase
from linkwright.diagnostics.translation import LANGUAGES
from linkwright.learning.course import Course
from linkwright.learning.grading.formats import list_protections_in_force
from linkwright.learning.grading.marks import Mark, StudentMarks, describe_class_size
from linkwright.learning.local_text import LocalText
from linkwright.learning.sandbox import PROTECTIONS

_LANGUAGE_NAMES = {"en": "English", "zh": "中文"}

_STYLE = """
:root { color-scheme: light dark; --ink: #1d2733; --soft: #5c6a7d; --line: #d8dee6; --back: #f6f8fa; --card: #fff;
  --bad: #b3261e; --good: #1b7a3d; }
@media (prefers-color-scheme: dark) { :root { --ink: #e3e8ee; --soft: #93a1b3; --line: #323c49; --back: #14191f;
  --card: #1c232b; --bad: #ff8a80; --good: #6fd394; } }
body { margin: 0; background: var(--back); color: var(--ink); font: 14px/1.5 system-ui, sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 20px 24px 60px; }
h1 { font-size: 22px; margin: 12px 0; } h2 { font-size: 16px; margin: 30px 0 10px; }
.good { color: var(--good); } .bad { color: var(--bad); } .soft { color: var(--soft); }
.scroll { overflow-x: auto; background: var(--card); border: 1px solid var(--line); border-radius: 8px; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: 4px 10px; text-align: left; border-bottom: 1px solid var(--line); vertical-align: top; }
th { color: var(--soft); font-weight: 600; } .number { text-align: right; white-space: nowrap; }
td { min-width: 4.5em; } td.number { min-width: 0; } td:first-child { min-width: 9em; overflow-wrap: anywhere; }
.languages { float: right; } .languages label { margin-left: 12px; white-space: nowrap; }
@media (max-width: 600px) { main { padding: 12px 12px 40px; } .languages { float: none; } }
details { margin: 8px 0; background: var(--card); border: 1px solid var(--line); border-radius: 8px; }
summary { cursor: pointer; padding: 8px 12px; font-weight: 600; } details p { margin: 4px 12px; }
summary { overflow-wrap: anywhere; } details .scroll { border-width: 1px 0 0; border-radius: 0; }
.message { white-space: pre-wrap; overflow-wrap: anywhere; min-width: 18em; }
"""


def format_grades_page(course: Course, students: Sequence[StudentMarks], preferred: str) -> str:
    """Return the HTML of the page.

    Args:
        course: the graded course.
        students: the marks.
        preferred: the language that the page shows first.
    """
    title = course.title
    titles = {step.address: step.title for step in course.steps}
    parts = [
        f"<main>{_format_language_choice(preferred)}<h1>{_format_local_text(title)}</h1>",
        f"<p class='soft'>{_format_phrase(describe_class_size(students))}</p>",
        _format_overview(students),
        f"<h2>{_format_phrase(phrase('Students'))}</h2>",
        *(_format_student(index, student, titles) for index, student in enumerate(students)),
        _format_steps(students, titles),
        _format_protections(students),
        "</main>",
    ]
    head = (
        '<meta charset="utf-8"><meta name="viewport" content="width=device-width">'
        f"<title>{escape(title.get(preferred))}</title>"
    )
    style = _STYLE + "".join(
        f'body:has(#show-{language}:checked) span[lang]:not([lang="{language}"]) {{ display: none; }}\n'
        for language in LANGUAGES
    )
    return (
        f'<!doctype html>\n<html lang="{preferred}"><head>{head}<style>{style}</style></head>'
        f"<body>{''.join(parts)}</body></html>\n"
    )


def _format_language_choice(preferred: str) -> str:
    choices = [
        f'<label><input type="radio" name="language" id="show-{language}"'
        f"{' checked' if language == preferred else ''}> {_LANGUAGE_NAMES.get(language, language)}</label> "
        for language in LANGUAGES
    ]
    return f'<form class="languages">{"".join(choices)}</form>'


def _format_overview(students: Sequence[StudentMarks]) -> str:
    rows = []
    for index, student in enumerate(students):
        passed = sum(mark.passed for mark in student.marks.values())
        steps = f"{passed} / {len(student.points)}" if student.submission.is_readable else "–"
        name = f'<a href="#student-{index}">{escape(student.submission.student)}</a>'
        rows.append([name, _format_points(student), steps, _format_seconds(student.marks.values())])
    return _format_table(
        [phrase("Student"), phrase("Points"), phrase("Steps passed"), phrase("Time")], rows, numbers=(1, 2, 3)
    )


def _format_steps(students: Sequence[StudentMarks], titles: Mapping[str, LocalText]) -> str:
    """Return a table with the share of students that passed each step."""
    graded = [student for student in students if student.marks]
    rows = []
    for step in graded[0].points if graded else ():
        marks = [student.marks[step] for student in graded if student.marks[step].is_graded]
        rows.append([_format_step_name(step, titles), f"{sum(mark.passed for mark in marks)} / {len(marks)}"])
    heading = f"<h2>{_format_phrase(phrase('Steps'))}</h2>"
    return heading + _format_table([phrase("Step"), phrase("Passed by")], rows, numbers=(1,)) if rows else ""


def _format_step_name(step: str, titles: Mapping[str, LocalText]) -> str:
    return f"{_format_local_text(titles[step])} <span class='soft'>{escape(step)}</span>"


def _format_student(index: int, student: StudentMarks, titles: Mapping[str, LocalText]) -> str:
    """Return the section of a student.

    Its link target is inside ``details``, so that a link opens it.
    """
    notes = "".join(f"<p class='soft'>{_format_local_text(note)}</p>" for note in student.submission.notes)
    rows = [_format_step(student, step, mark, titles) for step, mark in student.marks.items()]
    headings = [
        phrase("Step"),
        phrase("Passed"),
        phrase("Points"),
        phrase("Not yet"),
        phrase("Hints and solution, according to the student's file"),
        phrase("Time"),
    ]
    table = _format_table(headings, rows, numbers=(2, 5)) if rows else ""
    summary = f"<summary>{escape(student.submission.student)}: {_format_points(student)}</summary>"
    return f'<details>{summary}<div id="student-{index}">{notes}{table}</div></details>'


def _format_step(student: StudentMarks, step: str, mark: Mark, titles: Mapping[str, LocalText]) -> list[str]:
    claims = student.submission.progress.step(step)
    help_texts = [_format_phrase(counted("{count} hint", "{count} hints", claims.hints))] if claims.hints else []
    help_texts += [_format_phrase(phrase("solution used"))] if claims.solution else []
    messages = "".join(f"<div class='message'>{_format_local_text(message)}</div>" for message in mark.messages)
    sign = "<span class='good'>✓</span>" if mark.passed else "<span class='bad'>✗</span>"
    points = f"{student.points[step] if mark.passed else 0:g} / {student.points[step]:g}"
    if not mark.is_graded:
        sign, points = "?", f"– / {student.points[step]:g}"
    return [_format_step_name(step, titles), sign, points, messages, ", ".join(help_texts), _format_seconds([mark])]


def _format_protections(students: Sequence[StudentMarks]) -> str:
    in_force = list_protections_in_force(students)
    items = "".join(
        f"<li>{'✓' if protection.value in in_force else '✗'} {_format_phrase(text)}</li>"
        for protection, text in PROTECTIONS.items()
    )
    return f"<h2>{_format_phrase(phrase('Enforced protections'))}</h2><ul>{items}</ul>"


def _format_points(student: StudentMarks) -> str:
    if not student.submission.is_readable:
        return f"<span class='bad'>{_format_phrase(phrase('not graded'))}</span>"
    points = f"{student.total:g} / {student.possible:g}"
    return (
        points if student.is_graded else f"{points} <span class='bad'>({_format_phrase(phrase('not complete'))})</span>"
    )


def _format_seconds(marks: Iterable[Mark]) -> str:
    return f"{sum(mark.seconds for mark in marks):.1f} s"


def _format_table(headings: Sequence[Phrase], rows: Sequence[Sequence[str]], *, numbers: Sequence[int]) -> str:
    """Return a table whose cells are HTML."""
    head = "".join(
        f"<th{' class=number' if column in numbers else ''}>{_format_phrase(heading)}</th>"
        for column, heading in enumerate(headings)
    )
    lines = "".join(
        "<tr>"
        + "".join(f"<td{' class=number' if column in numbers else ''}>{cell}</td>" for column, cell in enumerate(row))
        + "</tr>"
        for row in rows
    )
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{lines}</tbody></table></div>'


def _format_phrase(text: Phrase) -> str:
    return _format_local_text(LocalText.from_phrase(text))


def _format_local_text(text: LocalText) -> str:
    """Return HTML with a text in all languages. The page shows one of them."""
    return "".join(f'<span lang="{language}">{escape(text.get(language))}</span>' for language in LANGUAGES)
