"""The inputs of an expansion."""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.xacro.limits import Limits
from linkwright.xacro.plan import plan_document
from linkwright.xacro.session import PackageSource, Session
from linkwright.xacro.tags.directives import xml_hint
from linkwright.xmltree import Document, Overlay, parse


class Inputs(NamedTuple):
    """The inputs of an expansion; see `linkwright.xacro.expand`."""

    name: str
    arguments: Mapping[str, str]
    packages: PackageSource = None
    text: str | None = None
    limits: Limits = Limits()
    root_dir: str = ""
    overlay: Overlay | None = None

    def session(self) -> Session:
        """Return a session in its initial state."""
        return Session(self.name, self.arguments, self.packages, self.limits, self.root_dir, self.overlay)


def main_document(session: Session, text: str | None = None) -> Document:
    """Return the document of a session's file, or of a text that replaces it.

    Raises:
        LinkwrightError: if it cannot be read, or is not XML.
    """
    try:
        document = session.read(session.file) if text is None else parse(text, session.file)
    except LinkwrightError as error:
        first = error.diagnostics[0]
        hint = xml_hint(first)
        if hint == first.hint:
            raise
        raise LinkwrightError(
            Diagnostic(first.code, first.message, first.span, notes=first.notes, hint=hint, source=first.source)
        ) from None
    plan_document(document)
    return document
