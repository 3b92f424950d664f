"""Find names that are the same although a node loses or gets the namespace that they have."""

from __future__ import annotations

import re
from collections.abc import Iterator

_ARGUMENT = r"(?:\"[^\"]*\"|'[^']*'|[\w.:>-]+(?:\(\))?)"
_NODE = r"(?:rclcpp(?:_lifecycle)?\s*::\s*)?(?:Lifecycle)?Node"
_NAMED = rf"\(\s*{_ARGUMENT}\s*,\s*(?P<namespace>{_ARGUMENT})\s*[,)]"
"""The arguments of a node in C++: its name and its namespace."""
_CREATED = re.compile(
    rf"\b(?P<variable>\w+)\s*(?:=|\(|(?:\.|->)\s*reset\s*\()\s*"
    rf"(?:{_NODE}\s*::\s*make_shared|(?:std\s*::\s*)?make_(?:shared|unique)\s*<\s*{_NODE}\s*>|new\s+{_NODE})\s*{_NAMED}"
)
_BASE = re.compile(rf"[:,]\s*{_NODE}\s*{_NAMED}")
_KEYWORD = rf"\([^()]*\bnamespace\s*=\s*(?P<namespace>{_ARGUMENT})\s*[,)]"
_PYTHON_CREATED = re.compile(rf"(?P<variable>[\w.]+)\s*=\s*(?:\w+\.)*(?:create_node|Node)\s*{_KEYWORD}")
_PYTHON_BASE = re.compile(rf"(?:super\(\)|\bNode)\.__init__\s*{_KEYWORD}")
_OWN_CALL = r"(?:\bthis\s*->\s*|\bself\s*\.\s*|(?<![\w.>]))"
_F_STRING = re.compile(r"f[\"']/?\{(?P<prefix>[^{}]+)\}/(?P<name>[\w/]+)[\"']")
_SUM = re.compile(r"(?:[\"']/[\"']\s*\+\s*)?(?P<prefix>[\w.:>-]+(?:\(\))?)\s*\+\s*[\"']/(?P<name>[\w/]+)[\"']")


def have_same_full_name(old: str, new: str, old_text: str, new_text: str) -> bool:
    """Return whether two names are the same, because one has the namespace that the node of the other one gives.

    For example, ``"states"`` of a node in the namespace ``side`` is ``side + "/states"`` of a node without one.

    Args:
        old: the old name, or the expression that gives it.
        new: the new name, or the expression that gives it.
        old_text: the text of the old source.
        new_text: the text of the new source.
    """
    sides = ((old, new, old_text, new_text), (new, old, new_text, old_text))
    return any(
        namespace in set(_find_namespaces(text, inner)) and namespace not in set(_find_namespaces(other_text, None))
        for inner, outer, text, other_text in sides
        if (namespace := _find_prefix(inner, outer)) is not None
    )


def _find_prefix(inner: str, outer: str) -> str | None:
    """Return the text before a name in another name or in an expression; None if it does not end with the name."""
    computed = _F_STRING.fullmatch(outer) or _SUM.fullmatch(outer)
    if computed is not None:
        return computed["prefix"] if computed["name"] == inner else None
    is_longer = re.fullmatch(r"[\w/]+", inner) is not None and outer.endswith(f"/{inner}")
    return f'"{outer[: -len(inner)].strip("/")}"' if is_longer and not inner.startswith("/") else None


def _find_namespaces(text: str, name: str | None) -> Iterator[str]:
    """Yield the namespaces of the nodes of a source that make a name; those of all nodes without a name."""
    for pattern in (_CREATED, _BASE, _PYTHON_CREATED, _PYTHON_BASE):
        for match in pattern.finditer(text):
            variable = match.groupdict().get("variable")
            receiver = _OWN_CALL if variable is None else rf"(?<![\w.]){re.escape(variable)}\s*(?:->|\.)\s*"
            call = rf"{receiver}create_\w+\s*(?:<[^;(]*>)?\s*\([^;\"']*[\"']{re.escape(name or '')}[\"']"
            if name is None or re.search(call, text) is not None:
                namespace = match["namespace"]
                is_literal = namespace.startswith(("'", '"'))
                yield f'"{namespace[1:-1].strip("/")}"' if is_literal else namespace
