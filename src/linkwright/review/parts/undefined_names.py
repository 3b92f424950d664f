"""Find names that a macro newly uses although nothing defines them."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from linkwright.lint.xacro_names import mentions
from linkwright.review.parts.include_graph import IncludeGraph
from linkwright.review.parts.name_substitution import iterate_properties
from linkwright.review.parts.outline import MACRO, MacroOutline
from linkwright.xacro.expressions.builtin_names import BARE_NAMES, MATHEMATICS
from linkwright.xmltree import Element

_KNOWN_NAMES = frozenset({*BARE_NAMES, *MATHEMATICS, "math", "python", "xacro", "True", "False", "None"})
_EXPRESSION = re.compile(r"\$\{([^{}]*)\}")
_XACRO = "xacro:"


def find_undefined_names(graph: IncludeGraph, path: str, old: MacroOutline, new: MacroOutline) -> list[str]:
    """Return the names that only the new version of a macro uses, and that nothing defines.

    A macro sees the names of its caller. It is therefore not searched if a description calls it, which then shows the
    effect, or if a file that is not in the repository may define names.

    Args:
        graph: the includes of the new version.
        path: the file with the new macro.
        old: the old macro.
        new: the new macro.
    """
    names = _find_used_names(new.element) - _find_mentioned_names(old.element) - _KNOWN_NAMES
    if not names or graph.find_outlines_of_robots(path) is None:
        return []
    names -= set(_find_parameters(new.element))
    for _, outline in graph.iterate_outlines():
        properties = {name for name, _ in iterate_properties(outline.root)}
        names -= properties
        if any("$" in name for name in properties):
            return []
        if any(element.tag == f"{_XACRO}{new.name}" for element in outline.root.walk()):
            return []
    return sorted(names)


def _find_mentioned_names(macro: Element) -> set[str]:
    """Return all words in the expressions of a macro that could be names."""
    return {name for text in _iterate_texts(macro) for name in mentions(text).names}


def _find_used_names(macro: Element) -> set[str]:
    """Return the names that the expressions of a macro certainly look up."""
    return {
        name
        for text in _iterate_texts(macro)
        for expression in _EXPRESSION.findall(text)
        for name in _find_looked_up_names(expression)
    }


def _iterate_texts(macro: Element) -> Iterator[str]:
    for element in macro.walk():
        yield from (element.text(), *element.attributes.values())


def _find_looked_up_names(expression: str) -> set[str]:
    """Return the names that an expression does not bind itself; none if it is not valid."""
    try:
        nodes = [node for node in ast.walk(ast.parse(expression.strip(), mode="eval")) if isinstance(node, ast.Name)]
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return set()
    bound = {node.id for node in nodes if not isinstance(node.ctx, ast.Load)}
    return {node.id for node in nodes} - bound


def _find_parameters(macro: Element) -> Iterator[str]:
    """Yield the names of the parameters of a macro and of the macros in it."""
    for element in macro.walk():
        if element.tag == MACRO:
            parameters = MacroOutline("", element).parameters
            yield from (name.lstrip("*") for name in parameters)
