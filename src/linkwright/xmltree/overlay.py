"""Texts that replace those of files."""

from __future__ import annotations

import os
from collections.abc import Mapping

from linkwright.xmltree.decoding import Decoded, decoded, unsaved
from linkwright.xmltree.nodes import Document
from linkwright.xmltree.reader import parse, read_bytes


class Overlay:
    """The files of the disk, some of them with other texts, such as those that an editor has not saved yet.

    Args:
        texts: path -> the text to take for that of the file, whether or not there is one.
    """

    def __init__(self, texts: Mapping[str | os.PathLike[str], str] | None = None) -> None:
        self._texts = {_key(path): text for path, text in (texts or {}).items()}
        self._documents: dict[str, Document] = {}

    def text(self, path: str | os.PathLike[str]) -> str | None:
        """The text that replaces that of a file, or None if the disk has the text."""
        return self._texts.get(_key(path)) if self._texts else None

    def document(self, path: str) -> Document | None:
        """The document of such a text, parsed once; None if the disk has the text.

        Raises:
            LinkwrightError: the text is not XML; see `linkwright.xmltree.parse`.
        """
        text = self.text(path)
        if text is None:
            return None
        if path not in self._documents:
            self._documents[path] = parse(text, path)
        return self._documents[path]

    def read(self, path: str) -> Decoded:
        """The text of a file, and the encoding that it is in.

        Raises:
            LinkwrightError: XML101 to XML104 and XML106, there is none to be had.
        """
        text = self.text(path)
        return decoded(read_bytes(path), path) if text is None else unsaved(text, path)


def _key(path: str | os.PathLike[str]) -> str:
    """One name for a file, through whichever links it is reached: packages are often installed as links."""
    return os.path.realpath(path)
