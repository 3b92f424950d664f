"""The meanings of URDF's elements and attributes, by name or path.

A path is ``joint.limit.effort``, for example.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.schema import ElementRule, describe_attribute, describe_element
from linkwright.urdf.schema import ROBOT

_Path = tuple[str, ...]


def meanings(name: str) -> list[Phrase]:
    """Return the meanings of a name or path in Markdown, or an empty list if there are none.

    A path leads from outer to inner elements, may start at any element, and may end with an attribute.
    ``joint.limit.effort`` and ``limit.effort`` are the same, and so are ``limit/effort`` and ``<limit> effort``.
    """
    requested_path = tuple(re.findall(r"[\w-]+", name.casefold()))
    if not requested_path:
        return []
    paths_by_text: dict[Phrase, list[_Path]] = {}
    for path, rule in _walk_elements(ROBOT, ()):
        if _ends_with(path, requested_path):
            paths_by_text.setdefault(describe_element(rule), []).append(path)
        if requested_path[:-1] == path[len(path) - len(requested_path) + 1 :]:
            for attribute in rule.attributes:
                if attribute.name.casefold() == requested_path[-1]:
                    paths_by_text.setdefault(phrase("- {line}", line=describe_attribute(attribute)), []).append(
                        (*path, attribute.name)
                    )
    return [joined([_format_heading(paths), text], "\n\n") for text, paths in paths_by_text.items()]


def names() -> list[str]:
    """Return the names of all URDF elements and attributes, without duplicates."""
    all_names = [
        name
        for path, rule in _walk_elements(ROBOT, ())
        for name in (path[-1], *(attribute.name for attribute in rule.attributes))
    ]
    return list(dict.fromkeys(all_names))


def _walk_elements(rule: ElementRule, parent_path: _Path) -> Iterator[tuple[_Path, ElementRule]]:
    path = (*parent_path, rule.tag)
    yield path, rule
    for child in rule.children:
        yield from _walk_elements(child, path)


def _ends_with(path: _Path, suffix: _Path) -> bool:
    return path[-len(suffix) :] == suffix


def _format_heading(paths: list[_Path]) -> str:
    """Return a Markdown heading that lists paths relative to ``<robot>``."""
    return "# " + ", ".join(f"`{'.'.join(path[1:] or path)}`" for path in paths)
