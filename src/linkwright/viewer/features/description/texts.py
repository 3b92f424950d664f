"""The texts that a description was made from."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, SourceText
from linkwright.xacro.origin import Frame, frames
from linkwright.xmltree import Element
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.reader import read_bytes


class SourceTexts:
    """The files of one description, and no others.

    What elements were written in is in memory, as it was when the description was made. A file that gave only values,
    such as one of YAML, is read when somebody asks for it.

    Args:
        root: the root element of the description.
        files: the files it was made from, the main one first, as far as that is known.
    """

    def __init__(self, root: Element | None, files: Iterable[Path]) -> None:
        self._read = _sources(root)
        self._files: dict[str, Path] = {str(path): path for path in files}

    @property
    def names(self) -> list[str]:
        """The files, the main one first."""
        return list(dict.fromkeys([*self._files, *self._read]))

    def text(self, name: str) -> str | None:
        """The text of a file; None for what the description was not made from, or is not there any more."""
        source = self._read.get(name)
        if source is not None:
            return source.text
        path = self._files.get(name)
        if path is None:
            return None
        try:
            return decode(read_bytes(path), name)
        except LinkwrightError:
            return None


def _sources(root: Element | None) -> dict[str, SourceText]:
    """The texts in which the elements, and the calls that brought them, are written."""
    found: dict[str, SourceText] = {}
    known: set[int] = set()
    for element in root.walk() if root is not None else ():
        for source in (element.source, *_sites(element, known)):
            if source is not None and not source.name.startswith("<"):
                found.setdefault(source.name, source)
    return found


def _sites(element: Element, known: set[int]) -> Iterator[SourceText | None]:
    innermost = element.origin
    if not isinstance(innermost, Frame) or id(innermost) in known:
        return
    known.add(id(innermost))
    for frame in frames(innermost):
        yield frame.site.source
