"""Share a description between all readers of the same text."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from contextlib import suppress
from functools import cached_property
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.diagnostics.source import TEXT_NAME
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages import PackageFinder
from linkwright.urdf import Reading, Robot, read
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.xmltree import Document, Element, Overlay

if TYPE_CHECKING:
    from linkwright.xacro import Expansion
    from linkwright.xacro.tracing.provenance import Provenance


TRUE_OF_PARTS = frozenset(
    {
        *("URDF101", "URDF102", "URDF110", "URDF120", "URDF121", "URDF122", "URDF123", "URDF124", "URDF130"),
        *("URDF131", "URDF132", "URDF140", "URDF162", "URDF170", "URDF190"),
    }
)
"""Findings of the reader that hold whatever else the robot has; the others may be due to what is missing."""


@dataclass(frozen=True, eq=False)
class Description:
    """A robot description, read.

    Attributes:
        name: the path as it was given, or `TEXT_NAME`.
        document: the URDF document, expanded; every element has its source file and place.
        reading: the result of the URDF reader.
        expansion: xacro's record of making the document; None for plain URDF.
        overlay: texts that replaced those of files.
        problems: mistakes because of which only parts of the description are available; there is no robot then.
    """

    name: str
    document: Document
    reading: Reading
    expansion: Expansion | None = None
    overlay: Overlay | None = None
    problems: tuple[Diagnostic, ...] = ()

    @classmethod
    def of_expansion(cls, name: str, expansion: Expansion, overlay: Overlay | None = None) -> Description:
        """The description of an expanded file; without `problems` of the expansion it has the whole robot."""
        reading = read(expansion.document)
        if expansion.problems:
            reading = Reading(None, tuple(found for found in reading.diagnostics if found.code in TRUE_OF_PARTS))
        return cls(name, expansion.document, reading, expansion, overlay, expansion.problems)

    @property
    def robot(self) -> Robot | None:
        """The robot; None if urdfdom would refuse the model."""
        return self.reading.robot

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The problems, the remarks of xacro, and all findings of the reader."""
        return (*self.problems, *self.remarks, *self.reading.diagnostics)

    @property
    def remarks(self) -> tuple[Diagnostic, ...]:
        """The warnings of xacro, and the messages of ``xacro.message`` and its like."""
        return () if self.expansion is None else self.expansion.diagnostics

    @cached_property
    def text(self) -> str:
        """The URDF text, as topics and parameters carry it."""
        if self.expansion is not None:
            return str(self.expansion)
        return self.document.source.text if self.document.source is not None else ""

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that were read, the main file first; none for a plain text."""
        if self.expansion is not None:
            return self.expansion.dependencies
        return () if self.name.startswith("<") else (Path(self.name),)

    @cached_property
    def sources(self) -> Mapping[Path, Document]:
        """Every XML file that was read, as it is written (not expanded), the main file first."""
        if self.expansion is None:
            return {Path(self.name): self.document}
        from linkwright.xacro import sources

        found: dict[Path, Document] = {}
        for path in self.expansion.dependencies:
            with suppress(LinkwrightError):  # YAML files are among them
                found[path] = sources.read(str(path), self.overlay)
        return found

    def provenance(self, element: Element) -> Provenance | None:
        """Return the macro calls and includes that made an element; None for plain URDF, where it is written as it is.

        Raises:
            LinkwrightError: XAC802, the files are no longer what they were.
        """
        return None if self.expansion is None else self.expansion.provenance(element)


_KEPT_TEXTS = 32


class DescriptionLibrary:
    """A cache of descriptions by their expanded texts, so that each is read once.

    The launcher remembers the description that a text was expanded from; the nodes and the viewer, which get the bare
    text from a parameter or topic, then know where everything was written.
    """

    def __init__(self) -> None:
        self._descriptions: OrderedDict[str, Description] = OrderedDict()
        self._finders: dict[str, PackageFinder] = {}

    def remember(self, description: Description, text: str | None = None, packages: PackageFinder | None = None) -> str:
        """Store a description, to be found by its text.

        Args:
            description: a description.
            text: the text to find it by, if that is not its own.
            packages: finds its packages, if these may differ from those of the rest of the program.

        Returns:
            The text.
        """
        text = description.text if text is None else text
        self._descriptions[text] = description
        self._descriptions.move_to_end(text)
        if packages is not None:
            self._finders[text] = packages
        if len(self._descriptions) > _KEPT_TEXTS:
            self._finders.pop(self._descriptions.popitem(last=False)[0], None)
        return text

    def packages(self, text: str) -> PackageFinder | None:
        """Return the package finder of a stored description, or None if it has none."""
        return self._finders.get(text)

    def description(self, text: str) -> Description | None:
        """Return the stored description with a text, or None if there is none."""
        return self._descriptions.get(text)

    def files(self, text: str) -> tuple[Path, ...]:
        """Return the files of a stored description, the main file first; empty if it is not stored."""
        known = self._descriptions.get(text)
        return () if known is None else known.files

    def provenance(self, text: str, element: Element) -> Provenance | None:
        """Return the macro calls and includes that made an element of a stored description; None for an unknown text.

        Raises:
            LinkwrightError: XAC802, its files are no longer what they were.
        """
        known = self._descriptions.get(text)
        return None if known is None else known.provenance(element)

    def read(self, text: str) -> Reading:
        """Read a description text, plain URDF or SDF; one that is not XML gives no robot, with the reason."""
        known = self._descriptions.get(text)
        if known is None:
            known = _read(text)
            self.remember(known, text)
        else:
            self._descriptions.move_to_end(text)
        return known.reading


def _read(text: str) -> Description:
    try:
        document, _ = parse_as_urdfdom(text, TEXT_NAME)
    except LinkwrightError as error:
        return Description(TEXT_NAME, Document(Element("robot")), Reading(None, error.diagnostics))
    if document.root.tag == "sdf":
        from linkwright.descriptions.service import robot_of_text

        return Description(TEXT_NAME, document, robot_of_text(text, TEXT_NAME))
    return Description(TEXT_NAME, document, read(document))
