"""Inlay hints with values and block parameters, and code lenses with uses and robot pages."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from lsprotocol import types

from linkwright.diagnostics import counted, phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.includes import real_path
from linkwright.language.occurrences import occurrences_in
from linkwright.language.outline import Outline
from linkwright.language.parameters import block_parameters
from linkwright.language.renaming import find_references
from linkwright.language.values import EvaluatedText, outermost_texts, shorten_values
from linkwright.lsp.positions import TextPositions
from linkwright.lsp.requests.robot_pages import SHOW_ROBOT
from linkwright.lsp.server import LinkwrightServer

SHOW_REFERENCES = "linkwright.showReferences"
"""The client's command that shows references, which code lenses use if the client has it."""
OPEN_IN_PAGE = "linkwright.openInPage"
"""The command of a client that shows the page of a robot itself. Code lenses prefer it to `SHOW_ROBOT`."""
_COUNTED_KINDS = (NameKind.MACRO, NameKind.PROPERTY, NameKind.ARGUMENT)


def value_hints(
    positions: TextPositions, values: Sequence[EvaluatedText], start: int, end: int
) -> Iterator[types.InlayHint]:
    """Yield a hint with the values after each text with expressions in a range.

    Args:
        positions: the text.
        values: the values of its expressions.
        start: the character offset where the range starts.
        end: the offset where the range ends.
    """
    for text in outermost_texts(values):
        source = positions.text[text.start : text.end]
        label = shorten_values(text)
        if start <= text.end <= end and label and label != source and not source.startswith("$(find"):
            yield types.InlayHint(positions.position(text.end), f"= {label}", padding_left=True)


def block_hints(
    positions: TextPositions, names: Sequence[NameDefinition], start: int, end: int
) -> Iterator[types.InlayHint]:
    """Yield a hint with the parameter's name before each block in the macro calls of a range."""
    for element in Outline.of(positions.text).all():
        if start <= element.tag.start <= end:
            for block, name in block_parameters(element, names):
                position = positions.position(block.tag.start)
                yield types.InlayHint(position, f"{name}:", types.InlayHintKind.Parameter, padding_right=True)


def lenses(server: LinkwrightServer, path: Path, positions: TextPositions) -> list[types.CodeLens]:
    """Return the code lenses of a file: the uses of its names, and its robot in the page."""
    code_lenses = []
    for name in occurrences_in(positions.text, real_path(path)):
        if name.is_definition and name.kind in _COUNTED_KINDS:
            range_ = positions.range(name.start, name.end)
            code_lenses.append(types.CodeLens(range_, data={"uri": server.uri_of(path), "offset": name.start}))
    for element in Outline.of(positions.text).elements:
        if element.tag.name == "robot":
            title = localized(phrase("open in the page"))
            range_ = positions.range(element.tag.start, element.tag.end)
            command = OPEN_IN_PAGE if OPEN_IN_PAGE in server.client_commands else SHOW_ROBOT
            code_lenses.append(types.CodeLens(range_, types.Command(title, command, arguments=[server.uri_of(path)])))
    return code_lenses


async def _with_use_count(server: LinkwrightServer, lens: types.CodeLens) -> types.CodeLens:
    """Return a lens with the number of uses of its name, and their locations."""
    data: dict[str, Any] = lens.data if isinstance(lens.data, dict) else {}
    path, positions = server.xml_text(types.TextDocumentIdentifier(str(data.get("uri", ""))))
    workspace = server.project
    if positions is None or workspace is None:
        return lens
    await server.when_indexed()
    texts, file = server.texts(), real_path(path)
    name = next((name for name in occurrences_in(positions.text, file) if name.start == data.get("offset")), None)
    uses = [] if name is None else await server.run_in_check_thread(lambda: find_references(workspace, texts, name))
    locations = []
    for use in uses:
        use_positions = None if use.is_definition else server.positions(use.file)
        if use_positions is not None:
            locations.append(types.Location(server.uri_of(use.file), use_positions.range(use.start, use.end)))
    count = len(locations)
    title = localized(counted("{count} use", "{count} uses", count) if count else phrase("no uses"))
    is_known = SHOW_REFERENCES in server.client_commands
    arguments = [server.uri_of(path), lens.range.start, locations] if is_known else None
    lens.command = types.Command(title, SHOW_REFERENCES if is_known else "", arguments=arguments)
    return lens


def add_requests(server: LinkwrightServer) -> None:
    """Register the request handlers of this module."""

    @server.feature(types.TEXT_DOCUMENT_INLAY_HINT)
    async def inlay_hint(server: LinkwrightServer, params: types.InlayHintParams) -> list[types.InlayHint] | None:
        path, positions = server.xml_text(params.text_document)
        if positions is None:
            return None
        names, values = await server.defined_names(path), await server.expression_values(path)
        server.check_unchanged(path, positions)
        start, end = positions.offset(params.range.start), positions.offset(params.range.end)
        return [*value_hints(positions, values, start, end), *block_hints(positions, names, start, end)]

    @server.feature(types.TEXT_DOCUMENT_CODE_LENS, types.CodeLensOptions(resolve_provider=True))
    def code_lens(server: LinkwrightServer, params: types.CodeLensParams) -> list[types.CodeLens] | None:
        path, positions = server.xml_text(params.text_document)
        return None if positions is None else lenses(server, path, positions)

    @server.feature(types.CODE_LENS_RESOLVE)
    async def resolve_lens(server: LinkwrightServer, lens: types.CodeLens) -> types.CodeLens:
        return await _with_use_count(server, lens)
