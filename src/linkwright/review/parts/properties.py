"""Compare the properties of unexpanded descriptions: those that are gone, and those that move to other branches."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.parts.include_graph import IncludeGraph
from linkwright.review.parts.name_substitution import iterate_properties
from linkwright.review.parts.outline import INCLUDE, PROPERTY, MacroOutline, Outline, iterate_items, uses_name
from linkwright.review.parts.part_pair import PartPair
from linkwright.review.texts.merging import name_edit
from linkwright.xmltree import Element

_DEFINITIONS = (PROPERTY, INCLUDE, "material")
"""The tags of elements that only define something for other elements."""
_MIN_ALIKE = 2
"""The minimum number of names that are edited alike, so that they count as renamed."""


@dataclass(frozen=True)
class _Definition:
    """A definition of a property.

    Attributes:
        macro: the macro that contains it, or None outside of macros.
        value: the value as it is written.
        conditions: the conditions around it.
        element: the XML element.
    """

    macro: str | None
    value: str
    conditions: tuple[str, ...]
    element: Element


def compare_properties(pair: PartPair, graph: IncludeGraph) -> None:
    """Report lost properties of a file that others include, and values in other macros or branches.

    Args:
        pair: both versions of the file.
        graph: the includes of the new version.
    """
    old, new = _read_definitions(pair.old), _read_definitions(pair.new)
    if not pair.is_complete:
        _report_lost_properties(pair, graph, old, new)
    for name, definitions in new.items():
        if name in old:
            _report_moved_values(pair, name, old[name], definitions)


def find_distinguishing_conditions(scope: Element, element: Element | None) -> tuple[str, ...]:
    """Return the conditions of a property that a file or macro defines several times; none for other elements."""
    if element is None or element.tag != PROPERTY:
        return ()
    name = element.attributes.get("name")
    items = [item for item in iterate_items(scope) if item.element.tag == PROPERTY]
    items = [item for item in items if item.element.attributes.get("name") == name]
    return next((item.conditions for item in items if item.element is element and len(items) > 1), ())


def _read_definitions(outline: Outline) -> dict[str, list[_Definition]]:
    """Return the definitions of properties with values, by name."""
    definitions: dict[str, list[_Definition]] = defaultdict(list)
    scopes: list[tuple[MacroOutline | None, Element]] = [(None, outline.root)]
    scopes += [(macro, macro.element) for macro in outline.macros.values()]
    for macro, scope in scopes:
        for item in iterate_items(scope):
            attributes = item.element.attributes
            if item.element.tag == PROPERTY and "name" in attributes and "value" in attributes:
                name, value = attributes["name"], " ".join(attributes["value"].split())
                definition = _Definition(None if macro is None else macro.name, value, item.conditions, item.element)
                definitions[name].append(definition)
    return definitions


def _report_moved_values(pair: PartPair, name: str, old: Sequence[_Definition], new: Sequence[_Definition]) -> None:
    """Report the values of a property in a macro or branch that did not define it.

    Changed values in the same macro and under the same conditions are compared with the other elements.
    """
    for definition in new:
        in_scope = [other for other in old if other.macro in (None, definition.macro)]
        values = dict.fromkeys(other.value for other in in_scope)
        places = {(other.macro, other.conditions) for other in old}
        is_new_macro = definition.macro is not None and definition.macro not in pair.old.macros
        if is_new_macro or not values or definition.value in values:
            continue
        if (definition.macro, definition.conditions) in places:
            continue
        conditions = " and ".join(definition.conditions)
        text: Phrase = phrase("property {name}: {old} -> {new}", name=name, old=", ".join(values), new=definition.value)
        text = phrase("{change} ({condition})", change=text, condition=conditions) if conditions else text
        if definition.macro is not None:
            text = phrase("macro '{macro}': {text}", macro=definition.macro, text=text)
        pair.add(text, None, definition.element)


# --- lost properties -------------------------------------------------------------------------------------------------


def _report_lost_properties(
    pair: PartPair,
    graph: IncludeGraph,
    old: Mapping[str, Sequence[_Definition]],
    new: Mapping[str, Sequence[_Definition]],
) -> None:
    """Report the properties outside of macros that no file defines any more.

    They are breaking in a file without elements of its own, if the file does not use them itself: such a file defines
    colors or dimensions for others.
    """
    defined = {name for _, outline in graph.iterate_outlines() for name, _ in iterate_properties(outline.root)}
    lost = {
        name: definitions[0]
        for name, definitions in old.items()
        if name not in defined and name not in new and any(definition.macro is None for definition in definitions)
    }
    if not lost:
        return
    reason = None
    has_elements = any(item.element.tag not in _DEFINITIONS for item in iterate_items(pair.old.root))
    if not has_elements and any(not _is_used(pair.old.root, name) for name in lost):
        reason = phrase("descriptions that include the file and use them cannot be expanded")
    added = {name: definitions[0] for name, definitions in new.items() if name not in old}
    renamed = dict(_find_renamed(lost, added))
    new_values = {definition.value for definition in added.values()}
    removed = [
        name
        for name, definition in lost.items()
        if name not in renamed and not (_is_used(pair.old.root, name) and definition.value in new_values)
    ]
    if renamed:
        names = joined_first([f"{name} -> {new_name}" for name, new_name in renamed.items()], MAX_NAMES)
        element = added[next(iter(renamed.values()))].element
        pair.add(phrase("properties renamed: {names}", names=names), None, element, reason)
    if removed:
        text = phrase("properties removed: {names}", names=joined_first(removed, MAX_NAMES))
        pair.add(text, lost[removed[0]].element, None, reason)


def _is_used(root: Element, name: str) -> bool:
    return any(uses_name(element, name) for element in root.walk())


def _find_renamed(removed: Mapping[str, _Definition], added: Mapping[str, _Definition]) -> Iterator[tuple[str, str]]:
    """Yield the old and new names of properties that several edits have in common."""
    edits: dict[Hashable, list[tuple[str, str]]] = defaultdict(list)
    for name in removed:
        for new_name in added:
            edits[name_edit(name, new_name)].append((name, new_name))
    pairs = max(edits.values(), key=len, default=[])
    if len(pairs) >= _MIN_ALIKE:
        yield from pairs
