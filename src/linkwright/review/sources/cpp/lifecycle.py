"""Find the callbacks of lifecycle nodes in which a C++ source creates its topics, services and actions."""

from __future__ import annotations

import re

from linkwright.review.sources.cpp.text import find_closing_bracket

_CALLBACK = re.compile(r"\b(?P<name>on_(?:configure|activate|init))\s*(?=\()")
_BODY = re.compile(r"\s*(?:const|override|final|noexcept|\s)*\{")


class LifecycleCallbacks:
    """The bodies of the callbacks ``on_init``, ``on_configure`` and ``on_activate`` of a C++ source.

    Args:
        text: the source without comments.
    """

    def __init__(self, text: str) -> None:
        self._bodies: list[tuple[int, int, str]] = []
        for match in _CALLBACK.finditer(text):
            body = _BODY.match(text, find_closing_bracket(text, match.end()) + 1)
            if body is not None:
                self._bodies.append((body.end(), find_closing_bracket(text, body.end() - 1), match["name"]))

    def find(self, offset: int) -> str:
        """Return the callback that contains the code at an offset; empty if there is none."""
        return next((name for start, end, name in self._bodies if start <= offset < end), "")
