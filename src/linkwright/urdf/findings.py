"""The diagnostics of one reading, collected in any order and returned in the order of the text."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.diagnostics import Diagnostic, Note, Phrase, Severity, phrase, term
from linkwright.schema.rules import Version
from linkwright.xmltree import Element


class Findings:
    """The findings of one reading, and whether they reject the robot.

    Attributes:
        version: the URDF version the file is read as.
        rejected: whether urdfdom would refuse the model.
        count: how many findings there are so far.
        error_count: how many of the findings so far are errors.
    """

    __slots__ = ("_found", "count", "error_count", "rejected", "version")

    def __init__(self, version: Version = (1, 0)) -> None:
        self.version = version
        self.rejected = False
        self.count = 0
        self.error_count = 0
        self._found: list[Diagnostic] = []

    def reject(
        self,
        code: str,
        message: Phrase,
        element: Element,
        attribute: str | None = None,
        *,
        hint: Phrase | None = None,
        notes: Sequence[Note] = (),
    ) -> None:
        """Report an error that leaves no robot."""
        self.rejected = True
        self._add(Severity.ERROR, code, message, element, attribute, hint, notes)

    def error(
        self,
        code: str,
        message: Phrase,
        element: Element,
        attribute: str | None = None,
        *,
        hint: Phrase | None = None,
        notes: Sequence[Note] = (),
    ) -> None:
        """Report an error in a part that urdfdom drops or misreads while it keeps the model."""
        self._add(Severity.ERROR, code, message, element, attribute, hint, notes)

    def warning(
        self,
        code: str,
        message: Phrase,
        element: Element,
        attribute: str | None = None,
        *,
        hint: Phrase | None = None,
        notes: Sequence[Note] = (),
    ) -> None:
        """Report something that is read without complaint and is hardly meant."""
        self._add(Severity.WARNING, code, message, element, attribute, hint, notes)

    def duplicate(self, kind: str, name: str, element: Element, first: Element | None) -> None:
        """Report a second element of one kind and name."""
        notes = (Note(phrase("first defined here"), first.span()),) if first else ()
        hint = phrase("give each {kind} a name of its own", kind=term(kind))
        self.reject(
            "URDF110",
            phrase("{kind} '{name}' is defined twice", kind=term(kind), name=name),
            element,
            "name",
            hint=hint,
            notes=notes,
        )

    def first_error(self) -> Diagnostic:
        """Return the first error; there is one."""
        return next(found for found in self._found if found.severity is Severity.ERROR)

    def annotate(self, finding: Diagnostic, note: Note) -> None:
        """Add a note to a finding, the latest one that is equal."""
        for index in range(len(self._found) - 1, -1, -1):
            if self._found[index] == finding:
                self._found[index] = finding.but(notes=(*finding.notes, note))
                return

    def in_order(self) -> tuple[Diagnostic, ...]:
        """Return all findings by place, and files in the order in which they first occurred."""
        files: dict[str, int] = {}

        def place(diagnostic: Diagnostic) -> tuple[int, int, int]:
            span = diagnostic.span
            if span is None:
                return len(files), 0, 0
            return files.setdefault(span.file, len(files)), span.line, span.column

        return tuple(sorted(self._found, key=place)) if len(self._found) > 1 else tuple(self._found)

    def _add(
        self,
        severity: Severity,
        code: str,
        message: Phrase,
        element: Element,
        attribute: str | None,
        hint: Phrase | None,
        notes: Sequence[Note],
    ) -> None:
        self.count += 1
        if severity is Severity.ERROR:
            self.error_count += 1
        span = element.attribute_span(attribute) if attribute else element.span()
        trail: tuple[Note, ...] = ()
        if element.origin is not None:
            from linkwright.xacro.origin import origin_of

            trail = origin_of(element).trail
        self._found.append(Diagnostic(code, message, span, severity, (*notes, *trail), hint, element.source))
