"""The result of an expansion: the document, its arguments, dependencies and diagnostics."""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.loading.lean_typing import TYPE_CHECKING
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
        diagnostics: warnings, and the description's messages through ``xacro.message`` and the like.
        inputs: its inputs, or None.
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
        """The provenance of an element of the document: `origin`, its parameters, and each attribute's provenance.

        This expands the file again, so it needs the files unchanged.

        Raises:
            LinkwrightError: XAC802 if the files have changed, or the element is not one of the document's.
        """
        if self.inputs is None:
            raise LinkwrightError(Diagnostic("XAC802", phrase("the document has no record of its expansion")))
        from linkwright.xacro.tracing.provenance import provenance_of

        return provenance_of(self.inputs, self.document.root, element)
