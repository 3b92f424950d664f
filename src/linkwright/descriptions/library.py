"""Share a description between all readers of the same text."""

from __future__ import annotations

from collections import OrderedDict
from pathlib import Path

from linkwright.descriptions.description import Description
from linkwright.diagnostics import LinkwrightError
from linkwright.diagnostics.source import TEXT_NAME
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages import PackageFinder
from linkwright.urdf import Reading, read
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.xmltree import Document, Element

if TYPE_CHECKING:
    from linkwright.xacro.tracing.provenance import Provenance

_KEPT_TEXTS = 32


class DescriptionLibrary:
    """A cache of descriptions by their expanded texts, so that each is read once.

    The launcher stores the description that a text was expanded from; the nodes and the viewer, which get the bare
    text from a parameter or topic, then know where everything was written.
    """

    def __init__(self) -> None:
        self._descriptions: OrderedDict[str, Description] = OrderedDict()
        self._finders: dict[str, PackageFinder] = {}

    def store(self, description: Description, text: str | None = None, packages: PackageFinder | None = None) -> str:
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
            self.store(known, text)
        else:
            self._descriptions.move_to_end(text)
        return known.reading


def _read(text: str) -> Description:
    try:
        document, _ = parse_as_urdfdom(text, TEXT_NAME)
    except LinkwrightError as error:
        return Description(TEXT_NAME, Document(Element("robot")), Reading(None, error.diagnostics))
    if document.root.tag == "sdf":
        from linkwright.descriptions.worlds import robot_of_text

        return Description(TEXT_NAME, document, robot_of_text(text, TEXT_NAME))
    return Description(TEXT_NAME, document, read(document))
