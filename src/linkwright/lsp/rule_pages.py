"""The page of a diagnostic code as a virtual document.

The URI of the document is ``linkwright-rule:CODE``. Its content is the page that ``linkwright explain CODE`` prints.
"""

from __future__ import annotations

from urllib.parse import quote, unquote

from linkwright.diagnostics.translation import localized

SCHEME = "linkwright-rule"


def page_uri(code: str) -> str:
    """Return the URI of the page of a code."""
    return f"{SCHEME}:{quote(code)}"


def page_text(uri: str) -> str | None:
    """Return a rule's page in Markdown by its URI, or None for other URIs and unknown codes."""
    from linkwright.lint.explain import find_page

    scheme, _, code = uri.partition(":")
    page = find_page(unquote(code).lstrip("/")) if scheme == SCHEME else None
    return None if page is None else localized(page.markdown)
