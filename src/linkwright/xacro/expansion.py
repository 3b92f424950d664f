"""The result of an expansion: the document, its arguments and dependencies, and what was found on the way."""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.lean_typing import TYPE_CHECKING
from linkwright.xacro.inputs import Inputs
from linkwright.xacro.origin import Origin, origin_of
from linkwright.xmltree import Document, Element, write

if TYPE_CHECKING:
    from pathlib import Path

    from linkwright.xacro.tracing.provenance import Provenance


class Expansion:
    """The result of expanding a file.

    Attributes:
        document: the expanded document. Every element has the source and offset where it was written.
        arguments: name -> final value of every argument that was given or declared.
        diagnostics: warnings, and what the description says through ``xacro.message`` and its like.
        inputs: what it started from, or None.
        problems: the mistakes for which parts are missing; see `linkwright.xacro.parts`.
    """

    def __init__(
        self,
        document: Document,
        dependencies: Iterable[str | Path],
        arguments: dict[str, str],
        diagnostics: tuple[Diagnostic, ...],
        inputs: Inputs | None = None,
        problems: tuple[Diagnostic, ...] = (),
    ) -> None:
        self.document = document
        self._dependencies = tuple(dependencies)
        self.arguments = arguments
        self.diagnostics = diagnostics
        self.inputs = inputs
        self.problems = problems
        self._text: str | None = None

    @property
    def dependencies(self) -> tuple[Path, ...]:
        """The files that were read, the main file first."""
        from pathlib import Path  # which is imported late because it takes long

        return tuple(Path(file) for file in self._dependencies)

    def __str__(self) -> str:
        """The text that ros/xacro writes."""
        if self._text is None:
            self._text = write(self.document)
        return self._text

    def origin(self, element: Element) -> Origin:
        """Where an element of the document was written, and the calls and includes that brought it there."""
        return origin_of(element)

    def provenance(self, element: Element) -> Provenance:
        """All there is to say of an element of the document: `origin`, its parameters, and each attribute's provenance.

        The file is expanded once more for it, so it is told as long as the files are what they were.

        Raises:
            LinkwrightError: XAC802 when they no longer are, or the element is not one of the document's.
        """
        if self.inputs is None:
            raise LinkwrightError(Diagnostic("XAC802", phrase("nothing is known of how this document was expanded")))
        from linkwright.xacro.tracing.provenance import provenance_of

        return provenance_of(self.inputs, self.document.root, element)
