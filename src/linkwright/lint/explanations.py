"""Comments that explain a value, on its line or on the lines above it."""

from __future__ import annotations

import re

from linkwright.loading.deferred import lazy_pattern
from linkwright.xmltree import Element
from linkwright.xmltree.patches import find_element_range

_COMMENT = lazy_pattern(r"<!--(.*?)-->", re.DOTALL)
_COMMENTS_ABOVE = lazy_pattern(r"<!--((?:(?!-->).)*)-->[ \t]*\r?\n[ \t]*\Z", re.DOTALL)
_COMMENTED_CODE = lazy_pattern(r"[<=]|linkwright:")
_WORD = lazy_pattern(r"[^\W\d_]{3,}")
_HEADINGS = frozenset(
    {
        *(
            "inertia",
            "inertial",
            "inertias",
            "inertie",
            "matrix",
            "tensor",
            "moment",
            "moments",
            "mass",
            "masses",
            "link",
        ),
        *("properties", "property", "parameters", "parameter", "the", "and", "value", "values", "for", "collision"),
    }
)
"""Words that describe the line, but do not explain its value."""


def is_explained(element: Element | None, tag: str) -> bool:
    """Return whether a comment explains the value of a child of an element.

    The comment may be next to or above the child, or above the element. Commented-out elements, suppressions, and
    headings that only name the child are not explanations.
    """
    if element is None:
        return False
    return any(
        map(
            _is_explanation,
            (*_find_comments(element.first(tag), on_same_lines=True), *_find_comments(element, on_same_lines=False)),
        )
    )


def _find_comments(element: Element | None, *, on_same_lines: bool) -> list[str]:
    """Return the comments above an element or, if `on_same_lines` is set, on its lines."""
    element_span = find_element_range(element) if element is not None else None
    if element is None or element.source is None or element_span is None:
        return []
    text, (start, end) = element.source.text, element_span
    line_start = text.rfind("\n", 0, start) + 1
    search_end = text.find("\n", end) if on_same_lines else start
    comments = [match[1] for match in _COMMENT.finditer(text, line_start, len(text) if search_end < 0 else search_end)]
    comment_above = _COMMENTS_ABOVE.search(
        text, max(0, text.rfind("<!--", 0, start)), line_start + len(text[line_start:start])
    )
    if comment_above is not None and not text[line_start:start].strip():
        comments.append(comment_above[1])
    return comments


def _is_explanation(comment: str) -> bool:
    words = {word.casefold() for word in _WORD.findall(comment)}
    return not _COMMENTED_CODE.search(comment) and bool(words - _HEADINGS)
