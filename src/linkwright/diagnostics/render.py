"""Formats diagnostics as text for a terminal and as plain data."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence

from linkwright.diagnostics.diagnostic import Diagnostic, Note, Severity, Span
from linkwright.diagnostics.phrase import as_phrase, phrase
from linkwright.diagnostics.translation import labels, language, localized, translated
from linkwright.loading.lean_typing import IO, TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pathlib import Path

_COLOURS = {Severity.ERROR: "31", Severity.WARNING: "33", Severity.INFO: "36"}
MOST_PRINTED = 500
"""The most findings to print: no user reads more, and the errors among them would scroll away."""
_TAB = "    "
_WIDEST = 300
_AROUND = 80
"""Of a longer line so many characters are shown before and after the place."""
_SEEN_AS = {
    **{code: 0x2400 + code for code in range(0x20) if chr(code) not in "\t\n"},
    0x7F: 0x2421,
    **dict.fromkeys((*range(0x80, 0xA0), *range(0x202A, 0x202F), *range(0x2066, 0x206A)), 0xFFFD),
}
"""Characters that control a terminal or the order of the text after them -> the text printed in their place."""


def wants_colour(stream: IO[str]) -> bool:
    """Return whether output to a stream is coloured.

    It is coloured on a terminal, unless NO_COLOR is set or TERM is ``dumb``.
    """
    if os.environ.get("NO_COLOR"):
        return False
    return stream.isatty() and os.environ.get("TERM") != "dumb"


def render(diagnostic: Diagnostic, *, colour: bool = False, lang: str = "en") -> str:
    """Format a diagnostic for a terminal.

    The result has a head line, the place, an excerpt with a caret, notes and the hint. The diagnostic's texts are
    printed unchanged; `lang` is the language of the labels, such as "error" and "hint".
    """
    paint = _Paint(colour)
    words = labels(lang)
    severity, colon = diagnostic.severity, words[": "]
    head = f"{words[severity.value]}[{diagnostic.code}]"
    lines = [f"{paint(head, _COLOURS[severity] + ';1')}{paint(colon + printable(diagnostic.message), '1')}"]
    if diagnostic.span:
        lines.append(f"  {paint('-->', '34')} {_place(diagnostic.span)}")
        lines += _excerpt(diagnostic, paint)
    for note in diagnostic.notes:
        where = f" ({_place(note.span)})" if note.span else ""
        lines.append(f"   {paint('=', '34')} {words['note']}{colon}{_indented(note.message)}{where}")
    if diagnostic.hint:
        lines.append(f"   {paint('=', '34')} {paint(words['hint'], '32')}{colon}{_indented(diagnostic.hint)}")
    return "\n".join(lines)


def print_diagnostics(diagnostics: Iterable[Diagnostic], stream: IO[str]) -> None:
    """Write diagnostics to a stream, in the reader's language.

    They are coloured if the stream supports it. If there are more than `MOST_PRINTED`, the rest is only counted;
    formats for programs contain all of them.
    """
    colour, lang = wants_colour(stream), language()
    found = list(diagnostics)
    shown = _most_severe(found)
    for diagnostic in translated(shown):
        print(render(diagnostic, colour=colour, lang=lang), file=stream)
    if len(shown) < len(found):
        print(localized(phrase("... and {count:,} more findings", count=len(found) - len(shown))), file=stream)
    stream.flush()


def _most_severe(found: Sequence[Diagnostic]) -> Sequence[Diagnostic]:
    """Return at most `MOST_PRINTED` findings in their order, preferring errors."""
    if len(found) <= MOST_PRINTED:
        return found
    numbers = sorted(range(len(found)), key=lambda number: found[number].severity is not Severity.ERROR)
    return [found[number] for number in sorted(numbers[:MOST_PRINTED])]


def to_data(diagnostic: Diagnostic) -> dict[str, Any]:
    """Convert a diagnostic to JSON-ready data.

    Positions are 1-based, and missing ones are None. ``template`` and ``arguments`` are the parts of the message, in
    English: the same finding has the same template for every robot and in every language.
    """
    message = as_phrase(diagnostic.message)
    return {
        "code": diagnostic.code,
        "severity": diagnostic.severity.value,
        "message": diagnostic.message,
        "template": message.chosen_template,
        "arguments": dict(message.arguments),
        **_span_data(diagnostic.span),
        "notes": [_note_data(note) for note in diagnostic.notes],
        "hints": [diagnostic.hint] if diagnostic.hint else [],
    }


def _span_data(span: Span | None) -> dict[str, Any]:
    return {
        "file": span.file if span else None,
        "line": span.line if span else None,
        "column": span.column if span else None,
        "end_line": span.end_line if span else None,
        "end_column": span.end_column if span else None,
    }


def _note_data(note: Note) -> dict[str, Any]:
    span = note.span
    return {
        "message": note.message,
        "file": span.file if span else None,
        "line": span.line if span else None,
        "column": span.column if span else None,
    }


class _Paint:
    def __init__(self, colour: bool) -> None:
        self._colour = colour

    def __call__(self, text: str, code: str) -> str:
        return f"\x1b[{code}m{text}\x1b[0m" if self._colour else text


def _place(span: Span) -> str:
    path = span.file if span.file.startswith("<") else display_path(span.file)
    return f"{printable(path)}:{span.line}:{span.column}"


def _excerpt(diagnostic: Diagnostic, paint: _Paint) -> list[str]:
    span, source = diagnostic.span, diagnostic.source
    if span is None or source is None or source.name != span.file:
        return []
    line = source.line(span.line)
    if not line.strip():
        return []
    before = line[: span.column - 1]
    if span.end_line == span.line:
        marked = line[span.column - 1 : max(span.end_column - 1, span.column)]
    else:
        marked = line[span.column - 1 :]
    if len(line) > _WIDEST:  # for example, an entire robot in one line
        cut = max(0, len(before) - _AROUND)
        end = len(before) + _AROUND
        line = f"{'...' if cut else ''}{line[cut:end]}{'...' if end < len(line) else ''}"
        before = f"{'...' if cut else ''}{before[cut:]}"
        marked = marked[:_AROUND]
    number = str(span.line)
    gutter = " " * len(number)
    bar = paint("|", "34")
    carets = paint("^" * max(1, shown_width(marked)), _COLOURS[diagnostic.severity])
    shown = printable(line).replace("\t", _TAB)
    return [
        f"{gutter} {bar}",
        f"{paint(number, '34')} {bar} {shown}",
        f"{gutter} {bar} {' ' * shown_width(before)}{carets}",
    ]


def printable(text: str) -> str:
    """Return the text with control characters replaced by visible ones.

    A terminal can print the result.
    """
    return text.translate(_SEEN_AS)


def shown_width(text: str) -> int:
    """Return the number of terminal columns that a text takes."""
    return sum(map(_columns, text))


def _columns(character: str) -> int:
    if character == "\t":
        return len(_TAB)
    if character.isascii():
        return 1
    from unicodedata import combining, east_asian_width

    if combining(character):
        return 0
    return 2 if east_asian_width(character) in "WF" else 1


def _indented(text: str) -> str:
    return printable(text).replace("\n", "\n     ")


def display_path(path: str | Path) -> str:
    """Return a path in the form for messages: relative to the current folder if it is below it."""
    text = str(path)
    relative = os.path.relpath(text)
    return text if relative.startswith("..") else relative
