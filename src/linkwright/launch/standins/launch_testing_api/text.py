"""Comparison of output with expected text (``launch_testing.tools.text`` and ``output``)."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, TypeVar

from linkwright.standins.terminal_color import remove_ansi_escape_sequences

T = TypeVar("T")
Range = tuple[int, int]
"""The start and end of a match."""

Match = Callable[..., "Range | None"]
"""A function of a text, or of lines, and a start: the position of the match, or None."""


def normalize_lineseps(lines: str) -> str:
    r"""Return a text with ``\n`` line ends instead of those of a terminal."""
    return lines.replace(os.linesep, "\n").replace("\r\n", "\n")


def build_text_match(expected_text: Any, *, strict: bool = False) -> Match:
    """Return a function that finds an expectation in a text.

    Args:
        expected_text: a text, a regular expression, or several of them in order.
        strict: whether the text must match completely; for several expectations, whether they must be adjacent.

    Raises:
        ValueError: the expectation has another type.
    """

    def find(text: str, start: int = 0) -> Range | None:
        text = normalize_lineseps(text)
        if isinstance(expected_text, str):
            if strict:
                return (start, start + len(expected_text)) if text[start:] == expected_text else None
            at = text.find(expected_text, start)
            return None if at < 0 else (at, at + len(expected_text))
        found = (expected_text.match if strict else expected_text.search)(text, start)
        return None if found is None else found.span()

    if isinstance(expected_text, str) or (hasattr(expected_text, "search") and hasattr(expected_text, "match")):
        return find
    if isinstance(expected_text, Iterable):
        return _in_order([build_text_match(part) for part in expected_text], strict=strict)
    raise ValueError("Unknown format for expected text")


def build_line_match(expected_lines: Any, *, strict: bool = False) -> Match:
    """Return a function that finds an expectation in lines.

    Args:
        expected_lines: a part of a line, a regular expression for the beginning of a line, or several of them in order.
        strict: whether every line must match; for several expectations, whether they must be adjacent.

    Raises:
        ValueError: the expectation has another type.
    """

    def fits(line: str) -> bool:
        if isinstance(expected_lines, str):
            return expected_lines == line if strict else expected_lines in line
        return bool(expected_lines.match(line))

    def find(lines: Sequence[str], start: int = 0) -> Range | None:
        rest = range(start, len(lines))
        if strict:
            return (start, len(lines)) if all(fits(lines[at]) for at in rest) else None
        return next(((at, at + 1) for at in rest if fits(lines[at])), None)

    if isinstance(expected_lines, str) or hasattr(expected_lines, "match"):
        return find
    if isinstance(expected_lines, Iterable):
        return _in_order([build_line_match(expected_line) for expected_line in expected_lines], strict=strict)
    raise ValueError("Unknown format for expected lines")


def _in_order(matches: Sequence[Match], *, strict: bool) -> Match:
    """Return a function that finds several expectations in order.

    If `strict` is set, the matches must be adjacent; otherwise, other text may be between them.
    """

    def find(written: Any, start: int = 0) -> Range | None:
        begin, end = None, start
        for match in matches:
            found = match(written, end)
            if found is None or (strict and found[0] != end):
                return None
            begin, end = found[0] if begin is None else begin, found[1]
        return (start if begin is None else begin), end

    return find


def expect_output(
    text: str | None = None,
    *,
    lines: Sequence[str] | None = None,
    expected_text: Any = None,
    expected_lines: Any = None,
    strip_ansi_escape_sequences: bool = True,
    strict: bool = False,
) -> bool:
    """Return whether an output contains an expectation.

    Args:
        text: the output as text; alternatively, `lines`.
        lines: the output as lines.
        expected_text: see `build_text_match`; alternatively, `expected_lines`.
        expected_lines: see `build_line_match`.
        strip_ansi_escape_sequences: whether to remove ANSI escape sequences before the comparison.
        strict: see `build_text_match`.

    Raises:
        ValueError: both arguments of a pair of alternatives are given, or neither.
    """
    if (text is None) == (lines is None):
        raise ValueError("Either lines or text, but not both, must be specified")
    if (expected_text is None) == (expected_lines is None):
        raise ValueError("Either expected lines or text, but not both, must be specified")
    written = text if text is not None else "\n".join(lines or ())
    if strip_ansi_escape_sequences:
        written = remove_ansi_escape_sequences(written)
    if expected_text is not None:
        return build_text_match(expected_text, strict=strict)(written) is not None
    return build_line_match(expected_lines, strict=strict)(written.splitlines()) is not None


def expected_output_from_file(path: str, encoding: str | None = None) -> list[Any]:
    """Return the lines of ``PATH.txt``, or the regular expressions in ``PATH.regex``.

    Raises:
        RuntimeError: neither file exists.
    """
    for ending, made in ((".txt", str), (".regex", re.compile)):
        file = Path(path + ending)
        if file.is_file():
            return [made(line) for line in file.read_text(encoding=encoding).splitlines()]
    raise RuntimeError(f"could not find output check file: {path}")


def get_default_filtered_prefixes() -> list[str]:
    """Return the prefixes of lines that a filter removes by default."""
    return ["pid", "rc"]


def get_default_filtered_patterns() -> list[str]:
    """Return an empty list, because a filter removes no patterns of lines by default."""
    return []


def basic_output_filter(
    filtered_prefixes: Iterable[str] | None = None, filtered_patterns: Iterable[str] | None = None
) -> Callable[[str], str]:
    """Return a function that removes lines from an output.

    Args:
        filtered_prefixes: the prefixes of lines to remove; by default the result of `get_default_filtered_prefixes`.
        filtered_patterns: regular expressions for the beginnings of lines to remove.
    """
    prefixes = tuple(get_default_filtered_prefixes() if filtered_prefixes is None else filtered_prefixes)
    patterns = [re.compile(filtered_pattern) for filtered_pattern in filtered_patterns or ()]

    def without_them(output: str) -> str:
        lines = output.splitlines(keepends=True)
        kept = (line for line in lines if not line.startswith(prefixes) and not any(p.match(line) for p in patterns))
        return "".join(kept)

    return without_them
