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
from linkwright.packages.programs.code_files import is_ours

T = TypeVar("T", bound="Placed")

_STARTER_FOLDERS = (str(Path(__file__).parents[2] / "cli") + os.sep, str(Path(asyncio.__file__).parent) + os.sep)
"""Folders of the programs that may have started our code: the command line, the event loop."""


class Place(ABC):
    """A location in a program (`CodePlace`) or in an XML or YAML file (`MarkupPlace`)."""

    __slots__ = ()

    def __deepcopy__(self, _: object) -> Place:
        """Return the place itself, which is immutable."""
        return self

    @staticmethod
    def of_caller() -> Place | None:
        """Return the place of the markup being read, or else of the nearest frame of user code.

        Returns:
            The place; None if Linkwright's command line or the event loop started the calling code.
        """
        if _markup_places:
            return _markup_places[-1]
        frame: FrameType | None = sys._getframe(1)
        while frame is not None:
            filename = frame.f_code.co_filename
            if filename.startswith(_STARTER_FOLDERS):
                return None
            if not is_ours(filename):
                break
            frame = frame.f_back
        return None if frame is None else CodePlace(frame.f_code, frame.f_lasti, frame.f_lineno)

    @property
    @abstractmethod
    def file(self) -> str:
        """The name of the file."""

    @abstractmethod
    def source(self) -> SourceText | None:
        """Return the text of the file, or None if it cannot be read again."""

    @abstractmethod
    def span(self, source: SourceText | None = None) -> Span:
        """Return the lines and columns, which are computed only on request."""


@dataclass(frozen=True, slots=True)
class MarkupPlace(Place):
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

    def part(self, start: int, end: int) -> MarkupPlace:
        """Return a part of this range.

        Args:
            start: the first character, as an offset from the start of this range.
            end: the end of the part, exclusive, as an offset from the start of this range.
        """
        return MarkupPlace(self.text, min(self.start + start, self.end), min(self.start + end, self.end))


class Placed:
    """An object that records the place where the user's program or launch file created it.

    Attributes:
        place: the location; None if it is not known.
    """

    place: Place | None = None

    def __new__(cls: type[T], *_: Any, **__: Any) -> T:  # noqa: PYI019 - Self needs Python 3.11
        """Create the object and record the place of the caller.

        The place is not recorded in ``__init__``, because users' classes need not call our constructor.
        """
        made = super().__new__(cls)
        made.place = Place.of_caller()
        return made


_markup_places: list[Place | None] = []


@contextmanager
def reading_markup_at(place: Place | None) -> Iterator[None]:
    """Set the place that is recorded for objects created in this context; None if unknown."""
    _markup_places.append(place)
    try:
        yield
    finally:
        _markup_places.pop()


@contextmanager
def outside_markup() -> Iterator[None]:
    """Record the caller's place on Python's stack for objects created in this context.

    Outside this context, the objects get the place in the markup that is being read.
    """
    kept = _markup_places[:]
    _markup_places.clear()
    try:
        yield
    finally:
        _markup_places[:] = kept


@dataclass(frozen=True, slots=True)
class CodePlace(Place):
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
        """Return the expression at the place, or its entire line before Python 3.11."""
        positions = getattr(self.code, "co_positions", None)
        if positions is not None:
            exact = next(islice(positions(), self.instruction // 2, None), None)
            if exact is not None and None not in exact:
                return self._exact_span(exact, source)
        text = source.line(self.line) if source else ""
        start = len(text) - len(text.lstrip()) + 1
        return Span(self.file, self.line, start, self.line, max(len(text.rstrip()), start) + 1)

    def _exact_span(self, exact: tuple[int, int, int, int], source: SourceText | None) -> Span:
        line, end_line, start, end = exact
        if source:
            start = _characters(source.line(line), start)
            end = _characters(source.line(end_line), end)
        return Span(self.file, line, start + 1, end_line, end + 1)


def read_source(filename: str) -> SourceText | None:
    """Return the text of a program file, or None if it cannot be read."""
    try:
        return SourceText(filename, Path(filename).read_text(encoding="utf-8", errors="replace"))
    except (OSError, ValueError):
        return None


def located(error: LinkwrightError, place: Place | None) -> LinkwrightError:
    """Set the place of all diagnostics of an error if none of them has a location.

    Returns:
        The same error.
    """
    if place is None or any(diagnostic.span for diagnostic in error.diagnostics):
        return error
    source = place.source()
    span = place.span(source)
    error.diagnostics = tuple(diagnostic.with_changes(span=span, source=source) for diagnostic in error.diagnostics)
    return error


def error_at(
    place: Place | None,
    code: str,
    message: Phrase,
    hint: Phrase | None = None,
    *,
    ros_error: Exception | None = None,
) -> LinkwrightError:
    """Return a new error about the text at a place.

    Args:
        place: the location; None if it is not known.
        code: the code of the diagnostic.
        message: the message of the diagnostic.
        hint: the hint of the diagnostic.
        ros_error: the exception that ROS raises in this case. The new error has the class and text of this exception,
            for programs that check them.
    """
    return located(as_ros_error(ros_error, Diagnostic(code, message, hint=hint)), place)


def _characters(line: str, byte_offset: int) -> int:
    return len(line.encode("utf-8")[:byte_offset].decode("utf-8", errors="replace"))
