"""Read the names in a source of a node: Python, C++ or a dynamic_reconfigure description."""

from __future__ import annotations

import re
from pathlib import Path

from linkwright.diagnostics import SourceText
from linkwright.packages.readers.python_values import PythonFile
from linkwright.review.caching import cached_in_review
from linkwright.review.sources.cpp.preprocessor import blank_disabled
from linkwright.review.sources.cpp_names import read_cpp
from linkwright.review.sources.names import CPP_SUFFIXES, DYNAMIC_SUFFIX, PYTHON_SUFFIX, SourceNames
from linkwright.review.sources.python_names import parse_source, read_dynamic_parameters, read_python

_MAX_BYTES = 1 << 20
_MAX_SOURCES = 4096
"""The maximum number of sources whose names are kept."""
_PYTHON_NAME = b"python"
_FORMATTED_TEXT = "f-string"
"""The beginning of the messages about errors in formatted texts."""

_HEADER_CHARACTERS = 500
"""The number of characters at the beginning of a source in which generators leave their mark."""
_GENERATED = re.compile(
    r"^[ \t]*(?:#|//|/?\*).*\b(?:auto-?generated|(?:generated|created)\s+(?:by|from)|do not edit)\b",
    re.IGNORECASE | re.MULTILINE,
)


def is_generated(text: str) -> bool:
    """Return whether the comments at the beginning of a source say that a program generates it."""
    return _GENERATED.search(text[:_HEADER_CHARACTERS]) is not None


@cached_in_review(maxsize=64)
def try_read_source(path: Path) -> SourceText | None:
    """Return the text of a source, or None if it cannot be read or is too large.

    Disabled code in C++, such as under ``#if 0``, is blank.
    """
    text = try_read_text(path)
    if text is None:
        return None
    return SourceText(str(path), blank_disabled(text) if path.suffix in CPP_SUFFIXES else text)


def try_read_text(path: Path) -> str | None:
    """Return the whole text of a source, or None if it cannot be read or is too large."""
    try:
        return None if path.stat().st_size > _MAX_BYTES else path.read_text("utf-8-sig", errors="replace")
    except OSError:
        return None


def try_parse_versions(old_path: Path, new_path: Path) -> tuple[PythonFile, PythonFile] | None:
    """Return both versions of a Python source, or None if one of them cannot be read."""
    sources = [try_read_source(path) for path in (old_path, new_path)]
    try:
        old, new = (parse_source(source) for source in sources if source is not None)
    except (ValueError, SyntaxError, RecursionError):
        return None
    return old, new


@cached_in_review(maxsize=_MAX_SOURCES)
def read_source_names(path: Path) -> SourceNames:
    """Return the names in a source. The result is empty for a file that cannot be read."""
    names = SourceNames()
    source = try_read_source(path)
    if source is None:
        return names
    try:
        if path.suffix == DYNAMIC_SUFFIX:
            read_dynamic_parameters(source, names)
        elif path.suffix in CPP_SUFFIXES:
            read_cpp(source, names)
        else:
            read_python(source, names)
    except SyntaxError as error:
        is_certain = not error.msg.startswith(_FORMATTED_TEXT)  # Python 3.12 accepts more of them
        return SourceNames(error_line=error.lineno or 1, is_error_certain=is_certain)
    except (ValueError, RecursionError):
        return SourceNames()
    return names


def is_program_text(path: Path) -> bool:
    """Return whether a file is a Python or C++ source, or a dynamic_reconfigure description.

    A script without a suffix needs a first line that names Python.
    """
    if path.suffix in (*CPP_SUFFIXES, PYTHON_SUFFIX):
        return True
    if path.suffix not in ("", DYNAMIC_SUFFIX):
        return False
    try:
        with path.open("rb") as file:
            head = file.read(_MAX_BYTES if path.suffix else 256)
    except OSError:
        return False
    if path.suffix == DYNAMIC_SUFFIX:
        return b"ParameterGenerator" in head
    return head.startswith(b"#!") and _PYTHON_NAME in head.splitlines()[0]


def try_parse(path: Path) -> PythonFile | None:
    """Return a Python file with its syntax tree, or None if it cannot be read."""
    source = try_read_source(path)
    try:
        return None if source is None else PythonFile(source)
    except (SyntaxError, ValueError, RecursionError):
        return None
