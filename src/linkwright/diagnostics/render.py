"""Diagnostics as text for a terminal, and as plain data."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from contextvars import ContextVar

from linkwright.diagnostics.diagnostic import Diagnostic, Note, Severity, Span
from linkwright.diagnostics.phrase import as_phrase, phrase
from linkwright.diagnostics.translation import labels, language, localized, translated
from linkwright.loading.lean_typing import IO, TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pathlib import Path

_COLORS = {Severity.ERROR: "31", Severity.WARNING: "33", Severity.INFO: "36"}
MAX_PRINTED = 500
"""The maximum number of findings to print. No user reads more, and the errors among them would scroll away."""
_TAB = "    "
_MAX_LINE_LENGTH = 300
_CONTEXT_LENGTH = 80
"""The number of characters of a longer line that are shown before and after the position."""
_REPLACEMENTS = {
    **{code: 0x2400 + code for code in range(0x20) if chr(code) not in "\t\n"},
    0x7F: 0x2421,
    **dict.fromkeys((*range(0x80, 0xA0), *range(0x202A, 0x202F), *range(0x2066, 0x206A)), 0xFFFD),
}
"""The replacements of characters that control a terminal or the order of the text after them."""

shows_absolute_paths: ContextVar[bool] = ContextVar("shows_absolute_paths", default=False)
"""Whether `display_path` returns absolute paths, so that a text does not depend on the current folder."""


def wants_color(stream: IO[str]) -> bool:
    """Return whether output to a stream should be colored.

    Output to a terminal is colored, unless NO_COLOR is set or TERM is ``dumb``.
    """
    if os.environ.get("NO_COLOR"):
        return False
    return stream.isatty() and os.environ.get("TERM") != "dumb"


def render(diagnostic: Diagnostic, *, color: bool = False, lang: str = "en") -> str:
    """Format a diagnostic for a terminal.

    The result has a headline, the position, an excerpt with carets, notes and the hint. The texts of the diagnostic are
    not translated; `lang` is the language of the labels, such as "error" and "hint".
    """
    paint = _Painter(color)
    words = labels(lang)
    severity, colon = diagnostic.severity, words[": "]
    head = f"{words[severity.value]}[{diagnostic.code}]"
    lines = [f"{paint(head, _COLORS[severity] + ';1')}{paint(colon + make_printable(diagnostic.message), '1')}"]
    if diagnostic.span:
        lines.append(f"  {paint('-->', '34')} {_format_location(diagnostic.span)}")
        lines += _format_excerpt(diagnostic, paint)
    for note in diagnostic.notes:
        position = f" ({_format_location(note.span)})" if note.span else ""
        lines.append(f"   {paint('=', '34')} {words['note']}{colon}{_indent(note.message)}{position}")
    if diagnostic.hint:
        lines.append(f"   {paint('=', '34')} {paint(words['hint'], '32')}{colon}{_indent(diagnostic.hint)}")
    return "\n".join(lines)


def print_diagnostics(diagnostics: Iterable[Diagnostic], stream: IO[str]) -> None:
    """Write diagnostics to a stream, in the user's language.

    The diagnostics are colored if the stream supports colors. Diagnostics beyond `MAX_PRINTED` are only counted.
    Formats for programs contain all diagnostics.
    """
    color, lang = wants_color(stream), language()
    all_diagnostics = list(diagnostics)
    printed = _select_most_severe(all_diagnostics)
    for diagnostic in translated(printed):
        print(render(diagnostic, color=color, lang=lang), file=stream)
    if len(printed) < len(all_diagnostics):
        print(
            localized(phrase("... and {count:,} more findings", count=len(all_diagnostics) - len(printed))), file=stream
        )
    stream.flush()


def _select_most_severe(diagnostics: Sequence[Diagnostic]) -> Sequence[Diagnostic]:
    """Return the findings to print, in their original order.

    If there are too many, errors take precedence.
    """
    if len(diagnostics) <= MAX_PRINTED:
        return diagnostics
    indices = sorted(range(len(diagnostics)), key=lambda index: diagnostics[index].severity is not Severity.ERROR)
    return [diagnostics[number] for number in sorted(indices[:MAX_PRINTED])]


def to_data(diagnostic: Diagnostic) -> dict[str, Any]:
    """Return a diagnostic as data that can be written as JSON.

    Lines and columns count from 1, and a missing position is None. ``template`` and ``arguments`` are the English parts
    of the message. The same finding has the same template for every robot and in every language.
    """
    message = as_phrase(diagnostic.message)
    return {
        "code": diagnostic.code,
        "severity": diagnostic.severity.value,
        "message": diagnostic.message,
        "template": message.chosen_template,
        "arguments": dict(message.arguments),
        **_to_span_data(diagnostic.span),
        "notes": [_to_note_data(note) for note in diagnostic.notes],
        "hints": [diagnostic.hint] if diagnostic.hint else [],
    }


def _to_span_data(span: Span | None) -> dict[str, Any]:
    return {
        "file": span.file if span else None,
        "line": span.line if span else None,
        "column": span.column if span else None,
        "end_line": span.end_line if span else None,
        "end_column": span.end_column if span else None,
    }


def _to_note_data(note: Note) -> dict[str, Any]:
    span = note.span
    return {
        "message": note.message,
        "file": span.file if span else None,
        "line": span.line if span else None,
        "column": span.column if span else None,
    }


class _Painter:
    def __init__(self, color: bool) -> None:
        self._color = color

    def __call__(self, text: str, code: str) -> str:
        return f"\x1b[{code}m{text}\x1b[0m" if self._color else text


def _format_location(span: Span) -> str:
    path = span.file if span.file.startswith("<") else display_path(span.file)
    return f"{make_printable(path)}:{span.line}:{span.column}"


def _format_excerpt(diagnostic: Diagnostic, paint: _Painter) -> list[str]:
    span, source = diagnostic.span, diagnostic.source
    if span is None or source is None or source.name != span.file:
        return []
    line = source.line(span.line)
    if not line.strip():
        return []
    prefix = line[: span.column - 1]
    if span.end_line == span.line:
        marked = line[span.column - 1 : max(span.end_column - 1, span.column)]
    else:
        marked = line[span.column - 1 :]
    if len(line) > _MAX_LINE_LENGTH:  # for example, an entire robot in one line
        start = max(0, len(prefix) - _CONTEXT_LENGTH)
        end = len(prefix) + _CONTEXT_LENGTH
        line = f"{'...' if start else ''}{line[start:end]}{'...' if end < len(line) else ''}"
        prefix = f"{'...' if start else ''}{prefix[start:]}"
        marked = marked[:_CONTEXT_LENGTH]
    number = str(span.line)
    gutter = " " * len(number)
    bar = paint("|", "34")
    carets = paint("^" * max(1, compute_width(marked)), _COLORS[diagnostic.severity])
    visible_line = make_printable(line).replace("\t", _TAB)
    return [
        f"{gutter} {bar}",
        f"{paint(number, '34')} {bar} {visible_line}",
        f"{gutter} {bar} {' ' * compute_width(prefix)}{carets}",
    ]


def make_printable(text: str) -> str:
    """Return the text with control characters replaced by visible characters.

    The result is safe to print on a terminal.
    """
    return text.translate(_REPLACEMENTS)


def compute_width(text: str) -> int:
    """Return the number of terminal columns that a printed text occupies."""
    return sum(map(_count_columns, text))


def _count_columns(character: str) -> int:
    if character == "\t":
        return len(_TAB)
    if character.isascii():
        return 1
    from unicodedata import combining, east_asian_width

    if combining(character):
        return 0
    return 2 if east_asian_width(character) in "WF" else 1


def _indent(text: str) -> str:
    return make_printable(text).replace("\n", "\n     ")


def display_path(path: str | Path) -> str:
    """Return a path as shown in messages, relative to the current folder if it is inside."""
    text = str(path)
    if shows_absolute_paths.get():
        return os.path.abspath(text)  # noqa: PTH100 - Path.resolve would follow links
    relative = os.path.relpath(text)
    return text if relative.startswith("..") else relative
