"""The differences between the elements of two unexpanded descriptions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from linkwright.descriptions.comparison import GAZEBO
from linkwright.review.parts.outline import Item, items_of, joined_item
from linkwright.review.parts.wording import Wording
from linkwright.xmltree import Element

CONDITION_SEPARATOR = " and "
_MIN_SIMILARITY = 0.5
"""The share of equal children from which an element with another name is a renamed one."""


@dataclass(frozen=True)
class PartDifference:
    """A difference between two unexpanded descriptions.

    Attributes:
        path: the keys of the enclosing elements, the outermost first, and of the element itself.
        value: the attribute, ``text`` for the text of the element, ``conditions``, or empty for the whole element.
        old: the old value, or None if there is none.
        new: the new value, or None if there is none.
        old_element: the old element, or None if there is none.
        new_element: the new element, or None if there is none.
    """

    path: tuple[str, ...]
    value: str
    old: str | None
    new: str | None
    old_element: Element | None
    new_element: Element | None

    @property
    def is_whole(self) -> bool:
        """Whether an element was added or removed."""
        return self.old_element is None or self.new_element is None


@dataclass(frozen=True)
class ItemComparison:
    """A comparison of elements that were not expanded, by tag, name and condition.

    Attributes:
        old: the meaning of names in the old description.
        new: the meaning of names in the new description.
    """

    old: Wording
    new: Wording

    def differences(self, old: Element, new: Element, path: tuple[str, ...] = ()) -> Iterator[PartDifference]:
        """Yield the differences between the contents of two elements."""
        for old_item, new_item in self._pairs(list(items_of(old)), list(items_of(new))):
            item = new_item or old_item
            assert item is not None
            item_path = (*path, item.key)
            if old_item is None or new_item is None:
                yield _whole(item_path, old_item, new_item)
                continue
            yield from self._conditions(old_item, new_item, item_path)
            yield from self._values(old_item.element, new_item.element, item_path)
            yield from self.differences(old_item.element, new_item.element, item_path)

    def _conditions(self, old: Item, new: Item, path: tuple[str, ...]) -> Iterator[PartDifference]:
        texts = [CONDITION_SEPARATOR.join(item.conditions) for item in (old, new)]
        if not self.same(*texts):
            yield PartDifference(path, "conditions", texts[0], texts[1], old.element, new.element)

    def _values(self, old: Element, new: Element, path: tuple[str, ...]) -> Iterator[PartDifference]:
        for name in dict.fromkeys([*new.attributes, *old.attributes]):
            values = old.attributes.get(name), new.attributes.get(name)
            if not self.same(*values):
                yield PartDifference(path, name, *values, old, new)
        texts = [" ".join(element.text().split()) for element in (old, new)]
        if not self.same(*texts):
            yield PartDifference(path, "text", texts[0] or None, texts[1] or None, old, new)

    def same(self, old: str | None, new: str | None) -> bool:
        """Return whether two texts are equal, with names and numbers that mean the same."""
        if old is None or new is None:
            return old is new
        old_text, new_text = self.old.translated(old), self.new.translated(new)
        return old_text == new_text or self.old.resolved(old_text) == self.new.resolved(new_text)

    def _pairs(self, old: Sequence[Item], new: Sequence[Item]) -> Iterator[tuple[Item | None, Item | None]]:
        """Yield the pairs of elements that belong together and may differ, in the order of the new description."""
        old_rest, new_rest = list(old), list(new)

        def is_equal(old_item: Item, new_item: Item) -> bool:
            return self.old.content(old_item.element) == self.new.content(new_item.element)

        def has_same_conditions(old_item: Item, new_item: Item) -> bool:
            return self.same(" ".join(old_item.conditions), " ".join(new_item.conditions))

        def is_identical(old_item: Item, new_item: Item) -> bool:
            return is_equal(old_item, new_item) and has_same_conditions(old_item, new_item)

        pairs: list[tuple[Item | None, Item | None]] = []
        for matches in (is_identical, is_equal):
            pairs += self._matched(old_rest, new_rest, matches)
        pairs += self._joined_blocks(old_rest, new_rest)
        pairs += self._matched(old_rest, new_rest, has_same_conditions)
        pairs += self._matched(old_rest, new_rest, self._left_as_often(old_rest, new_rest))
        pairs += self._renamed(old_rest, new_rest)
        positions = {item.element.offset: number for number, item in enumerate(new)}
        pairs.sort(key=lambda pair: -1 if pair[1] is None else positions[pair[1].element.offset])
        yield from pairs
        yield from ((None, item) for item in new_rest)
        yield from ((item, None) for item in old_rest)

    def _joined_blocks(self, old: list[Item], new: list[Item]) -> list[tuple[Item, Item]]:
        """Remove the ``<gazebo>`` elements of links that have several from two lists, and return them as one a link."""
        pairs = []
        for key in dict.fromkeys(item.key for item in new if item.element.tag == GAZEBO):
            news = [item for item in new if item.key == key]
            olds = [item for item in old if self.old.translated(item.key) == key]
            if not olds or max(len(olds), len(news)) == 1:
                continue
            texts = {self.old.translated(" ".join(item.conditions)) for item in olds}
            texts |= {self.new.translated(" ".join(item.conditions)) for item in news}
            is_common = len(texts) == 1
            old_item, new_item = (joined_item(each, each[0].conditions if is_common else None) for each in (olds, news))
            pairs.append((old_item, new_item))
            old[:] = [item for item in old if item not in olds]
            new[:] = [item for item in new if item not in news]
        return pairs

    def _left_as_often(self, old: Sequence[Item], new: Sequence[Item]) -> Callable[[Item, Item], bool]:
        """Return a function that returns whether the keys of two elements are left as often in both lists."""
        counts = (
            Counter(self.old.translated(item.key) for item in old),
            Counter(item.key for item in new),
        )
        return lambda _, item: counts[0][item.key] == counts[1][item.key]

    def _matched(
        self, old: list[Item], new: list[Item], matches: Callable[[Item, Item], bool]
    ) -> list[tuple[Item, Item]]:
        """Remove the matching pairs with equal keys from two lists, and return them."""
        pairs = []
        for new_item in list(new):
            for old_item in old:
                if self.old.translated(old_item.key) == new_item.key and matches(old_item, new_item):
                    pairs.append((old_item, new_item))
                    old.remove(old_item)
                    new.remove(new_item)
                    break
        return pairs

    def _renamed(self, old: list[Item], new: list[Item]) -> list[tuple[Item, Item]]:
        """Remove the pairs with other names and similar contents from two lists, and return them."""
        pairs = []
        for new_item in list(new):
            candidates = [item for item in old if item.element.tag == new_item.element.tag]
            rivals = [item for item in new if item.element.tag == new_item.element.tag]
            if len(candidates) == len(rivals) == 1 and self._are_bare_links(candidates[0], new_item):
                pairs.append((candidates[0], new_item))
                old.remove(candidates[0])
                new.remove(new_item)
                continue
            best = max(candidates, key=lambda item: self._similarity(item, new_item), default=None)
            if best is not None and self._similarity(best, new_item) >= _MIN_SIMILARITY:
                pairs.append((best, new_item))
                old.remove(best)
                new.remove(new_item)
        return pairs

    def _are_bare_links(self, old: Item, new: Item) -> bool:
        """Return whether two elements are frames: links without contents."""
        return old.element.tag == "link" and not any((*old.element.elements(), *new.element.elements()))

    def _similarity(self, old: Item, new: Item) -> float:
        """Return the share of the children of two elements that are equal."""
        contents = [
            Counter(wording.content(child) for child in item.element.elements())
            for wording, item in ((self.old, old), (self.new, new))
        ]
        total = sum(content.total() for content in contents)
        return 2 * (contents[0] & contents[1]).total() / total if total else 0.0


def _whole(path: tuple[str, ...], old: Item | None, new: Item | None) -> PartDifference:
    """Return the difference of an element that only one of the descriptions has."""
    old_element, new_element = (None if item is None else item.element for item in (old, new))
    old_text, new_text = (None if item is None else summary_of(item) for item in (old, new))
    return PartDifference(path, "", old_text, new_text, old_element, new_element)


def summary_of(item: Item) -> str:
    """Return the attributes and the text of an element in one line, with the conditions around it."""
    element = item.element
    shown = [f"{name}={value}" for name, value in element.attributes.items() if name not in ("name", "reference")]
    conditions = [f"[{CONDITION_SEPARATOR.join(item.conditions)}]"] if item.conditions else []
    return " ".join([*shown, *element.text().split(), *conditions])
