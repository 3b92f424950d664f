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
"""The start and end index of a match: in a text, or in a list of lines."""

Match = Callable[..., "Range | None"]
"""Returns the range of a match in a text or lines, or None. A start index is optional."""


def normalize_lineseps(lines: str) -> str:
    r"""Return a text with each line end of the system or a terminal replaced with ``\n``."""
    return lines.replace(os.linesep, "\n").replace("\r\n", "\n")


def build_text_match(expected_text: Any, *, strict: bool = False) -> Match:
    """Return a function that finds an expected text in a text.

    Args:
        expected_text: a text, a regular expression, or several of them in order.
        strict: whether the whole text must match. For several expectations: whether the matches must be adjacent.

    Raises:
        ValueError: `expected_text` has another type.
    """

    def find(text: str, start: int = 0) -> Range | None:
        text = normalize_lineseps(text)
        if isinstance(expected_text, str):
            if strict:
                return (start, start + len(expected_text)) if text[start:] == expected_text else None
            position = text.find(expected_text, start)
            return None if position < 0 else (position, position + len(expected_text))
        match = (expected_text.match if strict else expected_text.search)(text, start)
        return None if match is None else match.span()

    if isinstance(expected_text, str) or (hasattr(expected_text, "search") and hasattr(expected_text, "match")):
        return find
    if isinstance(expected_text, Iterable):
        return _build_sequence_match([build_text_match(expectation) for expectation in expected_text], strict=strict)
    raise ValueError("Unknown format for expected text")


def build_line_match(expected_lines: Any, *, strict: bool = False) -> Match:
    """Return a function that finds expected lines in a list of lines.

    Args:
        expected_lines: a part of a line, a regular expression for the beginning of a line, or several of them in order.
        strict: whether every line must match. For several expectations: whether the matches must be adjacent.

    Raises:
        ValueError: `expected_lines` has another type.
    """

    def matches(line: str) -> bool:
        if isinstance(expected_lines, str):
            return expected_lines == line if strict else expected_lines in line
        return bool(expected_lines.match(line))

    def find(lines: Sequence[str], start: int = 0) -> Range | None:
        indices = range(start, len(lines))
        if strict:
            return (start, len(lines)) if all(matches(lines[index]) for index in indices) else None
        return next(((index, index + 1) for index in indices if matches(lines[index])), None)

    if isinstance(expected_lines, str) or hasattr(expected_lines, "match"):
        return find
    if isinstance(expected_lines, Iterable):
        return _build_sequence_match(
            [build_line_match(expected_line) for expected_line in expected_lines], strict=strict
        )
    raise ValueError("Unknown format for expected lines")


def _build_sequence_match(match_functions: Sequence[Match], *, strict: bool) -> Match:
    """Return a function that finds several expectations in order.

    If `strict` is set, the matches must be adjacent. If not, other text may be between them.
    """

    def find(output: Any, start: int = 0) -> Range | None:
        match_start, end = None, start
        for match_function in match_functions:
            match_range = match_function(output, end)
            if match_range is None or (strict and match_range[0] != end):
                return None
            match_start, end = match_range[0] if match_start is None else match_start, match_range[1]
        return (start if match_start is None else match_start), end

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
    """Return whether an output contains an expected text or expected lines.

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
    output = text if text is not None else "\n".join(lines or ())
    if strip_ansi_escape_sequences:
        output = remove_ansi_escape_sequences(output)
    if expected_text is not None:
        return build_text_match(expected_text, strict=strict)(output) is not None
    return build_line_match(expected_lines, strict=strict)(output.splitlines()) is not None


def expected_output_from_file(path: str, encoding: str | None = None) -> list[Any]:
    """Return the lines of ``PATH.txt``, or the regular expressions in ``PATH.regex``.

    Raises:
        RuntimeError: neither file exists.
    """
    for suffix, parse_line in ((".txt", str), (".regex", re.compile)):
        file = Path(path + suffix)
        if file.is_file():
            return [parse_line(line) for line in file.read_text(encoding=encoding).splitlines()]
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

    def filter_lines(output: str) -> str:
        lines = output.splitlines(keepends=True)
        remaining_lines = (
            line for line in lines if not line.startswith(prefixes) and not any(p.match(line) for p in patterns)
        )
        return "".join(remaining_lines)

    return filter_lines
