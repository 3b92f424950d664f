"""Where a part of a description was written."""

from __future__ import annotations

from pathlib import Path

from linkwright.viewer.protocol import Place
from linkwright.xacro.origin import origin_of
from linkwright.xmltree import Element


def place_of(element: Element | None) -> Place | None:
    """Where an element was written, and through which macro calls and includes it came; None if a program made it."""
    if element is None:
        return None
    origin = origin_of(element)
    if origin.span is None:
        return None
    return Place(
        file=origin.span.file,
        line=origin.span.line,
        column=origin.span.column,
        trail=[f"{note.message}: {note.span}" if note.span else note.message for note in origin.trail],
    )


def folder_of(element: Element | None) -> Path | None:
    """The folder of the file an element was written in, from which relative paths in it start; None if it has none."""
    if element is None or element.source is None or element.source.name.startswith("<"):
        return None
    return Path(element.source.name).parent
