"""Find nodes in C++ that at most send requests, beside the node of the source. No other node uses their names."""

from __future__ import annotations

import re

_ASSIGNMENT = re.compile(r"\b(?P<variable>[A-Za-z_]\w*)\s*=\s*(?:std\s*::\s*)?$")
_HARMLESS_USE = re.compile(
    r"create_client\s*(?:<[^;()]*>)?\s*\(\s*$|spin\w*\s*\(\s*$|(?:add|remove)_node\s*\(\s*$|\bget_logger\s*\(\s*$"
)
"""The text before a use that offers nothing: a client, or a call that handles the responses."""
_HARMLESS_CALL = re.compile(
    r"\s*(?:->|\.)\s*(?:create_client\b|get_logger\b|now\b|get_clock\b|get_node_base_interface\b|reset\s*\(\s*\))"
    r"|\s*=(?!=)|\s*;"
)
"""The text after a use that offers nothing."""


def is_helper_node(text: str, start: int) -> bool:
    """Return whether a node is in a variable with which the source makes no more than clients, and handles responses.

    Args:
        text: the text of the source, without comments.
        start: the offset of the expression that makes the node.
    """
    assignment = _ASSIGNMENT.search(text[max(0, start - 120) : start])
    if assignment is None:
        return False
    uses = list(re.finditer(rf"(?<![\w.>]){re.escape(assignment['variable'])}\b", text))
    return all(
        _HARMLESS_USE.search(text[max(0, use.start() - 200) : use.start()]) or _HARMLESS_CALL.match(text, use.end())
        for use in uses
    )
