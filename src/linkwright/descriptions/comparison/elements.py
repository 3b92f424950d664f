"""The comparison of XML elements by content: attributes, texts and children, matched by tag and name."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from linkwright.descriptions.comparison.difference import Difference, Kind, location_of
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.xmltree import Element


@dataclass(frozen=True)
class ElementComparison:
    """A comparison of elements that ignores white space, comments and the order of attributes.

    Attributes:
        normalize_old: a function that makes texts of the old version comparable.
        normalize_new: a function that makes texts of the new version comparable.
    """

    normalize_old: Callable[[str], str] = str
    normalize_new: Callable[[str], str] = str

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
        old_by_key, new_by_key = _elements_by_key(old), _elements_by_key(new)
        for key in dict.fromkeys([*new_by_key, *old_by_key]):
            old_element, new_element = old_by_key.get(key), new_by_key.get(key)
            element_path = f"{path} {key}".strip()
            if old_element is not None and new_element is not None:
                name, start_path = (key, "") if enclosing is None else (enclosing[0], element_path)
                yield from self._element_differences(name, start_path, old_element, new_element)
            elif enclosing is None:
                kind: Kind = "added" if old_element is None else "removed"
                yield Difference(
                    "extension", key, kind, "", None, None, "", location_of(old_element), location_of(new_element)
                )
            else:
                texts = (
                    None if old_element is None else _one_line(old_element),
                    None if new_element is None else _one_line(new_element),
                )
                places = location_of(old_element or enclosing[1]), location_of(new_element or enclosing[2])
                yield Difference("extension", enclosing[0], "changed", element_path, *texts, "", *places)

    def _element_differences(self, name: str, path: str, old: Element, new: Element) -> Iterator[Difference]:
        for attribute in dict.fromkeys([*new.attributes, *old.attributes]):
            old_value, new_value = old.attributes.get(attribute), new.attributes.get(attribute)
            if not self._same_text(old_value, new_value):
                places = location_of(old, attribute), location_of(new, attribute)
                yield Difference(
                    "extension", name, "changed", f"{path} @{attribute}".strip(), old_value, new_value, "", *places
                )
        texts = " ".join(old.text().split()), " ".join(new.text().split())
        if not self._same_text(*texts):
            yield Difference("extension", name, "changed", path, *texts, "", location_of(old), location_of(new))
        yield from self.child_differences(list(old.elements()), list(new.elements()), path, (name, old, new))

    def _same_text(self, old: str | None, new: str | None) -> bool:
        if old is None or new is None:
            return old is new
        return " ".join(self.normalize_old(old).split()) == " ".join(self.normalize_new(new).split())


def _elements_by_key(elements: Sequence[Element]) -> dict[str, Element]:
    """Return elements in document order, by tag and name or reference.

    The keys of elements with the same tag and name are numbered.
    """
    keyed_elements: dict[str, Element] = {}
    for element in elements:
        name = element.attributes.get("name") or element.attributes.get("reference")
        key = f"{element.tag} {name}" if name else element.tag
        number = 2
        unique_key = key
        while unique_key in keyed_elements:
            unique_key = f"{key} {number}"
            number += 1
        keyed_elements[unique_key] = element
    return keyed_elements


def _one_line(element: Element) -> str:
    """Return an element's attributes, text and child tags as one line."""
    words = [f"{name}={value}" for name, value in element.attributes.items()]
    words += element.text().split()
    words += [f"<{child.tag}>" for child in element.elements()]
    return " ".join(words)
