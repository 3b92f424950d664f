"""Expand files, strings and documents, as in the module ``xacro``."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import IO, Any
from xml.dom import minidom

from linkwright.descriptions import Description
from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, print_diagnostics
from linkwright.hosting.xacro_calls import XacroCall, current_descriptions
from linkwright.standins.xacro_api import dom
from linkwright.standins.xacro_api.command_line import process_args
from linkwright.standins.xacro_api.errors import XacroException, translate_error
from linkwright.standins.xacro_api.stacks import STATE, StackExpander, StackSession, init_stacks
from linkwright.xacro.expansion import Expansion, make_banner
from linkwright.xacro.limits import recursion_limit_for
from linkwright.xacro.session import Inputs
from linkwright.xmltree import Document
from linkwright.xmltree import parse as parse_text

_TEXT_PATH = os.path.join(os.curdir, "string")  # noqa: PTH118 - relative paths in a text begin with './', as in xacro
_FAILURE_STATUS = 2


class XacroDocument(minidom.Document):
    """A document that records the call and the result of its expansion.

    With these records, a running launch can map the URDF to locations in the sources, and reload a changed file.

    Attributes:
        call: the file and the arguments; None for a description given as a string.
        expansion: the result of the expansion; None before it.
    """

    call: XacroCall | None = None
    expansion: Expansion | None = None

    def toprettyxml(self, *arguments: Any, **keywords: Any) -> Any:
        """Serialize the document. See ``xml.dom.minidom``."""
        text = super().toprettyxml(*arguments, **keywords)
        descriptions, expansion = current_descriptions(), self.expansion
        if descriptions is None or self.call is None or expansion is None or not isinstance(text, str):
            return text
        if dom.is_same(self, expansion.document):
            descriptions.store(self.call, Description.of_expansion(str(self.call.path), expansion), text)
        return text


def parse(inp: Any, filename: str | Path | None = None) -> minidom.Document:
    """Parse a description into a document, without expanding it.

    Args:
        inp: the description as a string or an open file; None to open `filename`. A document is returned unchanged.
        filename: the file to open, or a name for the string in messages.

    Raises:
        xml.parsers.expat.ExpatError: the description is not XML.
        XacroException: the file cannot be read.
        TypeError: `inp` is not readable.
    """
    if isinstance(inp, minidom.Document):
        return inp
    if isinstance(inp, Path):
        inp, filename = None, inp
    path: Path | None = None
    if inp is None:
        if filename is None:
            raise TypeError("expected a file or its name")
        path = Path(STATE.root_dir, filename)
    elif hasattr(inp, "read"):
        name = filename or getattr(inp, "name", None)
        path = Path(name) if isinstance(name, (str, Path)) else None
    elif not isinstance(inp, (str, bytes)):
        raise TypeError(f"expected a file or its path, got {inp!r} of type {type(inp).__name__}")
    call = None if path is None else XacroCall(Path.cwd() / path)
    try:
        tree = _parse_tree(inp, path, filename)
    except LinkwrightError as error:
        raise translate_error(error, call) from None
    document = XacroDocument()
    dom.fill_document(document, tree)
    document.call = call
    return document


def process_doc(doc: minidom.Document, mappings: Mapping[str, Any] | None = None, **options: Any) -> None:
    """Expand a document in place.

    Args:
        doc: the document to expand.
        mappings: the values of arguments by name, which are not modified.
        options: `verbosity`; other options are ignored.

    Raises:
        XacroException: there is an error in the description.
        xml.parsers.expat.ExpatError: an included file is not XML.
    """
    STATE.verbosity = options.get("verbosity", STATE.verbosity)
    if not STATE.filestack:
        init_stacks(None)
    call = doc.call if isinstance(doc, XacroDocument) else None
    if call is not None:
        call = XacroCall(call.path, _to_argument_texts(mappings))
    file = STATE.filestack[-1] if STATE.filestack else None
    expansion = _expand(dom.read_document(doc), file, mappings, call)
    dom.fill_document(doc, expansion.document)
    if isinstance(doc, XacroDocument):
        doc.call, doc.expansion = call, expansion


def process_file(
    input_file_name: str | Path, *, mappings: Mapping[str, Any] | None = None, **options: Any
) -> minidom.Document:
    """Expand a file into a document.

    Args:
        input_file_name: the path of the file.
        mappings: the values of arguments by name, which are not modified.
        options: `verbosity`; other options are ignored.

    Returns:
        The document, preceded by comments that name the file.

    Raises:
        XacroException: there is an error in the description.
        xml.parsers.expat.ExpatError: the file, or an included file, is not XML.
    """
    STATE.verbosity = options.get("verbosity", STATE.verbosity)
    init_stacks(input_file_name)
    name = os.fspath(input_file_name)
    call = XacroCall(Path.cwd() / STATE.root_dir / name, _to_argument_texts(mappings))
    try:
        tree = _parse_tree(None, Path(STATE.root_dir, name), None)
    except LinkwrightError as error:
        raise translate_error(error, call) from None
    expansion = _expand(tree, name, mappings, call)
    expansion.document.prolog[:0] = comments = make_banner(name)
    expansion.document.doctype_index += len(comments)
    document = XacroDocument()
    dom.fill_document(document, expansion.document)
    document.call, document.expansion = call, expansion
    return document


def process(
    input_file_name: str | Path,
    just_deps: bool = False,
    xacro_ns: bool = True,  # noqa: ARG001 - accepted for compatibility
    verbosity: int = 1,
    mappings: Mapping[str, Any] | None = None,
) -> str:
    """Expand a file to a string, or list the files that it includes. See `process_file`.

    Args:
        input_file_name: the path of the file.
        just_deps: whether to return the names of included files instead of the description.
        xacro_ns: ignored.
        verbosity: the amount of output, from 0 to 4.
        mappings: the values of arguments by name.
    """
    document = process_file(input_file_name, mappings=mappings, verbosity=verbosity)
    return _format_output(document, just_deps=just_deps)


def open_output(output_filename: str | Path | None) -> IO[str]:
    """Open a file for writing, and create its folder if necessary.

    For None, return standard output.

    Raises:
        XacroException: the file cannot be opened.
    """
    if output_filename is None:
        return sys.stdout
    path = Path(output_filename)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        return path.open("w", encoding="utf-8")
    except OSError as error:
        raise XacroException(f"cannot write '{path}':", exc=error) from error


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command ``xacro``, and exit on errors."""
    options, file = process_args(sys.argv[1:] if arguments is None else list(arguments))
    assert file is not None, "the options say that a file is needed"
    if options.root_dir:
        STATE.root_dir = options.root_dir
    try:
        document = process_file(file, mappings=options.mappings, verbosity=options.verbosity)
        output_file = open_output(options.output)
    except LinkwrightError as error:
        print_diagnostics(error.diagnostics, sys.stderr)
        sys.exit(_FAILURE_STATUS)
    output_file.write(_format_output(document, just_deps=options.just_deps))
    if options.output:
        output_file.close()


def _format_output(document: minidom.Document, *, just_deps: bool) -> str:
    if just_deps and isinstance(document, XacroDocument) and document.expansion is not None:
        return " ".join(map(str, document.expansion.dependencies[1:]))
    text: str = document.toprettyxml(indent="  ")
    return text


def _parse_tree(inp: Any, path: Path | None, filename: str | Path | None) -> Document:
    from linkwright.xmltree import parse_file

    if inp is None:
        assert path is not None, "there is a text or a file"
        return parse_file(path)
    if hasattr(inp, "read"):
        inp = inp.read()
    text = inp if isinstance(inp, str) else _decode_text(inp, str(path or filename or _TEXT_PATH))
    return parse_text(text, str(path or filename or "<string>"))


def _decode_text(data: bytes, name: str) -> str:
    from linkwright.xmltree.decoding import decode

    return decode(io.BytesIO(data).getvalue(), name)


def _to_argument_texts(mappings: Mapping[str, Any] | None) -> tuple[tuple[str, str], ...]:
    return tuple((name, str(value)) for name, value in (mappings or {}).items())


def _expand(tree: Document, file: str | None, mappings: Mapping[str, Any] | None, call: XacroCall | None) -> Expansion:
    """Expand a tree, and print its diagnostics unless a running launch reports them."""
    descriptions = current_descriptions()
    packages = descriptions.finder if descriptions is not None else None
    root = "" if str(STATE.root_dir) == os.curdir else str(STATE.root_dir)
    inputs = Inputs(_TEXT_PATH if file is None else file, dict(_to_argument_texts(mappings)), packages, root_dir=root)
    session = StackSession(inputs)
    STATE.arguments = session.arguments
    if descriptions is not None and call is not None:
        descriptions.record_read_time(call)
    try:
        with recursion_limit_for(inputs.limits):
            document = StackExpander(session, session.directives, session.call).expand_document(tree)
    except LinkwrightError as error:
        session.restore_stacks()
        _print_diagnostics(session.diagnostics)
        raise translate_error(error, call) from None
    finally:
        STATE.arguments = {}
    session.warn_of_unused_arguments()
    if descriptions is None or call is None:
        _print_diagnostics(session.diagnostics)
    files = tuple(Path(name) for name in session.dependencies if name != _TEXT_PATH)
    return Expansion(document, files, session.arguments, tuple(session.diagnostics))


def _print_diagnostics(diagnostics: Sequence[Diagnostic]) -> None:
    is_quiet = STATE.verbosity <= 0
    printed_diagnostics = [
        diagnostic
        for diagnostic in diagnostics
        if not is_quiet or diagnostic.severity is Severity.ERROR or _is_description_message(diagnostic)
    ]
    print_diagnostics(printed_diagnostics, sys.stderr)


def _is_description_message(diagnostic: Diagnostic) -> bool:
    """Return whether a diagnostic is a message from the description itself.

    An example is ``xacro.message``.
    """
    return diagnostic.code.startswith("XAC7")
