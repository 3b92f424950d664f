"""The origin of an element: the macro calls and includes that brought it into the document."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from linkwright.diagnostics import Note, Span, phrase
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.xmltree import Element

_SHOWN = 10


class Frame:
    """A macro call or an include, and the one that it happened in.

    Attributes:
        macro: the macro's name, or None for an include.
        site: the element that calls or includes.
        around: the frame that the call or include happened in, or None.
        depth: how many frames there are, this one included.
    """

    __slots__ = ("around", "depth", "macro", "site")

    def __init__(self, macro: str | None, site: Element, around: Frame | None) -> None:
        self.macro = macro
        self.site = site
        self.around = around
        self.depth: int = 1 if around is None else around.depth + 1

    def note(self) -> Note:
        """Its note in a message."""
        what = (
            phrase("included from here")
            if self.macro is None
            else phrase("in macro '{macro}' called here", macro=self.macro)
        )
        return Note(what, self.site.span())


class Origin(NamedTuple):
    """Where an element of an expansion comes from.

    Attributes:
        span: where it is written; None for an element made by a program.
        trail: the macro calls and includes around it, innermost first.
    """

    span: Span | None
    trail: tuple[Note, ...]


def frames(innermost: Frame | None) -> Iterator[Frame]:
    """The frames from the innermost one outwards."""
    frame = innermost
    while frame is not None:
        yield frame
        frame = frame.around


def trail(innermost: Frame | None) -> tuple[Note, ...]:
    """The notes of all frames, innermost first; of very many, the outermost are counted only."""
    notes: list[Note] = []
    for site, group in groupby(frames(innermost), key=lambda frame: frame.site):
        repeated = list(group)
        if len(notes) == _SHOWN and repeated[0].depth > 1:
            notes.append(Note(phrase("and {depth} more calls and includes around it", depth=repeated[0].depth)))
            break
        note = repeated[0].note()
        if len(repeated) > 1:
            note = Note(phrase("{message}, {count} times", message=note.message, count=len(repeated)), site.span())
        notes.append(note)
    return tuple(notes)


def origin_of(element: Element) -> Origin:
    """Where an element of an expansion comes from."""
    frame = element.origin
    return Origin(element.span(), trail(frame if isinstance(frame, Frame) else None))
