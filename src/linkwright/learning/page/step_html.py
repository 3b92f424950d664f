"""Convert lesson texts to HTML for pages."""

from __future__ import annotations

import re
from base64 import b64encode
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.page.files import IMAGE_TYPES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from markdown_it import MarkdownIt
    from markdown_it.token import Token

MAX_IMAGE_BYTES = 400_000
"""The maximum size of an image in the text of a lesson, because pages receive images as part of the text."""

_CHINESE = "\u3000-\u303f\u3400-\u9fff\uff00-\uffef"
_CHINESE_PAIR = re.compile(f"[{_CHINESE}][{_CHINESE}“”‘’…—]|[“”‘’…—][{_CHINESE}]")
"""Two characters between which Chinese text has no space; quotation marks and dashes are also those of English."""


def render_html(text: str, folder: Path) -> str:
    """Return the HTML of a Markdown text.

    HTML in the text is escaped. An image is embedded if it is a file below the lesson's folder; other
    images are replaced with their descriptions. The end of a line is a space, except between Chinese characters.

    Args:
        text: the Markdown.
        folder: the folder of the lesson, from which the paths of images are resolved.
    """
    return _create_renderer().render(text, {"folder": folder}) if text else ""


@lru_cache(maxsize=1)
def _create_renderer() -> MarkdownIt:
    from markdown_it import MarkdownIt

    renderer = MarkdownIt("commonmark", {"html": False}).enable("table")
    renderer.add_render_rule("image", _render_image)
    renderer.add_render_rule("softbreak", _render_line_end)
    return renderer


def _render_line_end(_create_renderer: Any, tokens: Sequence[Token], index: int, _options: Any, _env: Any) -> str:
    last_character = next((token.content[-1] for token in reversed(tokens[:index]) if token.content), "")
    next_character = next((token.content[0] for token in tokens[index + 1 :] if token.content), "")
    return "" if _CHINESE_PAIR.match(last_character + next_character) else "\n"


def _render_image(renderer: Any, tokens: Sequence[Token], index: int, options: Any, env: Any) -> str:
    token = tokens[index]
    address = _make_data_url(env["folder"], str(token.attrGet("src") or ""))
    description = renderer.renderInlineAsText(token.children or [], options, env)
    token.attrSet("alt", description)
    if address is None:
        return renderer.renderInline(token.children or [], options, env)  # type: ignore[no-any-return]
    token.attrSet("src", address)
    return renderer.renderToken(tokens, index, options, env)  # type: ignore[no-any-return]


def _make_data_url(folder: Path, name: str) -> str | None:
    """Return an image of a lesson as a data URL, or None if the lesson has no such image."""
    try:
        path = (folder / name).resolve(strict=True)
        is_inside = path.is_relative_to(folder.resolve(strict=True))
    except (OSError, RuntimeError, ValueError):
        return None
    if not is_inside or path.suffix.lower() not in IMAGE_TYPES or path.stat().st_size > MAX_IMAGE_BYTES:
        return None
    return f"data:{IMAGE_TYPES[path.suffix.lower()]};base64,{b64encode(path.read_bytes()).decode()}"
