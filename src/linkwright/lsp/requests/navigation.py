"""Navigation: links to files, workspace symbols, uses of a name and the call hierarchy."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from lsprotocol import types

from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.includes import real_path
from linkwright.language.links import FileReference, file_references
from linkwright.language.occurrences import Occurrence, occurrences_in
from linkwright.language.renaming import find_references, occurrence_at
from linkwright.language.uses import find_uses
from linkwright.lsp.positions import TextPositions
from linkwright.lsp.server import LinkwrightServer, path_from_uri

_SYMBOL_KINDS = {
    NameKind.MACRO: types.SymbolKind.Function,
    NameKind.PROPERTY: types.SymbolKind.Variable,
    NameKind.ARGUMENT: types.SymbolKind.Variable,
    NameKind.LINK: types.SymbolKind.Object,
    NameKind.JOINT: types.SymbolKind.Interface,
    NameKind.MATERIAL: types.SymbolKind.Constant,
}
_MAX_SYMBOLS = 500


def find_matching_names(names: Iterable[NameDefinition], query: str) -> list[NameDefinition]:
    """Return the names that contain the characters of a query in order, the best first.

    Names that contain the query as a whole come before the others, and short names before long ones.

    Args:
        names: the definitions to filter.
        query: the query, in upper or lower case. An empty query matches all names.
    """
    query = query.lower()

    def matches(name: str) -> bool:
        characters = iter(name)
        return all(character in characters for character in query)

    lower_names = [(name.name.lower(), name) for name in names]
    ranked = [(query not in lower, len(lower), index) for index, (lower, _) in enumerate(lower_names) if matches(lower)]
    return [lower_names[number][1] for *_, number in sorted(ranked)]


def _to_symbols(server: LinkwrightServer, names: Iterable[NameDefinition]) -> Iterator[types.WorkspaceSymbol]:
    for name in names:
        positions = server.positions(name.file)
        if positions is not None and name.kind in _SYMBOL_KINDS:
            range_ = positions.range(name.start, name.start + len(name.name))
            location = types.Location(server.uri_of(name.file), range_)
            yield types.WorkspaceSymbol(location, name.name, _SYMBOL_KINDS[name.kind], container_name=name.file.name)


def find_uses_in_file(text: str, path: Path, offset: int) -> list[Occurrence]:
    """Return all occurrences in a file of the name at an offset."""
    name = occurrence_at(text, path, offset)
    if name is None:
        return []
    is_parameter = name.kind is NameKind.PARAMETER
    return [
        other
        for other in occurrences_in(text, path)
        if (other.kind, other.name) == (name.kind, name.name) and (not is_parameter or other.owner == name.owner)
    ]


def _make_macro_item(server: LinkwrightServer, macro: Occurrence) -> types.CallHierarchyItem | None:
    positions = server.positions(macro.file)
    if positions is None:
        return None
    range_ = positions.range(macro.start, macro.end)
    uri = server.uri_of(macro.file)
    return types.CallHierarchyItem(
        macro.name, types.SymbolKind.Function, uri, range_, range_, detail=macro.file.name, data={"start": macro.start}
    )


def _make_file_item(server: LinkwrightServer, file: Path, positions: TextPositions) -> types.CallHierarchyItem:
    """Return the item of a file, as the caller of macros outside macro definitions."""
    start = positions.range(0, 0)
    return types.CallHierarchyItem(file.name, types.SymbolKind.File, server.uri_of(file), start, start)


class _MacroCalls:
    """The incoming and outgoing calls of a macro.

    Args:
        server: the language server.
        texts: the texts of the open files.
        item: the macro whose calls are searched.
    """

    def __init__(self, server: LinkwrightServer, texts: Mapping[Path, str], item: types.CallHierarchyItem) -> None:
        self._server = server
        path = path_from_uri(item.uri)
        self._file = real_path(path) if path is not None else Path()
        data: Any = item.data
        start = data.get("start") if isinstance(data, dict) else getattr(data, "start", None)
        positions = server.positions(self._file)
        text = "" if positions is None else positions.text
        macros = (name for name in occurrences_in(text, self._file) if name.kind is NameKind.MACRO)
        self._macro = next((name for name in macros if name.start == start), None)
        self._uses = (
            find_references(server.project, texts, self._macro) if self._macro is not None and server.project else []
        )
        self._texts = texts

    def incoming(self) -> Iterator[types.CallHierarchyIncomingCall]:
        """Yield the macros and files that call the macro."""
        callers: dict[tuple[Path, str], list[Occurrence]] = {}
        for use in self._uses:
            if not use.is_definition:
                callers.setdefault((use.file, use.owner), []).append(use)
        for (file, owner), uses in callers.items():
            positions = self._server.positions(file)
            if positions is None:
                continue
            opening_tags = [
                use for use in uses if not positions.text.startswith("</", _find_tag_start(positions.text, use.start))
            ]
            item = self._find_definition(owner, file) if owner else _make_file_item(self._server, file, positions)
            if item is not None:
                yield types.CallHierarchyIncomingCall(
                    item, [positions.range(use.start, use.end) for use in opening_tags]
                )

    def outgoing(self) -> Iterator[types.CallHierarchyOutgoingCall]:
        """Yield the macros that the macro calls."""
        positions = self._server.positions(self._file)
        if self._macro is None or positions is None:
            return
        calls: dict[str, list[types.Range]] = {}
        for use in occurrences_in(positions.text, self._file):
            is_call = use.kind is NameKind.MACRO and not use.is_definition and use.owner == self._macro.name
            if is_call and not positions.text.startswith("</", _find_tag_start(positions.text, use.start)):
                calls.setdefault(use.name, []).append(positions.range(use.start, use.end))
        for name, ranges in calls.items():
            item = self._find_definition(name, self._file)
            if item is not None:
                yield types.CallHierarchyOutgoingCall(item, ranges)

    def _find_definition(self, macro: str, file: Path) -> types.CallHierarchyItem | None:
        workspace = self._server.project
        for other in () if workspace is None else workspace.index.related_files(file, self._texts):
            positions = self._server.positions(other)
            for name in occurrences_in("" if positions is None else positions.text, other):
                if name.kind is NameKind.MACRO and name.is_definition and name.name == macro:
                    return _make_macro_item(self._server, name)
        return None


def _find_tag_start(text: str, offset: int) -> int:
    return text.rfind("<", 0, offset)


def _document_links(
    server: LinkwrightServer, positions: TextPositions, find_references: Iterable[FileReference]
) -> list[types.DocumentLink]:
    return [
        types.DocumentLink(positions.range(link.start, link.end), server.uri_of(link.file))
        for link in find_references
        if link.file.is_file()
    ]


def add_requests(server: LinkwrightServer) -> None:
    """Register the request handlers of this module."""

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_LINK)
    async def document_links(
        server: LinkwrightServer, params: types.DocumentLinkParams
    ) -> list[types.DocumentLink] | None:
        context = await server.indexed_format_context(params.text_document)
        if context is not None:
            links = await server.run_in_check_thread(lambda: [*context.format.links(context.document)])
            return _document_links(server, context.positions, links)
        path, positions = server.xml_text(params.text_document)
        if positions is None or server.project is None:
            return None
        values = await server.expression_values(path)
        server.check_unchanged(path, positions)
        finder = server.project.finder(real_path(path))
        return _document_links(server, positions, file_references(positions.text, path, finder, values))

    @server.feature(types.WORKSPACE_SYMBOL)
    async def workspace_symbol(
        server: LinkwrightServer, params: types.WorkspaceSymbolParams
    ) -> list[types.WorkspaceSymbol] | None:
        workspace, texts = server.project, server.texts()
        if workspace is None:
            return None
        await server.when_indexed()
        names = await server.run_in_check_thread(lambda: workspace.all_names(texts))
        return [*_to_symbols(server, find_matching_names(names, params.query)[:_MAX_SYMBOLS])]

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    def document_highlight(
        server: LinkwrightServer, params: types.DocumentHighlightParams
    ) -> list[types.DocumentHighlight] | None:
        path_at_cursor = path_from_uri(params.text_document.uri)
        if path_at_cursor is not None:  # Editors send this request when the cursor has moved.
            server.robot_views.cursor_moved(real_path(path_at_cursor), params.position.line + 1)
        context = server.format_context(params.text_document)
        if context is not None:
            offset = context.positions.offset(params.position)
            uses = find_uses(context.document, context.format, offset, in_file=True)
            if uses:
                return [types.DocumentHighlight(context.positions.range(use.start, use.end)) for use in uses]
        path, positions = server.xml_text(params.text_document)
        if positions is None:
            return None
        kinds = {True: types.DocumentHighlightKind.Write, False: types.DocumentHighlightKind.Read}
        return [
            types.DocumentHighlight(positions.range(name.start, name.end), kinds[name.is_definition])
            for name in find_uses_in_file(positions.text, real_path(path), positions.offset(params.position))
        ]

    @server.feature(types.TEXT_DOCUMENT_PREPARE_CALL_HIERARCHY)
    async def prepare_call_hierarchy(
        server: LinkwrightServer, params: types.CallHierarchyPrepareParams
    ) -> list[types.CallHierarchyItem] | None:
        path, positions = server.xml_text(params.text_document)
        workspace, texts = server.project, server.texts()
        if positions is None or workspace is None:
            return None
        name = occurrence_at(positions.text, real_path(path), positions.offset(params.position))
        if name is None or name.kind is not NameKind.MACRO:
            return None
        await server.when_indexed()
        occurrences = await server.run_in_check_thread(lambda: find_references(workspace, texts, name))
        return [
            item for use in occurrences if use.is_definition and (item := _make_macro_item(server, use)) is not None
        ]

    @server.feature(types.CALL_HIERARCHY_INCOMING_CALLS)
    async def incoming_calls(
        server: LinkwrightServer, params: types.CallHierarchyIncomingCallsParams
    ) -> list[types.CallHierarchyIncomingCall]:
        await server.when_indexed()
        texts = server.texts()
        return await server.run_in_check_thread(lambda: [*_MacroCalls(server, texts, params.item).incoming()])

    @server.feature(types.CALL_HIERARCHY_OUTGOING_CALLS)
    async def outgoing_calls(
        server: LinkwrightServer, params: types.CallHierarchyOutgoingCallsParams
    ) -> list[types.CallHierarchyOutgoingCall]:
        await server.when_indexed()
        texts = server.texts()
        return await server.run_in_check_thread(lambda: [*_MacroCalls(server, texts, params.item).outgoing()])
