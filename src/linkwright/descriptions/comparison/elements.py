"""The comparison of XML elements by content.

Attributes, texts and children are compared. Elements are matched by tag and name.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from itertools import zip_longest

from linkwright.descriptions.comparison.difference import Difference, Kind, location_of
from linkwright.descriptions.comparison.gazebo_blocks import GAZEBO, joined_block
from linkwright.descriptions.comparison.numbers import normalize_numbers, round_numbers
from linkwright.descriptions.comparison.plugin_parts import find_plugin_parts
from linkwright.descriptions.comparison.renamed_elements import renamed_elements
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.xmltree import Element

SAME_TAGS = {"ray": "lidar"}
"""Tags of SDF with the same meaning: an older one, and the one that replaced it."""
_ATTRIBUTES_WITHOUT_NUMBERS = frozenset({"name", "reference", "filename", "version"})
_STRAY_TEXT = "text between its elements"
"""The end of the path of a text that means nothing, such as a character left over from a patch."""
_Rest = dict[str, list[tuple[str, Element]]]
"""Elements with their keys, by tag and name."""
_PLUGIN_NAMESPACE = "ros namespace"
"""The end of the path of the namespace of a plugin of gazebo_ros."""


@dataclass(frozen=True)
class ElementComparison:
    """A comparison of elements that ignores white space, comments and the order of attributes.

    Attributes:
        normalize_old: a function that makes texts of the old version comparable.
        normalize_new: a function that makes texts of the new version comparable.
        renamed: the new names of renamed links and joints, by old name. Values that follow a new name are equal.
    """

    normalize_old: Callable[[str], str] = str
    normalize_new: Callable[[str], str] = str
    renamed: Mapping[str, str] = field(default_factory=dict)

    def child_differences(
        self,
        old: Sequence[Element],
        new: Sequence[Element],
        path: str = "",
        enclosing: tuple[str, Element, Element] | None = None,
    ) -> Iterator[Difference]:
        """Yield the differences between the elements of two robots, or of a pair of elements.

        Args:
            old: the elements of the old description.
            new: the elements of the new description.
            path: the names of the enclosing elements.
            enclosing: the name of the enclosing pair and the pair itself, or None for direct children of the robots.
        """
        for key, old_element, new_element in self._pairs(old, new):
            element_path = f"{path} {key}".strip()
            if old_element is not None and new_element is not None:
                name, start_path = (key, "") if enclosing is None else (enclosing[0], element_path)
                yield from self.element_differences(name, start_path, old_element, new_element)
            elif enclosing is None:
                kind: Kind = "added" if old_element is None else "removed"
                yield Difference(
                    "extension",
                    key,
                    kind,
                    old_place=location_of(old_element),
                    new_place=location_of(new_element),
                    element=old_element or new_element,
                )
            else:
                texts = (
                    None if old_element is None else _to_one_line(old_element),
                    None if new_element is None else _to_one_line(new_element),
                )
                locations = location_of(old_element or enclosing[1]), location_of(new_element or enclosing[2])
                element = old_element or new_element
                yield Difference("extension", enclosing[0], "changed", element_path, *texts, "", *locations, element)

    def _pairs(
        self, old: Sequence[Element], new: Sequence[Element]
    ) -> Iterator[tuple[str, Element | None, Element | None]]:
        """Yield the pairs of elements that belong together and may differ, each with its key.

        Elements that have an equal counterpart are left out, so that an inserted element does not shift the others.
        """
        contents = [[self._content(element, side) for element in elements] for side, elements in enumerate((old, new))]
        common = Counter(contents[0]) & Counter(contents[1])
        parts = find_plugin_parts((old, new))
        old_rest, new_rest = (
            _remove_common(_index_by_key(elements, parts), keys, common, names, parts)
            for elements, keys, names in zip((old, new), contents, (self.renamed, {}), strict=True)
        )
        yield from self._take_renamed(old, new, old_rest, new_rest)
        for base in dict.fromkeys([*new_rest, *old_rest]):
            old_items, new_items = old_rest.get(base, []), new_rest.get(base, [])
            if old_items and new_items and new_items[0][1].tag == GAZEBO:
                old_items, new_items = _join_gazebo_elements(base, old_items), _join_gazebo_elements(base, new_items)
            for old_item, new_item in zip_longest(*_align_remappings(old_items, new_items)):
                key, _ = new_item or old_item
                yield key, old_item and old_item[1], new_item and new_item[1]

    def _take_renamed(
        self, old: Sequence[Element], new: Sequence[Element], old_rest: _Rest, new_rest: _Rest
    ) -> Iterator[tuple[str, Element, Element]]:
        """Remove the renamed elements from the remaining ones, and yield them with their new keys."""
        old_lone, new_lone = (
            {id(items[0][1]): base for base, items in rest.items() if base not in others and len(items) == 1}
            for rest, others in ((old_rest, new_rest), (new_rest, old_rest))
        )
        if not old_lone or not new_lone:
            return
        old_elements, new_elements = (
            [rest[base][0][1] for base in lone.values()] for rest, lone in ((old_rest, old_lone), (new_rest, new_lone))
        )
        for old_element, new_element in renamed_elements(old, new, old_elements, new_elements):
            del old_rest[old_lone[id(old_element)]]
            ((key, _),) = new_rest.pop(new_lone[id(new_element)])
            yield key, old_element, new_element

    def _content(self, element: Element, side: int, parent: str = "") -> Hashable:
        """Return the comparable content of an element of the old (0) or the new (1) version.

        Args:
            element: the element.
            side: 0 or 1.
            parent: the tag of the element's parent.
        """
        normalize = (self._normalize_old_text, self.normalize_new)[side]
        attributes = frozenset(
            (name, _to_comparable(name, normalize(value))) for name, value in element.attributes.items()
        )
        children = tuple(self._content(child, side, element.tag) for child in element.elements())
        text = _complete_namespace(f"{parent} {element.tag}", normalize(element.text()))
        return element.tag, attributes, normalize_numbers(text), children

    def element_differences(self, name: str, path: str, old: Element, new: Element) -> Iterator[Difference]:
        """Yield the differences between two elements that belong together.

        Args:
            name: the name of the element directly below the robot that contains both elements, or that is compared
                itself.
            path: the names of the elements from there down to the compared elements; empty for elements directly below
                the robot.
            old: the old element.
            new: the new element.
        """
        for attribute in dict.fromkeys([*new.attributes, *old.attributes]):
            old_value, new_value = old.attributes.get(attribute), new.attributes.get(attribute)
            if not self._same_text(old_value, new_value, attribute):
                locations = location_of(old, attribute), location_of(new, attribute)
                yield Difference(
                    "extension", name, "changed", f"{path} @{attribute}".strip(), old_value, new_value, "", *locations
                )
        texts = " ".join(old.text().split()), " ".join(new.text().split())
        if not self._same_text(*(_complete_namespace(path, text) for text in texts)):
            shown = round_numbers(texts[0]), round_numbers(texts[1])
            is_stray = all(any(each.elements()) or not text for each, text in zip((old, new), texts, strict=True))
            text_path = f"{path} {_STRAY_TEXT}".strip() if is_stray else path
            yield Difference("extension", name, "changed", text_path, *shown, "", location_of(old), location_of(new))
        yield from self.child_differences(list(old.elements()), list(new.elements()), path, (name, old, new))

    def _normalize_old_text(self, text: str) -> str:
        return self.renamed.get(text.strip()) or self.normalize_old(text)

    def _same_text(self, old: str | None, new: str | None, attribute: str = "") -> bool:
        if old is None or new is None:
            return old is new
        return _to_comparable(attribute, self._normalize_old_text(old)) == _to_comparable(
            attribute, self.normalize_new(new)
        )


def _complete_namespace(path: str, text: str) -> str:
    """Return the text of an element, with the slash that gazebo_ros adds in front of the namespace of a plugin.

    Source: ``gazebo_ros::Node::Get`` of gazebo_ros_pkgs.

    Args:
        path: the tags of the element and its parents.
        text: the text of the element.
    """
    return f"/{text.strip().removeprefix('/')}" if path.endswith(_PLUGIN_NAMESPACE) else text


def _to_comparable(attribute: str, text: str) -> str:
    """Return the comparable form of a text; names and versions are not read as numbers."""
    return " ".join(text.split()) if attribute in _ATTRIBUTES_WITHOUT_NUMBERS else normalize_numbers(text)


def _index_by_key(elements: Sequence[Element], parts: Mapping[int, str]) -> dict[str, Element]:
    """Return elements in document order, by tag and name or reference.

    The keys of elements with the same tag and name are numbered, unless they are plugins for different parts.
    """
    keyed_elements: dict[str, Element] = {}
    for element in elements:
        name = _find_name(element, parts)
        key = f"{element.tag} {name}" if name else element.tag
        number = 2
        unique_key = key
        while unique_key in keyed_elements:
            unique_key = f"{key} {number}"
            number += 1
        keyed_elements[unique_key] = element
    return keyed_elements


def _remove_common(
    elements: Mapping[str, Element],
    contents: Sequence[Hashable],
    common: Counter[Hashable],
    renamed: Mapping[str, str],
    parts: Mapping[int, str],
) -> _Rest:
    """Return the elements that have no counterpart, with their keys, by tag and name.

    Args:
        elements: the elements by key.
        contents: the contents of the elements.
        common: the number of counterparts of each content.
        renamed: the new names of renamed links and joints, by old name.
        parts: the part of each plugin that has siblings of the same name, by the identity of the element.
    """
    remaining = Counter(common)
    unmatched: _Rest = {}
    for (key, element), content in zip(elements.items(), contents, strict=True):
        if remaining[content]:
            remaining[content] -= 1
        else:
            part = parts.get(id(element), "")
            name = _find_name(element, {id(element): renamed.get(part, part)} if part else {}) or ""
            tag = SAME_TAGS.get(element.tag, element.tag)
            unmatched.setdefault(f"{tag} {renamed.get(name, name)}", []).append((key, element))
    return unmatched


def _join_gazebo_elements(base: str, items: Sequence[tuple[str, Element]]) -> list[tuple[str, Element]]:
    """Return the ``<gazebo>`` elements of a link as one, with the key of a lone one."""
    return [(base.strip(), joined_block([element for _, element in items]))]


def _align_remappings(
    old: list[tuple[str, Element]], new: list[tuple[str, Element]]
) -> tuple[list[tuple[str, Element]], list[tuple[str, Element]]]:
    """Return elements with the same tag and name, the remappings of the same name first, at the same places."""
    aligned_old, aligned_new, others = [], [], list(new)
    for item in old:
        name = find_remapped_name(item[1])
        match = next((other for other in others if name and find_remapped_name(other[1]) == name), None)
        if match is not None:
            aligned_old.append(item)
            aligned_new.append(match)
            others.remove(match)
    return [*aligned_old, *(item for item in old if item not in aligned_old)], [*aligned_new, *others]


def find_remapped_name(element: Element) -> str | None:
    """Return the name that a ``<remapping>`` of a plugin replaces, without the first slash; None for other elements."""
    name, sign, _ = element.text().partition(":=")
    return name.strip().removeprefix("/") if sign and element.tag == "remapping" else None


def _find_name(element: Element, parts: Mapping[int, str]) -> str | None:
    """Return the name that identifies an element among its siblings, or None if it has none.

    The included models of SDF have their names, or else their addresses, in children.
    """
    part = parts.get(id(element))
    if part:
        return f"{element.attributes['name']} ({part})"
    name = element.attributes.get("name") or element.attributes.get("reference")
    if name is None and element.tag == "include":
        child = element.first("name") or element.first("uri")
        name = None if child is None else child.text().strip()
    return name or None


def _to_one_line(element: Element) -> str:
    """Return an element's attributes, text and child tags as one line."""
    words = [f"{name}={value}" for name, value in element.attributes.items()]
    words += round_numbers(element.text()).split()
    words += [f"<{child.tag}>" for child in element.elements()]
    return " ".join(words)
