"""Expand a description as a virtual document, with navigation to and from it.

The URI of the document is ``linkwright-expansion:///PATH?NAME:=VALUE...`` with the path of the description. Its content
is the response to ``workspace/textDocumentContent`` (protocol 3.18). The implementations of an element in a description
are the elements to which it expands. The definition of an element in the virtual document is its source.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from urllib.parse import quote, unquote, urlsplit

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from linkwright.diagnostics import LinkwrightError
from linkwright.diagnostics.translation import localized
from linkwright.language.expanded import ExpandedText, expand_to_text
from linkwright.language.includes import real_path
from linkwright.language.workspace import Workspace
from linkwright.lint.targets import DESCRIPTION_SUFFIXES
from linkwright.lsp.positions import UTF_16, TextPositions
from linkwright.lsp.server import LinkwrightServer, path_from_uri

SCHEME = "linkwright-expansion"


def is_expandable(file: Path) -> bool:
    """Return whether a file has the suffix of a description, which can be expanded."""
    return file.name.endswith(DESCRIPTION_SUFFIXES)


def expansion_uri(entry: Path, arguments: Mapping[str, str]) -> str:
    """Return the URI of the expansion of a description."""
    query = "&".join(quote(f"{name}:={value}", safe=":=/") for name, value in arguments.items())
    uri = entry.as_uri().replace("file:", f"{SCHEME}:", 1)
    return f"{uri}?{query}" if query else uri


def parse_expansion_uri(uri: str) -> tuple[Path, dict[str, str]] | None:
    """Return the description and arguments in an expansion's URI, or None for other URIs."""
    parts = urlsplit(uri)
    entry = path_from_uri(f"file://{parts.path}") if parts.scheme == SCHEME else None
    if entry is None:
        return None
    pairs = (unquote(pair).partition(":=") for pair in parts.query.split("&") if pair)
    return real_path(entry), {name: value for name, _, value in pairs}


def _expand_entries(
    workspace: Workspace, texts: Mapping[Path, str], file: Path
) -> Iterator[tuple[Path, Mapping[str, str], ExpandedText]]:
    """Yield one expansion of each description that includes a file.

    The expansion uses the first argument set without an error.
    """
    for entry in workspace.index.entries(file, texts):
        for arguments, _ in workspace.argument_calls(entry):
            try:
                yield entry, arguments, expand_to_text(workspace, texts, entry, arguments)
            except LinkwrightError:
                continue
            break


def find_implementations(
    workspace: Workspace, texts: Mapping[Path, str], file: Path, offset: int, encoding: types.PositionEncodingKind | str
) -> list[types.Location]:
    """Return the expansions of the element at an offset of a file.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        file: a description, or a file that descriptions include.
        offset: the character offset in its text.
        encoding: the encoding of the positions.
    """
    locations = []
    for entry, arguments, expansion in _expand_entries(workspace, texts, file):
        positions = TextPositions(expansion.text, encoding)
        uri = expansion_uri(entry, arguments)
        locations += [
            types.Location(uri, positions.range(element.start, element.end))
            for element in expansion.elements_from(file, offset)
        ]
    return locations


def find_source_locations(server: LinkwrightServer, uri: str, position: types.Position) -> list[types.Location] | None:
    """Return the source of the element at a position in an expansion, or None for other URIs."""
    description = parse_expansion_uri(uri)
    if description is None or server.project is None:
        return None
    try:
        expansion = expand_to_text(server.project, server.texts(), *description)
    except LinkwrightError:  # The document still shows the text from before the error.
        return []
    encoding = server.workspace.position_encoding or UTF_16
    element = expansion.element_at(TextPositions(expansion.text, encoding).offset(position))
    source = None if element is None else server.positions(element.file)
    if element is None or source is None:
        return []
    return [types.Location(server.uri_of(element.file), source.range(element.source_start, element.source_end))]


async def expansion_content(server: LinkwrightServer, uri: str) -> str | None:
    """Return the text of an expansion, or None for the URI of another document.

    Raises:
        JsonRpcException: RequestFailed, the description cannot be expanded.
    """
    description, workspace, texts = parse_expansion_uri(uri), server.project, server.texts()
    if description is None or workspace is None:
        return None
    try:
        expansion = await server.run_in_check_thread(lambda: expand_to_text(workspace, texts, *description))
    except LinkwrightError as error:
        message = "\n".join(localized(diagnostic.message) for diagnostic in error.diagnostics)
        raise JsonRpcException(message, code=int(types.LSPErrorCodes.RequestFailed)) from None
    return expansion.text


def add_requests(server: LinkwrightServer) -> None:
    """Register the request handlers of this module."""

    @server.feature(types.TEXT_DOCUMENT_IMPLEMENTATION)
    async def implementation(
        server: LinkwrightServer, params: types.ImplementationParams
    ) -> list[types.Location] | None:
        path, positions = server.xml_text(params.text_document)
        workspace, texts = server.project, server.texts()
        if positions is None or workspace is None or not is_expandable(path) or not server.opens_virtual_documents:
            return None
        await server.when_indexed()
        offset, encoding = positions.offset(params.position), server.workspace.position_encoding or UTF_16
        return await server.run_in_check_thread(
            lambda: find_implementations(workspace, texts, real_path(path), offset, encoding)
        )
