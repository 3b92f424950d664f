"""Expand a file to a document, and record its arguments, dependencies and diagnostics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.diagnostics.diagnostic import TEXT_NAME, is_text
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.xacro.expander import Expander
from linkwright.xacro.faults import Origin, origin_of
from linkwright.xacro.limits import Limits, recursion_limit_for
from linkwright.xacro.session import Inputs, PackageSource, read_main_document
from linkwright.xacro.tags.directives import DIRECTIVES
from linkwright.xacro.tags.macro_calls import call_macro
from linkwright.xmltree import Comment, Document, Element, Overlay, write

if TYPE_CHECKING:
    from pathlib import Path

    from linkwright.xacro.tracing.provenance import Provenance


class Expansion:
    """The result of expanding a file.

    Attributes:
        document: the expanded document. Every element has the source and the offset at which it was written.
        arguments: the final value of every argument that was passed or declared, by name.
        diagnostics: warnings, and the messages that the description shows with ``xacro.message`` and similar functions.
        inputs: the inputs of the expansion, or None if they were not recorded.
        problems: the errors of the parts that were left out; see `linkwright.xacro.parts`.
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
        """The paths of the files that were read, starting with the main file."""
        from pathlib import Path  # imported here because the import of pathlib is slow

        return tuple(Path(file) for file in self._dependencies)

    def __str__(self) -> str:
        """Return the expanded document as text, exactly as ros/xacro writes it."""
        if self._text is None:
            self._text = write(self.document)
        return self._text

    def origin(self, element: Element) -> Origin:
        """Return the location of an element, and the calls and includes that produced it."""
        return origin_of(element)

    def provenance(self, element: Element) -> Provenance:
        """Return the provenance of an element of the document.

        The provenance contains the `origin`, its parameters, and the provenance of each attribute.

        The file is expanded again, so the files must be unchanged.

        Raises:
            LinkwrightError: XAC802 if the files have changed, or if the element does not belong to the document.
        """
        if self.inputs is None:
            raise LinkwrightError(
                Diagnostic("XAC802", phrase("the inputs of the expansion are not available, so it has no provenance"))
            )
        from linkwright.xacro.tracing.provenance import provenance_of

        return provenance_of(self.inputs, self.document.root, element)


def expand(
    path_or_text: str | Path,
    arguments: Mapping[str, str] | None = None,
    *,
    packages: PackageSource = None,
    text: str | None = None,
    limits: Limits | None = None,
    root_dir: str | Path | None = None,
    overlay: Overlay | None = None,
) -> Expansion:
    """Expand a xacro file as ros/xacro 2.1 does.

    A plain URDF file is returned unchanged.

    Args:
        path_or_text: the path of a file, or a text, which is recognized by its ``<``. Relative paths are resolved in
            the folder of the file or, for a text, in `root_dir`. The banner contains the path unchanged.
        arguments: the values of arguments (``name:=value``), by name. They take precedence over the defaults in the
            file.
        packages: the packages for ``$(find name)``: an object with ``share(name)``, such as a `PackageFinder`, or a
            mapping from package to share folder that takes precedence over the surroundings of the file.
        text: the text to expand instead of the text of the file, such as unsaved changes in an editor.
        limits: the limits of the expansion.
        root_dir: the base of relative paths, or None for the current folder.
        overlay: texts that replace the contents of files, including included files and YAML files.

    Raises:
        LinkwrightError: the errors of the description, each with its location, its macro calls and includes, and a
            hint.
    """
    name = str(path_or_text)
    if text is None and is_text(path_or_text):
        name, text = TEXT_NAME, name
    inputs = Inputs(name, arguments or {}, packages, text, limits or Limits(), str(root_dir or ""), overlay)
    session = inputs.create_session()
    document = read_main_document(session, text)
    with recursion_limit_for(session.limits):
        expanded_document = Expander(session, DIRECTIVES, call_macro).expand_document(document)
    session.warn_of_unused_arguments()
    session.close()
    expanded_document.prolog[:0] = make_banner(inputs.name)
    expanded_document.doctype_index += len(_BANNER)
    return Expansion(expanded_document, session.dependencies, session.arguments, tuple(session.diagnostics), inputs)


_RULE = " =================================================================================== "
_BANNER = (
    _RULE,
    " |    This document was autogenerated by xacro from {:<30} | ",
    " |    EDITING THIS FILE BY HAND IS NOT RECOMMENDED  {:<30} | ",
    _RULE,
)


def make_banner(name: str) -> list[Comment]:
    """Return the comments that begin an expanded text and name its source file."""
    displayed_name = name
    while "--" in displayed_name:  # XML does not allow two dashes in a comment
        displayed_name = displayed_name.replace("--", "-")
    return [
        Comment(_BANNER[0]),
        Comment(_BANNER[1].format(displayed_name)),
        Comment(_BANNER[2].format("")),
        Comment(_BANNER[3]),
    ]
