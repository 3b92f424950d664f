"""Snapshots of a description: the texts of its files, with the replacements of trial edits."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import suppress
from functools import cached_property
from pathlib import Path

from linkwright.descriptions.editing.definitions import Definitions
from linkwright.descriptions.editing.text_ranges import TextRange
from linkwright.descriptions.service import Description
from linkwright.diagnostics import LinkwrightError
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.urdf import read
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.xmltree import Document, Element, Overlay
from linkwright.xmltree.reader import read_bytes

if TYPE_CHECKING:
    from linkwright.xacro import Expansion

_YAML_SUFFIXES = (".yaml", ".yml")


@dataclass(frozen=True)
class Snapshot:
    """An expansion of a description with changed texts.

    Attributes:
        description: the description as it was first read, with its arguments.
        texts: the changed text of each edited file, and unsaved texts, by real path.
        document: the expansion with these texts.
        files: the files that were read for the expansion.
        expansion: the result of the expansion, or None for plain URDF.
    """

    description: Description
    texts: Mapping[str | os.PathLike[str], str]
    document: Document
    files: tuple[Path, ...]
    expansion: Expansion | None = None

    @classmethod
    def of(cls, description: Description) -> Snapshot:
        """Return the snapshot of a description that was just read, with its unsaved texts."""
        texts = {} if description.overlay is None else dict(description.overlay.texts)
        return cls(description, texts, description.document, description.files)

    @property
    def root(self) -> Element:
        """The root of the expanded document."""
        return self.document.root

    @cached_property
    def definitions(self) -> Definitions:
        """The definitions of named values in the files."""
        from linkwright.xacro.cache import read_document

        if self.description.expansion is None:
            return Definitions((), (), Overlay())
        overlay = Overlay(self.texts)
        documents: list[Document] = []
        other_files: list[Path] = []
        for path in self.files:
            if path.suffix in _YAML_SUFFIXES:
                other_files.append(path)
            else:
                with suppress(LinkwrightError):  # an optional file may not exist
                    documents.append(read_document(str(path), overlay))
        return Definitions(documents, other_files, overlay)

    def with_text(self, text_range: TextRange, text: str) -> Snapshot:
        """Return a snapshot in which a text replaces one range of a file.

        Raises:
            LinkwrightError: if the description can no longer be expanded.
        """
        source_text = text_range.source.text
        changed_text = source_text[: text_range.start] + text + source_text[text_range.end :]
        texts = {**self.texts, os.path.realpath(text_range.source.name): changed_text}
        return self.with_texts(texts)

    def with_texts(self, texts: Mapping[str | os.PathLike[str], str]) -> Snapshot:
        """Return a snapshot in which texts replace whole files.

        Raises:
            LinkwrightError: if the description cannot be expanded with these texts.
        """
        name, expansion, overlay = self.description.name, self.description.expansion, Overlay(texts)
        text = overlay.text(name)
        if expansion is None:
            document, _ = parse_as_urdfdom(read_bytes(name) if text is None else text, name)
            return Snapshot(self.description, texts, document, self.files)
        from linkwright.xacro import expand

        inputs = expansion.inputs
        assert inputs is not None, "it was expanded from a file"
        new_expansion = expand(name, inputs.arguments, packages=inputs.packages, text=text, overlay=overlay)
        return Snapshot(self.description, texts, new_expansion.document, new_expansion.dependencies, new_expansion)


def read_again(description: Description, unsaved: Mapping[str | os.PathLike[str], str] | None = None) -> Description:
    """Return a description read again from its files, with the same arguments and packages.

    Args:
        description: the description to read.
        unsaved: texts that replace the contents of files, by real path.

    Raises:
        LinkwrightError: if the files can no longer be read or expanded.
    """
    overlay = Overlay(unsaved)
    snapshot = Snapshot.of(description).with_texts(overlay.texts)
    if snapshot.expansion is None:
        return Description(description.name, snapshot.document, read(snapshot.document), overlay=overlay)
    return Description.of_expansion(description.name, snapshot.expansion, overlay)
