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
from linkwright.language.includes import real_path
from linkwright.language.links import file_references
from linkwright.language.renaming import find_references, occurrence_at
from linkwright.language.suppressions import find_code_at
from linkwright.language.values import EvaluatedText, describe_values, find_value_at
from linkwright.language.xml_completion import complete
from linkwright.language.xml_hover import explain_at
from linkwright.lint.explain import find_page
from linkwright.lsp.positions import PositionsOf, TextPositions
from linkwright.lsp.requests.expansions import find_source_locations
from linkwright.lsp.server import FormatContext, LinkwrightServer, path_from_uri

_COMPLETION_KINDS = {
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
    format_ = format_of(document.file)
    return complete(document, offset, names) if format_ is None else [*format_.complete(document, offset)]


def completion_items(
    completions: Iterable[Completion], positions: TextPositions, position: types.Position, *, supports_snippets: bool
) -> list[types.CompletionItem]:
    """Convert completions to the protocol, with sort texts that keep their order."""
    offset = positions.offset(position)
    converted = [_completion_item(item, positions, offset, supports_snippets=supports_snippets) for item in completions]
    for index, item in enumerate(converted):
        item.sort_text = f"{index:05}"
    return converted


def _completion_item(
    item: Completion, positions: TextPositions, offset: int, *, supports_snippets: bool
) -> types.CompletionItem:
    is_snippet = bool(item.snippet) and supports_snippets
    opens_tag = item.snippet.startswith("<")
    plain = f"<{item.label}" if opens_tag else item.label
    edit = types.TextEdit(positions.range(item.start, offset), item.snippet if is_snippet else plain)
    return types.CompletionItem(
        item.label,
        kind=_COMPLETION_KINDS[item.kind],
        detail=item.detail or None,
        documentation=_to_markdown(item.description) if item.description else None,
        insert_text_format=types.InsertTextFormat.Snippet if is_snippet else types.InsertTextFormat.PlainText,
        # Without this text, Neovim offers the item regardless of the typed text.
        filter_text=f"<{item.label}" if opens_tag else item.label,
        text_edit=edit,
    )


def hover(
    document: Document,
    names: Sequence[NameDefinition],
    values: Sequence[EvaluatedText],
    facts: Iterable[str],
    positions: TextPositions,
    position: types.Position,
) -> types.Hover | None:
    """Return the hover at a position, or None if nothing is known.

    Args:
        document: the file.
        names: the names that the description defines.
        values: the values of the expressions in the file.
        facts: the facts about the link, joint, mesh or package at the position.
        positions: the text of the file.
        position: the position of the mouse or cursor.
    """
    offset = positions.offset(position)
    explanation, evaluated_text = explain_at(document, offset, names), find_value_at(values, offset)
    parts = [] if explanation is None else [localized(explanation.text)]
    span = None if explanation is None else (explanation.start, explanation.end)
    if evaluated_text is not None:
        parts.append(describe_values(evaluated_text, positions.text[evaluated_text.start : evaluated_text.end]))
        span = evaluated_text.start, evaluated_text.end
    parts += facts
    if not parts:
        return None
    return types.Hover(_to_markdown("\n\n".join(parts)), None if span is None else positions.range(*span))


def suppression_hover(server: LinkwrightServer, params: types.HoverParams) -> types.Hover | None:
    """Return the page of the rule in the suppression comment at a position, or None."""
    path = path_from_uri(params.text_document.uri)
    positions = None if path is None else server.positions(path)
    code_and_start = None if positions is None else find_code_at(positions.text, positions.offset(params.position))
    page = None if code_and_start is None else find_page(code_and_start[0])
    if positions is None or code_and_start is None or page is None:
        return None
    code, start = code_and_start
    return types.Hover(_to_markdown(page.markdown), positions.range(start, start + len(code)))


def definitions(
    names: Sequence[NameDefinition],
    positions: TextPositions,
    position: types.Position,
    positions_of: PositionsOf,
    uri_of: Callable[[Path], str],
) -> list[types.Location]:
    """Return the definitions of the name at a position."""
    matches = definitions_at(positions.text, positions.offset(position), names)
    return [*_to_locations(matches, positions_of, uri_of)]


async def parameter_definitions(
    server: LinkwrightServer, path: Path, positions: TextPositions, position: types.Position
) -> list[types.Location]:
    """Return the declaration of the macro parameter at a position, or an empty list."""
    workspace, texts = server.project, server.texts()
    name = occurrence_at(positions.text, real_path(path), positions.offset(position))
    if workspace is None or name is None or name.kind is not NameKind.PARAMETER:
        return []
    await server.when_indexed()
    uses = await server.run_in_check_thread(lambda: find_references(workspace, texts, name))
    declared = (Target(use.file, use.start, use.end) for use in uses if use.is_definition)
    return [*target_locations(declared, server.positions, server.uri_of)]


def _to_locations(
    names: Iterable[NameDefinition], positions_of: PositionsOf, uri_of: Callable[[Path], str]
) -> Iterable[types.Location]:
    for name in names:
        text_positions = positions_of(name.file)
        if text_positions is not None:
            yield types.Location(uri_of(name.file), text_positions.range(name.start, name.start + len(name.name)))


def format_hover(context: FormatContext, position: types.Position) -> types.Hover | None:
    """Return the hover of a format at a position, or None if nothing is known."""
    explanation = context.format.explain(context.document, context.positions.offset(position))
    return (
        None
        if explanation is None
        else types.Hover(_to_markdown(explanation.text), context.positions.range(explanation.start, explanation.end))
    )


def find_targets(context: FormatContext, position: types.Position) -> list[Target]:
    """Return the definitions that a format finds for the name at a position."""
    return [*context.format.define(context.document, context.positions.offset(position))]


def target_locations(
    targets: Iterable[Target], positions_of: PositionsOf, uri_of: Callable[[Path], str]
) -> Iterable[types.Location]:
    """Convert targets to locations of the protocol."""
    for target in targets:
        text_positions = positions_of(target.file)
        start = types.Position(0, 0)
        range_ = types.Range(start, start) if text_positions is None else text_positions.range(target.start, target.end)
        yield types.Location(uri_of(target.file), range_)


def _to_markdown(text: str | Phrase) -> types.MarkupContent:
    return types.MarkupContent(types.MarkupKind.Markdown, localized(text))


def add_requests(server: LinkwrightServer) -> None:
    """Register the request handlers of this module."""

    @server.feature(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(["<", " ", '"', "'", "/", "{", "(", ":"]))
    async def completion_request(
        server: LinkwrightServer, params: types.CompletionParams
    ) -> list[types.CompletionItem] | None:
        capabilities = server.client_capabilities.text_document
        item = capabilities.completion.completion_item if capabilities and capabilities.completion else None
        supports_snippets = bool(item and item.snippet_support)
        path, positions = server.supported_text(params.text_document)
        if positions is None or server.project is None:
            return None
        await server.when_prepared(path)
        names = await server.defined_names(path) if format_of(path) is None else []
        server.check_unchanged(path, positions)
        document = Document(server.project, server.texts(), real_path(path), positions.text, waits=False)
        offset = positions.offset(params.position)
        try:
            completions = completions_at(document, offset, names)
        except NotYetKnownError:
            waiting = replace(document, waits=True)
            completions = await server.run_in_check_thread(lambda: completions_at(waiting, offset, names))
            server.check_unchanged(path, positions)
        if document.refreshes:
            server.submit_to_check_thread(document.refreshes, document.file)
        return completion_items(completions, positions, params.position, supports_snippets=supports_snippets)

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    async def hover_request(server: LinkwrightServer, params: types.HoverParams) -> types.Hover | None:
        suppressed = suppression_hover(server, params)
        if suppressed is not None:
            return suppressed
        context = await server.indexed_format_context(params.text_document)
        if context is not None:
            return await server.run_in_check_thread(lambda: format_hover(context, params.position))
        path, positions = server.xml_text(params.text_document)
        workspace, texts = server.project, server.texts()
        if positions is None or workspace is None:
            return None
        names, values = await server.defined_names(path), await server.expression_values(path)
        text, offset = positions.text, positions.offset(params.position)
        facts = await server.run_in_check_thread(
            lambda: facts_at(workspace, texts, real_path(path), text, offset, values)
        )
        server.check_unchanged(path, positions)
        document = Document(workspace, texts, real_path(path), text)
        return hover(document, names, values, facts, positions, params.position)

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    async def definition_request(
        server: LinkwrightServer, params: types.DefinitionParams
    ) -> list[types.Location] | None:
        context = await server.indexed_format_context(params.text_document)
        if context is not None:
            targets = await server.run_in_check_thread(lambda: find_targets(context, params.position))
            return [*target_locations(targets, server.positions, server.uri_of)]
        source = await server.run_in_check_thread(
            lambda: find_source_locations(server, params.text_document.uri, params.position)
        )
        path, positions = server.xml_text(params.text_document)
        if positions is None or server.project is None:
            return source
        names, values = await server.defined_names(path), await server.expression_values(path)
        server.check_unchanged(path, positions)
        locations = await parameter_definitions(server, path, positions, params.position) or definitions(
            names, positions, params.position, server.positions, server.uri_of
        )
        offset, finder = positions.offset(params.position), server.project.finder(real_path(path))
        links = () if locations else file_references(positions.text, path, finder, values)
        top = types.Range(types.Position(0, 0), types.Position(0, 0))
        locations += [
            types.Location(server.uri_of(link.file), top)
            for link in links
            if link.start <= offset <= link.end and link.file.is_file()
        ]
        return locations
