"""The text of a lesson, Markdown that is divided into steps and sections."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.diagnostics import missing_extra, phrase
from linkwright.learning.errors import file_error, unreadable_file_error

if TYPE_CHECKING:
    from markdown_it.token import Token

_HEADING_ATTRIBUTES = re.compile(r"\s*\{([^{}]*)\}\s*$")
_STEP_LEVEL, _SECTION_LEVEL = "h2", "h3"
HINT = "hint"


@dataclass(frozen=True)
class StepText:
    """The text of a step in one language.

    Attributes:
        id: the step's name in checks and progress, from ``{#id}`` after the title.
        title: the heading without its attributes.
        body: the Markdown of the step without title and hints.
        hints: the Markdown of each section marked with ``{.hint}``, including its title, in the order of the text.
        unit: the unit of the learner's answer, from ``{#id answer=m}``; None if the step has no question.
            The unit of a dimensionless number is ``1``.
        shown_file: the robot's file that the page shows from this step on, relative to the workspace, from
            ``{#id show=src/PACKAGE/urdf/ROBOT.xacro}``; None for no change.
        line: the line of the title, from 1.
    """

    id: str
    title: str
    body: str
    hints: tuple[str, ...]
    unit: str | None
    shown_file: str | None
    line: int


@dataclass(frozen=True)
class LessonText:
    """The text of a lesson in one language.

    Attributes:
        path: the Markdown file.
        title: the heading of the first level.
        introduction: the Markdown before the first step.
        steps: the steps in the order of the text.
    """

    path: Path
    title: str
    introduction: str
    steps: tuple[StepText, ...]


@dataclass(frozen=True)
class _Heading:
    level: str
    title: str
    attributes: Sequence[str]
    first_line: int
    end_line: int


def read_lesson_text(path: Path) -> LessonText:
    """Read the text of a lesson.

    Raises:
        LinkwrightError: LEARN102, the file cannot be read; LEARN103, a heading is missing or lacks its name; LEARN116,
            the extra `learn` is not installed.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise unreadable_file_error(path, error) from None
    lines = text.splitlines()
    headings = list(_find_headings(text))
    if not headings or headings[0].level != "h1":
        raise file_error(
            "LEARN103", path, phrase("the lesson has no title"), hint=phrase("begin the text with '# Title'")
        )
    step_indices = [index for index, heading in enumerate(headings) if heading.level == _STEP_LEVEL]
    if not step_indices:
        raise file_error(
            "LEARN103",
            path,
            phrase("the lesson has no steps"),
            hint=phrase("begin each step with '## Title {{#name}}'"),
        )
    bounds = [*step_indices, len(headings)]
    steps = [
        _read_step(path, lines, headings[first:end], _find_line(headings, end, lines))
        for first, end in pairwise(bounds)
    ]
    introduction = _join_lines(lines, headings[0].end_line, headings[step_indices[0]].first_line)
    return LessonText(path, headings[0].title, introduction, tuple(steps))


def _find_headings(text: str) -> Iterator[_Heading]:
    try:
        from markdown_it import MarkdownIt
    except ModuleNotFoundError as error:
        raise missing_extra("LEARN116", error) from None
    tokens = MarkdownIt("commonmark").parse(text)
    for opening, content in pairwise(tokens):
        if opening.type == "heading_open" and opening.level == 0:
            yield _make_heading(opening, content.content)


def _make_heading(opening: Token, content: str) -> _Heading:
    match = _HEADING_ATTRIBUTES.search(content)
    attributes = match[1].split() if match else []
    first_line, end_line = opening.map or (0, 0)
    return _Heading(opening.tag, content[: match.start()] if match else content, attributes, first_line, end_line)


def _find_line(headings: Sequence[_Heading], index: int, lines: Sequence[str]) -> int:
    return headings[index].first_line if index < len(headings) else len(lines)


def _read_step(path: Path, lines: Sequence[str], headings: Sequence[_Heading], end_line: int) -> StepText:
    """Return the step that begins at the first of some headings."""
    opening = headings[0]
    line = opening.first_line + 1
    names = [attribute[1:] for attribute in opening.attributes if attribute.startswith("#")]
    if len(names) != 1 or not re.fullmatch(r"[a-z0-9]+(?:-[a-z0-9]+)*", names[0]):
        message = phrase("the step '{title}' has no name", title=opening.title)
        hint = phrase("write '## {title} {{#name}}', with a name such as first-link", title=opening.title)
        raise file_error("LEARN103", path, message, line=line, hint=hint)
    values = dict(attribute.split("=", 1) for attribute in opening.attributes if "=" in attribute)
    body: list[str] = []
    hints: list[str] = []
    sections = [heading for heading in headings[1:] if heading.level == _SECTION_LEVEL]
    starts = [heading.first_line for heading in sections] + [end_line]
    body.append(_join_lines(lines, opening.end_line, starts[0]))
    for section, end in zip(sections, starts[1:], strict=True):
        content = f"### {section.title}\n\n{_join_lines(lines, section.end_line, end)}"
        (hints if f".{HINT}" in section.attributes else body).append(content)
    text = "\n\n".join(filter(None, body))
    return StepText(names[0], opening.title, text, tuple(hints), values.get("answer"), values.get("show"), line)


def _join_lines(lines: Sequence[str], first: int, end: int) -> str:
    return "\n".join(lines[first:end]).strip()
