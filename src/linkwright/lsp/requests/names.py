"""Requests about names: completion, hover and definition."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from lsprotocol import types

from linkwright.diagnostics import Phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.completion import Completion, ItemKind
from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.format import Document, NotYetKnownError, Target
from linkwright.language.formats import format_of
from linkwright.language.hover import definitions_at
from linkwright.language.hover_facts import facts_at
from linkwright.language.includes import real
from linkwright.language.links import file_references
from linkwright.language.renaming import occurrence_at, references
from linkwright.language.suppressing import code_at
from linkwright.language.values import ValuedText, described_values, value_at
from linkwright.language.xml_completion import complete
from linkwright.language.xml_hover import explain_at
from linkwright.lint.explain import find_page
from linkwright.lsp.positions import TextOf, TextPositions
from linkwright.lsp.requests.expansions import source_of
from linkwright.lsp.server import FormattedText, LinkwrightServer, path_of

_KINDS = {
    ItemKind.ELEMENT: types.CompletionItemKind.Class,
    ItemKind.ATTRIBUTE: types.CompletionItemKind.Property,
    ItemKind.VALUE: types.CompletionItemKind.EnumMember,
    ItemKind.MACRO: types.CompletionItemKind.Function,
    ItemKind.PROPERTY: types.CompletionItemKind.Variable,
    ItemKind.FUNCTION: types.CompletionItemKind.Function,
    ItemKind.NAME: types.CompletionItemKind.Reference,
    ItemKind.PACKAGE: types.CompletionItemKind.Module,
    ItemKind.FILE: types.CompletionItemKind.File,
    ItemKind.FOLDER: types.CompletionItemKind.Folder,
}


def completions_at(document: Document, offset: int, names: Sequence[NameDefinition]) -> list[Completion]:
    """Return the completions at an offset, by the format of the file.

    Args:
        document: the text.
        offset: the character offset of the cursor.
        names: the names that the description of the file defines, if it is one.

    Raises:
        NotYetKnownError: they need results that no request has found, and the document does not wait.
    """
    own = format_of(document.file)
    return complete(document, offset, names) if own is None else [*own.complete(document, offset)]


def items(
    found: Iterable[Completion], positions: TextPositions, place: types.Position, *, takes_snippets: bool
) -> list[types.CompletionItem]:
    """Convert completions to the protocol, with sort texts that keep their order."""
    offset = positions.offset(place)
    listed = [_item(item, positions, offset, takes_snippets=takes_snippets) for item in found]
    for number, item in enumerate(listed):
        item.sort_text = f"{number:05}"
    return listed


def _item(item: Completion, positions: TextPositions, offset: int, *, takes_snippets: bool) -> types.CompletionItem:
    is_snippet = bool(item.snippet) and takes_snippets
    opens = item.snippet.startswith("<")
    plain = f"<{item.label}" if opens else item.label
    edit = types.TextEdit(positions.range(item.start, offset), item.snippet if is_snippet else plain)
    return types.CompletionItem(
        item.label,
        kind=_KINDS[item.kind],
        detail=item.detail or None,
        documentation=_markdown(item.description) if item.description else None,
        insert_text_format=types.InsertTextFormat.Snippet if is_snippet else types.InsertTextFormat.PlainText,
        # Without this text, Neovim offers the item regardless of the typed text.
        filter_text=f"<{item.label}" if opens else item.label,
        text_edit=edit,
    )


def hover(
    document: Document,
    names: Sequence[NameDefinition],
    values: Sequence[ValuedText],
    facts: Iterable[str],
    positions: TextPositions,
    place: types.Position,
) -> types.Hover | None:
    """Return the hover at a position, or None if nothing is known.

    Args:
        document: the file.
        names: the names that the description defines.
        values: the values of the expressions in the file.
        facts: the facts about the link, joint, mesh or package at the position.
        positions: the text of the file.
        place: the position.
    """
    offset = positions.offset(place)
    found, valued = explain_at(document, offset, names), value_at(values, offset)
    parts = [] if found is None else [localized(found.text)]
    span = None if found is None else (found.start, found.end)
    if valued is not None:
        parts.append(described_values(valued, positions.text[valued.start : valued.end]))
        span = valued.start, valued.end
    parts += facts
    if not parts:
        return None
    return types.Hover(_markdown("\n\n".join(parts)), None if span is None else positions.range(*span))


def suppression_hover(server: LinkwrightServer, asked: types.HoverParams) -> types.Hover | None:
    """Return the page of the rule in the suppression comment at a position, or None."""
    path = path_of(asked.text_document.uri)
    positions = None if path is None else server.positions(path)
    suppressed = None if positions is None else code_at(positions.text, positions.offset(asked.position))
    page = None if suppressed is None else find_page(suppressed[0])
    if positions is None or suppressed is None or page is None:
        return None
    code, start = suppressed
    return types.Hover(_markdown(page.markdown), positions.range(start, start + len(code)))


def definitions(
    names: Sequence[NameDefinition],
    positions: TextPositions,
    place: types.Position,
    text_of: TextOf,
    uri: Callable[[Path], str],
) -> list[types.Location]:
    """Return the definitions of the name at a position."""
    found = definitions_at(positions.text, positions.offset(place), names)
    return [*_locations(found, text_of, uri)]


async def parameter_definitions(
    server: LinkwrightServer, path: Path, positions: TextPositions, place: types.Position
) -> list[types.Location]:
    """Return the declaration of the macro parameter at a position, or an empty list."""
    project, texts = server.project, server.texts()
    name = occurrence_at(positions.text, real(path), positions.offset(place))
    if project is None or name is None or name.kind is not NameKind.PARAMETER:
        return []
    await server.when_indexed()
    uses = await server.in_thread(lambda: references(project, texts, name))
    declared = (Target(use.file, use.start, use.end) for use in uses if use.is_definition)
    return [*target_locations(declared, server.positions, server.uri_of)]


def _locations(
    names: Iterable[NameDefinition], text_of: TextOf, uri: Callable[[Path], str]
) -> Iterable[types.Location]:
    for name in names:
        own = text_of(name.file)
        if own is not None:
            yield types.Location(uri(name.file), own.range(name.start, name.start + len(name.name)))


def explained(own: FormattedText, place: types.Position) -> types.Hover | None:
    """Return the hover of a format at a position, or None if nothing is known."""
    found = own.format.explain(own.document, own.positions.offset(place))
    return None if found is None else types.Hover(_markdown(found.text), own.positions.range(found.start, found.end))


def targets_at(own: FormattedText, place: types.Position) -> list[Target]:
    """Return the definitions that a format finds for the name at a position."""
    return [*own.format.define(own.document, own.positions.offset(place))]


def target_locations(
    targets: Iterable[Target], text_of: TextOf, uri: Callable[[Path], str]
) -> Iterable[types.Location]:
    """Convert targets to locations of the protocol."""
    for target in targets:
        text = text_of(target.file)
        start = types.Position(0, 0)
        place = types.Range(start, start) if text is None else text.range(target.start, target.end)
        yield types.Location(uri(target.file), place)


def _markdown(text: str | Phrase) -> types.MarkupContent:
    return types.MarkupContent(types.MarkupKind.Markdown, localized(text))


def add_requests(server: LinkwrightServer) -> None:
    """Register the request handlers of this module."""

    @server.feature(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(["<", " ", '"', "'", "/", "{", "(", ":"]))
    async def completion_request(
        server: LinkwrightServer, asked: types.CompletionParams
    ) -> list[types.CompletionItem] | None:
        capabilities = server.client_capabilities.text_document
        item = capabilities.completion.completion_item if capabilities and capabilities.completion else None
        takes_snippets = bool(item and item.snippet_support)
        path, positions = server.readable(asked.text_document)
        if positions is None or server.project is None:
            return None
        await server.when_prepared(path)
        known = await server.names(path) if format_of(path) is None else []
        server.check_unchanged(path, positions)
        document = Document(server.project, server.texts(), real(path), positions.text, waits=False)
        offset = positions.offset(asked.position)
        try:
            found = completions_at(document, offset, known)
        except NotYetKnownError:
            waiting = replace(document, waits=True)
            found = await server.in_thread(lambda: completions_at(waiting, offset, known))
            server.check_unchanged(path, positions)
        if document.refreshes:
            server.in_background(document.refreshes, document.file)
        return items(found, positions, asked.position, takes_snippets=takes_snippets)

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    async def hover_request(server: LinkwrightServer, asked: types.HoverParams) -> types.Hover | None:
        suppressed = suppression_hover(server, asked)
        if suppressed is not None:
            return suppressed
        own = await server.formatted(asked.text_document)
        if own is not None:
            return await server.in_thread(lambda: explained(own, asked.position))
        path, positions = server.text(asked.text_document)
        project, texts = server.project, server.texts()
        if positions is None or project is None:
            return None
        known, values = await server.names(path), await server.values(path)
        text, offset = positions.text, positions.offset(asked.position)
        facts = await server.in_thread(lambda: facts_at(project, texts, real(path), text, offset, values))
        server.check_unchanged(path, positions)
        document = Document(project, texts, real(path), text)
        return hover(document, known, values, facts, positions, asked.position)

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    async def definition_request(
        server: LinkwrightServer, asked: types.DefinitionParams
    ) -> list[types.Location] | None:
        own = await server.formatted(asked.text_document)
        if own is not None:
            targets = await server.in_thread(lambda: targets_at(own, asked.position))
            return [*target_locations(targets, server.positions, server.uri_of)]
        source = await server.in_thread(lambda: source_of(server, asked.text_document.uri, asked.position))
        path, positions = server.text(asked.text_document)
        if positions is None or server.project is None:
            return source
        known, values = await server.names(path), await server.values(path)
        server.check_unchanged(path, positions)
        found = await parameter_definitions(server, path, positions, asked.position) or definitions(
            known, positions, asked.position, server.positions, server.uri_of
        )
        offset, finder = positions.offset(asked.position), server.project.finder(real(path))
        links = () if found else file_references(positions.text, path, finder, values)
        top = types.Range(types.Position(0, 0), types.Position(0, 0))
        found += [
            types.Location(server.uri_of(link.file), top)
            for link in links
            if link.start <= offset <= link.end and link.file.is_file()
        ]
        return found
