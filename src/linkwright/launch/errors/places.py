"""Where in a launch file something was written, for the messages about it."""

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

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, SourceText, Span
from linkwright.launch.errors.exceptions import as_ros_error

T = TypeVar("T", bound="Placed")

_OURS = str(Path(__file__).parents[2]) + os.sep
_SHIPPED_PACKAGES = _OURS + "robots" + os.sep
_STARTERS = (_OURS + "cli" + os.sep, str(Path(asyncio.__file__).parent) + os.sep)
"""Folders of the programs that our own code may have been started by: the command line, the event loop."""


class Place(ABC):
    """Where something was written: in a program (`CodePlace`) or in an XML or YAML file (`MarkupPlace`)."""

    __slots__ = ()

    def __deepcopy__(self, _: object) -> Place:
        """Itself: places do not change."""
        return self

    @staticmethod
    def of_caller() -> Place | None:
        """The markup being read now, else the nearest frame on the stack that is not Linkwright's own; None without.

        What our command line or the event loop was started by (a script, Python itself) is no place of the user's.
        """
        if _being_read:
            return _being_read[-1]
        frame: FrameType | None = sys._getframe(1)
        while frame is not None:
            filename = frame.f_code.co_filename
            if filename.startswith(_STARTERS):
                return None
            if not is_ours(filename):
                break
            frame = frame.f_back
        return None if frame is None else CodePlace(frame.f_code, frame.f_lasti, frame.f_lineno)

    @property
    @abstractmethod
    def file(self) -> str:
        """The file."""

    @abstractmethod
    def source(self) -> SourceText | None:
        """The text of the file; None where it cannot be read again."""

    @abstractmethod
    def span(self, source: SourceText | None = None) -> Span:
        """The lines and columns, worked out when a message needs them."""


@dataclass(frozen=True, slots=True)
class MarkupPlace(Place):
    """A piece of an XML or YAML launch file.

    Attributes:
        text: the whole file.
        start: character offset of the piece.
        end: offset of its end, exclusive.
    """

    text: SourceText
    start: int
    end: int

    @property
    def file(self) -> str:
        """The file."""
        return self.text.name

    def source(self) -> SourceText:
        """The text of the file."""
        return self.text

    def span(self, source: SourceText | None = None) -> Span:
        """The lines and columns of the piece."""
        return self.text.span(self.start, self.end)

    def part(self, start: int, end: int) -> MarkupPlace:
        """A part of it, by offsets in its text in the file."""
        return MarkupPlace(self.text, min(self.start + start, self.end), min(self.start + end, self.end))


class Placed:
    """Something that knows the place in the user's program or launch file where it was made.

    Attributes:
        place: where it was written; None where that is not known.
    """

    place: Place | None = None

    def __new__(cls: type[T], *_: Any, **__: Any) -> T:  # noqa: PYI019 - Self needs Python 3.11
        """Remember the place; done here because classes of users need not call our constructor."""
        made = super().__new__(cls)
        made.place = Place.of_caller()
        return made


_being_read: list[Place | None] = []


@contextmanager
def reading(place: Place | None) -> Iterator[None]:
    """While this lasts, what is made was written at the place."""
    _being_read.append(place)
    try:
        yield
    finally:
        _being_read.pop()


@contextmanager
def not_reading() -> Iterator[None]:
    """While this lasts, what is made was written where Python's stack says, though markup is being read."""
    kept = _being_read[:]
    _being_read.clear()
    try:
        yield
    finally:
        _being_read[:] = kept


@dataclass(frozen=True, slots=True)
class CodePlace(Place):
    """A point of a running program."""

    code: CodeType
    instruction: int
    line: int

    @property
    def file(self) -> str:
        """The file of the program text."""
        return self.code.co_filename

    def source(self) -> SourceText | None:
        """The program text; None where it cannot be read again."""
        return read_source(self.file)

    def span(self, source: SourceText | None = None) -> Span:
        """The expression at the place, or its line where Python (3.10) keeps no columns."""
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


def is_ours(filename: str) -> bool:
    """Whether a program file belongs to Linkwright itself (and not to a robot package that it ships)."""
    return filename.startswith(_OURS) and not filename.startswith(_SHIPPED_PACKAGES)


def read_source(filename: str) -> SourceText | None:
    """The text of a program file, or None where it cannot be read."""
    try:
        return SourceText(filename, Path(filename).read_text(encoding="utf-8", errors="replace"))
    except (OSError, ValueError):
        return None


def located(error: LinkwrightError, place: Place | None) -> LinkwrightError:
    """The error with a place for its diagnostics; one that names a place already stays as it is."""
    if place is None or any(diagnostic.span for diagnostic in error.diagnostics):
        return error
    source = place.source()
    span = place.span(source)
    error.diagnostics = tuple(diagnostic.but(span=span, source=source) for diagnostic in error.diagnostics)
    return error


def error_at(
    place: Place | None,
    code: str,
    message: Phrase,
    hint: Phrase | None = None,
    *,
    notes: tuple[Note, ...] = (),
    ros_error: Exception | None = None,
) -> LinkwrightError:
    """A new error about what was written at a place.

    Args:
        place: where it was written.
        code: of the diagnostic.
        message: of the diagnostic.
        hint: of the diagnostic.
        notes: of the diagnostic.
        ros_error: what ROS raises here; the error is of its class too, and has its text for programs that look at it.
    """
    return located(as_ros_error(ros_error, Diagnostic(code, message, notes=notes, hint=hint)), place)


def _characters(line: str, byte_offset: int) -> int:
    return len(line.encode("utf-8")[:byte_offset].decode("utf-8", errors="replace"))
