"""Find names that a macro newly uses although nothing defines them, and names whose definition is gone."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from linkwright.lint.xacro_names import mentions
from linkwright.packages.readers.python_values import parse_python_expression
from linkwright.review.parts.include_graph import IncludeGraph, IncludeGraphs
from linkwright.review.parts.known_values import evaluate_condition
from linkwright.review.parts.name_substitution import iterate_properties
from linkwright.review.parts.outline import MACRO, MacroOutline, Outline, iterate_items
from linkwright.review.parts.part_pair import PartPair
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


def find_unmet_condition(macro: MacroOutline, name: str, values: Mapping[str, str]) -> str | None:
    """Return a condition around a use of a name that does not hold by default; None if a use is reached by default.

    Args:
        macro: the macro that uses the name.
        name: the name.
        values: the values of names by default.
    """
    found: str | None = None
    for texts, conditions in _iterate_conditional_texts(macro.element, ()):
        if any(name in _find_looked_up_names(part) for text in texts for part in _EXPRESSION.findall(text)):
            unmet = [condition for condition in conditions if evaluate_condition(condition, values) is False]
            if not unmet:
                return None
            found = found or unmet[0]
    return found


def _iterate_conditional_texts(
    element: Element, conditions: tuple[str, ...]
) -> Iterator[tuple[list[str], tuple[str, ...]]]:
    """Yield the texts of an element and the elements in it, with the conditions around them."""
    yield [element.text(), *element.attributes.values()], conditions
    for item in iterate_items(element, conditions):
        yield from _iterate_conditional_texts(item.element, item.conditions)


def find_lost_definitions(graphs: IncludeGraphs, pair: PartPair) -> list[str]:
    """Return the names that macros of a file use, and that only the old version of the file or its includes define.

    A robot of the repository may define them before it includes the file; robots of other repositories need not. If the
    file newly includes one that is not in the repository, which may define names, nothing is found.

    Args:
        graphs: the includes of both versions.
        pair: both versions of the file.
    """
    if pair.is_read(is_old=True) != pair.is_read(is_old=False):
        return []  # what cannot be expanded any more is reported on its own
    if graphs.new.find_unknown_includes(pair.new_path) - graphs.old.find_unknown_includes(pair.old_path):
        return []
    names: set[str] = set()
    for name, macro in pair.new.macros.items():
        old = pair.old.macros.get(name)
        if old is not None:
            used = _find_used_names(macro.element) & _find_mentioned_names(old.element)
            names |= used - set(_find_parameters(macro.element)) - _KNOWN_NAMES
    return sorted(
        name
        for name in names
        if graphs.old.declares(pair.old_path, _Definition(name))
        and not graphs.new.declares(pair.new_path, _Definition(name))
    )


@dataclass(frozen=True)
class _Definition:
    """Whether a file defines a property, or may define it under a computed name."""

    name: str

    def __call__(self, outline: Outline) -> bool:
        return any(name == self.name or "$" in name for name, _ in iterate_properties(outline.root))


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
        nodes = [node for node in ast.walk(parse_python_expression(expression.strip())) if isinstance(node, ast.Name)]
    except (SyntaxError, ValueError):
        return set()
    bound = {node.id for node in nodes if not isinstance(node.ctx, ast.Load)}
    return {node.id for node in nodes} - bound


def _find_parameters(macro: Element) -> Iterator[str]:
    """Yield the names of the parameters of a macro and of the macros in it."""
    for element in macro.walk():
        if element.tag == MACRO:
            parameters = MacroOutline("", element).parameters
            yield from (name.lstrip("*") for name in parameters)
