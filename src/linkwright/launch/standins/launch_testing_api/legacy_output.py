"""Tests of the output of a process, as bytes (``launch_testing.legacy.output``)."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

_OutputTest = tuple[bytes, Callable[[bytes, bytes], bytes], Callable[..., bool], Sequence[Any]]


def get_default_filtered_prefixes() -> list[bytes]:
    """Return the prefixes of the lines that are ignored by default."""
    return [b"pid", b"rc"]


def get_default_filtered_patterns() -> list[bytes]:
    """Return an empty list, because no patterns of lines are ignored by default."""
    return []


def create_output_lines_filter(
    filtered_prefixes: Sequence[bytes] | None = None,
    filtered_patterns: Sequence[bytes] | None = None,
    filtered_rmw_implementation: str | None = None,  # noqa: ARG001  # Linkwright's writes no lines
) -> Callable[[bytes], bytes]:
    """Return a function that removes lines with certain prefixes or patterns from an output."""
    prefixes = tuple(filtered_prefixes or get_default_filtered_prefixes())
    patterns = [
        re.compile(filtered_pattern) for filtered_pattern in filtered_patterns or get_default_filtered_patterns()
    ]

    def filter_lines(output: bytes) -> bytes:
        lines = output.splitlines(keepends=True)
        return b"".join(
            line
            for line in lines
            if not line.startswith(prefixes) and not any(pattern.match(line) for pattern in patterns)
        )

    return filter_lines


def create_output_lines_test(expected_lines: Sequence[bytes]) -> _OutputTest:
    """Return a test that passes when each expected text occurs within a line of the output."""
    return b"", _join, lambda output, text: any(text in line for line in output.splitlines()), expected_lines


def create_output_regex_test(expected_patterns: Sequence[re.Pattern[bytes]]) -> _OutputTest:
    """Return a test that passes when each expected pattern matches in the output."""
    return b"", _join, lambda output, pattern: pattern.search(output) is not None, expected_patterns


def create_output_test_from_file(output_file: str) -> _OutputTest:
    """Return a test defined by a ``.txt`` file with texts or a ``.regex`` file with patterns.

    Args:
        output_file: the path of the file without the suffix.

    Raises:
        RuntimeError: neither file exists.
    """
    for suffix, create in ((".txt", create_output_lines_test), (".regex", _create_pattern_test)):
        path = Path(output_file + suffix)
        if path.is_file():
            return create(path.read_bytes().splitlines())
    raise RuntimeError(f"could not find output check file: {output_file}")


def _create_pattern_test(texts: Sequence[bytes]) -> _OutputTest:
    return create_output_regex_test([re.compile(text) for text in texts])


def _join(output: bytes, chunk: bytes) -> bytes:
    return output + chunk
