"""The diagnostics of one reading: collected as they come, handed out in the order of the text."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from linkwright.diagnostics import Diagnostic, Note, Severity
from linkwright.urdf.schema import Version
from linkwright.xmltree import Element


class Findings:
    """What is wrong with a description, and whether it is so wrong that there is no robot.

    Attributes:
        version: the URDF version the file is read as.
        rejected: whether urdfdom would refuse the model.
        error_count: how many of the findings so far are errors.
    """

    __slots__ = ("_found", "error_count", "rejected", "version")

    def __init__(self) -> None:
        self.version: Version = (1, 0)
        self.rejected = False
        self.error_count = 0
        self._found: list[Diagnostic] = []

    def __len__(self) -> int:
        return len(self._found)

    def reject(
        self,
        code: str,
        message: str,
        element: Element,
        attribute: str | None = None,
        *,
        hint: str | None = None,
        notes: Sequence[Note] = (),
    ) -> None:
        """Report an error that leaves no robot."""
        self.rejected = True
        self._add(Severity.ERROR, code, message, element, attribute, hint, notes)

    def error(
        self,
        code: str,
        message: str,
        element: Element,
        attribute: str | None = None,
        *,
        hint: str | None = None,
        notes: Sequence[Note] = (),
    ) -> None:
        """Report an error in a part that urdfdom drops or misreads while it keeps the model."""
        self._add(Severity.ERROR, code, message, element, attribute, hint, notes)

    def warning(
        self,
        code: str,
        message: str,
        element: Element,
        attribute: str | None = None,
        *,
        hint: str | None = None,
        notes: Sequence[Note] = (),
    ) -> None:
        """Report something that is read without complaint and is hardly meant."""
        self._add(Severity.WARNING, code, message, element, attribute, hint, notes)

    def duplicate(self, kind: str, name: str, element: Element, first: Element | None) -> None:
        """Report a second element of one kind and name."""
        notes = (Note("first defined here", first.span()),) if first else ()
        hint = f"give each {kind} a name of its own"
        self.reject("URDF110", f"{kind} '{name}' is defined twice", element, "name", hint=hint, notes=notes)

    def annotate(self, since: int, note: Note) -> None:
        """Add a note to the first error after the first `since` findings."""
        for index in range(since, len(self._found)):
            found = self._found[index]
            if found.severity is Severity.ERROR:
                self._found[index] = replace(found, notes=(*found.notes, note))
                return

    def in_order(self) -> tuple[Diagnostic, ...]:
        """All of them by place; files in the order in which they were first met."""
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
        message: str,
        element: Element,
        attribute: str | None,
        hint: str | None,
        notes: Sequence[Note],
    ) -> None:
        if severity is Severity.ERROR:
            self.error_count += 1
        span = element.attribute_span(attribute) if attribute else element.span()
        trail: tuple[Note, ...] = ()
        if element.origin is not None:
            from linkwright.xacro.origin import origin_of

            trail = origin_of(element).trail
        self._found.append(Diagnostic(code, message, span, severity, (*notes, *trail), hint, element.source))
