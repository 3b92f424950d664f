"""Expanding a file: the way into this room."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, NamedTuple

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.xacro.calls import call_macro
from linkwright.xacro.directives import DIRECTIVES
from linkwright.xacro.expander import Expander
from linkwright.xacro.includes import xml_hint
from linkwright.xacro.limits import Limits, room_for
from linkwright.xacro.origin import Origin, origin_of
from linkwright.xacro.session import PackageSource, Session
from linkwright.xmltree import Comment, Document, Element, parse, write

if TYPE_CHECKING:
    from pathlib import Path

    from linkwright.xacro.story import Story


class Inputs(NamedTuple):
    """What an expansion starts from; see `expand`."""

    name: str
    arguments: Mapping[str, str]
    packages: PackageSource = None
    text: str | None = None
    limits: Limits = Limits()
    root_dir: str = ""

    def session(self) -> Session:
        """A session in its initial state."""
        return Session(self.name, self.arguments, self.packages, self.limits, self.root_dir)


class Expansion:
    """What comes out of a file.

    Attributes:
        document: the expanded document. Every element has the source and offset where it was written.
        arguments: name -> final value of every argument that was given or declared.
        diagnostics: warnings, and what the description says through ``xacro.message`` and its like.
        inputs: what it started from, or None.
    """

    def __init__(
        self,
        document: Document,
        dependencies: Iterable[str | Path],
        arguments: dict[str, str],
        diagnostics: tuple[Diagnostic, ...],
        inputs: Inputs | None = None,
    ) -> None:
        self.document = document
        self._dependencies = tuple(dependencies)
        self.arguments = arguments
        self.diagnostics = diagnostics
        self.inputs = inputs
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

    def story(self, element: Element) -> Story:
        """All there is to say of an element of the document: `origin`, its parameters, and each attribute's story.

        The file is expanded once more for it, so it is told as long as the files are what they were.

        Raises:
            LinkwrightError: XAC802 when they no longer are, or the element is not one of the document's.
        """
        from linkwright.xacro.story import story_of

        return story_of(self, element)


def expand(
    path: str | Path,
    arguments: Mapping[str, str] | None = None,
    *,
    packages: PackageSource = None,
    text: str | None = None,
    limits: Limits | None = None,
    root_dir: str | Path | None = None,
) -> Expansion:
    """Expand a xacro file, as ros/xacro 2.1 does; a plain URDF file comes out as it is.

    Args:
        path: the file; relative paths in it are relative to its folder, and it is named in the banner as given here.
        arguments: name -> value of the arguments (``name:=value``); they win over the defaults in the file.
        packages: where ``$(find name)`` looks: an object with ``share(name)``, such as a `PackageFinder`, or a mapping
            from package to share folder that is looked at before the surroundings of the file.
        text: the text to take for that of the file, such as one that is not saved yet.
        limits: bounds for the expansion.
        root_dir: the folder that relative paths, `path` among them, are in; the current one if None.

    Raises:
        LinkwrightError: what is wrong, each mistake with its place, the macro calls and includes that led there, and
            a hint.
    """
    inputs = Inputs(str(path), arguments or {}, packages, text, limits or Limits(), str(root_dir or ""))
    session = inputs.session()
    document = main_document(session, text)
    with room_for(session.limits):
        expanded = Expander(session, DIRECTIVES, call_macro).document(document)
    session.warn_of_unused_arguments()
    session.close()
    expanded.prolog[:0] = banner(inputs.name)
    expanded.doctype_index += len(_BANNER)
    return Expansion(expanded, session.dependencies, session.arguments, tuple(session.diagnostics), inputs)


def main_document(session: Session, text: str | None = None) -> Document:
    """The document that a session begins with: that of its file, or of a text that stands for it.

    Raises:
        LinkwrightError: it cannot be read, or is not XML.
    """
    try:
        return session.read(session.file) if text is None else parse(text, session.file)
    except LinkwrightError as error:
        found = error.diagnostics[0]
        hint = xml_hint(found)
        if hint == found.hint:
            raise
        raise LinkwrightError(
            Diagnostic(found.code, found.message, found.span, notes=found.notes, hint=hint, source=found.source)
        ) from None


_RULE = " =================================================================================== "
_BANNER = (
    _RULE,
    " |    This document was autogenerated by xacro from {:<30} | ",
    " |    EDITING THIS FILE BY HAND IS NOT RECOMMENDED  {:<30} | ",
    _RULE,
)


def banner(name: str) -> list[Comment]:
    """The comments that say from which file a text was made."""
    shown = re.sub("-+", "-", name)  # XML allows no two dashes in a comment
    return [
        Comment(_BANNER[0]),
        Comment(_BANNER[1].format(shown)),
        Comment(_BANNER[2].format("")),
        Comment(_BANNER[3]),
    ]
