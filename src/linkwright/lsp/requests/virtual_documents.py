"""The content of virtual documents: expansions of descriptions, and pages of rules."""

from __future__ import annotations

from lsprotocol import types

from linkwright.lsp import rule_pages
from linkwright.lsp.requests import expansions
from linkwright.lsp.server import LinkwrightServer


def add_requests(server: LinkwrightServer) -> None:
    """Register the request handlers of this module."""
    schemes = types.TextDocumentContentOptions([expansions.SCHEME, rule_pages.SCHEME])

    @server.feature(types.WORKSPACE_TEXT_DOCUMENT_CONTENT, schemes)
    async def text_document_content(
        server: LinkwrightServer, params: types.TextDocumentContentParams
    ) -> types.TextDocumentContentResult | None:
        text = rule_pages.page_text(params.uri)
        if text is None:
            text = await expansions.expansion_content(server, params.uri)
        return None if text is None else types.TextDocumentContentResult(text)
