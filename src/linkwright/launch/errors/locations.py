"""Locations in launch files, for messages."""

from __future__ import annotations

import asyncio
import os
import sys
from abc import ABC, abstractmethod
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from types import CodeType, FrameType
from typing import Any, TypeVar

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, SourceText, Span
from linkwright.launch.errors.exceptions import as_ros_error
from linkwright.packages.programs.code_files import is_linkwright_file

T = TypeVar("T", bound="Located")

_STARTER_FOLDERS = (str(Path(__file__).parents[2] / "cli") + os.sep, str(Path(asyncio.__file__).parent) + os.sep)
"""The folders of code that may have started Linkwright.

They contain the code of its command line and of the event loop.
"""


class SourceLocation(ABC):
    """A location in a program (`CodeLocation`), or in an XML or YAML file (`MarkupLocation`)."""

    __slots__ = ()

    def __deepcopy__(self, _: object) -> SourceLocation:
        """Return the location itself, because it is immutable."""
        return self

    @staticmethod
    def of_caller() -> SourceLocation | None:
        """Return the location in the markup being read, or the caller's location in user code.

        Returns:
            The location; None if the call did not come from user code.
        """
        if _markup_locations:
            return _markup_locations[-1]
        frame: FrameType | None = sys._getframe(1)
        while frame is not None:
            filename = frame.f_code.co_filename
            if filename.startswith(_STARTER_FOLDERS):
                return None
            if not is_linkwright_file(filename):
                break
            frame = frame.f_back
        return None if frame is None else CodeLocation(frame.f_code, frame.f_lasti, frame.f_lineno)

    @property
    @abstractmethod
    def file(self) -> str:
        """The name of the file."""

    @abstractmethod
    def source(self) -> SourceText | None:
        """Return the text of the file, or None if it cannot be read again."""

    @abstractmethod
    def span(self, source: SourceText | None = None) -> Span:
        """Return the lines and columns of the location, computed on request."""


@dataclass(frozen=True, slots=True)
class MarkupLocation(SourceLocation):
    """A range of text in an XML or YAML launch file.

    Attributes:
        text: the text of the file.
        start: the character offset where the range starts.
        end: the character offset where the range ends, exclusive.
    """

    text: SourceText
    start: int
    end: int

    @property
    def file(self) -> str:
        """The name of the file."""
        return self.text.name

    def source(self) -> SourceText:
        """Return the text of the file."""
        return self.text

    def span(self, source: SourceText | None = None) -> Span:
        """Return the lines and columns of the range."""
        return self.text.span(self.start, self.end)

    def part(self, start: int, end: int) -> MarkupLocation:
        """Return a subrange of this range.

        Args:
            start: the start of the subrange, as an offset from the start of this range.
            end: the end of the subrange, exclusive, as an offset from the start of this range.
        """
        return MarkupLocation(self.text, min(self.start + start, self.end), min(self.start + end, self.end))


class Located:
    """An object that records the location where the user's program or launch file created it.

    Attributes:
        source_location: the location; None if it is unknown.
    """

    source_location: SourceLocation | None = None

    def __new__(cls: type[T], *_: Any, **__: Any) -> T:  # noqa: PYI019 - Self needs Python 3.11
        """Create the object, and record the location of the caller.

        The location is not recorded in ``__init__``, because users' classes need not call this constructor.
        """
        created = super().__new__(cls)
        created.source_location = SourceLocation.of_caller()
        return created


_markup_locations: list[SourceLocation | None] = []


@contextmanager
def reading_markup_at(location: SourceLocation | None) -> Iterator[None]:
    """Record a location in markup for the objects that are created in this context.

    The location is None if it is unknown.
    """
    _markup_locations.append(location)
    try:
        yield
    finally:
        _markup_locations.pop()


@contextmanager
def outside_markup() -> Iterator[None]:
    """Record the caller's location in Python code for objects created in this context.

    Without this context, the location in the markup that is being read would be recorded.
    """
    saved_locations = _markup_locations[:]
    _markup_locations.clear()
    try:
        yield
    finally:
        _markup_locations[:] = saved_locations


@dataclass(frozen=True, slots=True)
class CodeLocation(SourceLocation):
    """A location in the code of a running program."""

    code: CodeType
    instruction: int
    line: int

    @property
    def file(self) -> str:
        """The name of the file that contains the code."""
        return self.code.co_filename

    def source(self) -> SourceText | None:
        """Return the text of the program file, or None if it cannot be read again."""
        return read_source(self.file)

    def span(self, source: SourceText | None = None) -> Span:
        """Return the range of the expression at the location.

        Before Python 3.11, the range is that of the entire line.
        """
        positions = getattr(self.code, "co_positions", None)
        if positions is not None:
            instruction_positions = next(islice(positions(), self.instruction // 2, None), None)
            if instruction_positions is not None and None not in instruction_positions:
                return self._exact_span(instruction_positions, source)
        text = source.line(self.line) if source else ""
        start = len(text) - len(text.lstrip()) + 1
        return Span(self.file, self.line, start, self.line, max(len(text.rstrip()), start) + 1)

    def _exact_span(self, exact_positions: tuple[int, int, int, int], source: SourceText | None) -> Span:
        line, end_line, start, end = exact_positions
        if source:
            start = _to_character_offset(source.line(line), start)
            end = _to_character_offset(source.line(end_line), end)
        return Span(self.file, line, start + 1, end_line, end + 1)


def read_source(filename: str) -> SourceText | None:
    """Return the text of a program file, or None if it cannot be read."""
    try:
        return SourceText(filename, Path(filename).read_text(encoding="utf-8", errors="replace"))
    except (OSError, ValueError):
        return None


def with_location(error: LinkwrightError, location: SourceLocation | None) -> LinkwrightError:
    """Set the location of all findings of an error, if none of them has one.

    Returns:
        The same error.
    """
    if location is None or any(diagnostic.span for diagnostic in error.diagnostics):
        return error
    source = location.source()
    span = location.span(source)
    error.diagnostics = tuple(diagnostic.with_changes(span=span, source=source) for diagnostic in error.diagnostics)
    return error


def error_at(
    location: SourceLocation | None,
    code: str,
    message: Phrase,
    hint: Phrase | None = None,
    *,
    ros_error: Exception | None = None,
) -> LinkwrightError:
    """Return a new error with a location.

    Args:
        location: the location; None if it is unknown.
        code: the code of the finding.
        message: the message of the finding.
        hint: the hint of the finding, or None.
        ros_error: the exception that ROS raises in this case, or None. The new error has the class and text of this
            exception, because programs may check them.
    """
    return with_location(as_ros_error(ros_error, Diagnostic(code, message, hint=hint)), location)


def _to_character_offset(line: str, byte_offset: int) -> int:
    return len(line.encode("utf-8")[:byte_offset].decode("utf-8", errors="replace"))
