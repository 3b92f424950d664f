"""Find the differences between the elements of two unexpanded descriptions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from linkwright.descriptions.comparison import GAZEBO, find_remapped_name
from linkwright.review.parts.name_substitution import CALL, NameSubstitution
from linkwright.review.parts.outline import STATEMENTS, Item, iterate_items, join_items
from linkwright.review.texts.element_values import format_own_content
from linkwright.xmltree import Element

CONDITION_SEPARATOR = " and "
BLOCK = "block"
"""The value of a difference between an element and a block that the caller of a macro passes."""
_INSERT = "xacro:insert_block"
_MIN_SIMILARITY = 0.5
"""The minimum share of equal children of a renamed element."""


@dataclass(frozen=True)
class PartDifference:
    """A difference between two unexpanded descriptions.

    Attributes:
        path: the keys of the enclosing elements, the outermost first, and of the element itself.
        value: the name of the attribute, ``text``, ``conditions``, `BLOCK` if a block of the caller takes the
            place of the element or the reverse, or empty for the whole element.
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
        old: the substitution of names in the old description.
        new: the substitution of names in the new description.
    """

    old: NameSubstitution
    new: NameSubstitution

    def differences(self, old: Element, new: Element, path: tuple[str, ...] = ()) -> Iterator[PartDifference]:
        """Yield the differences between the contents of two elements."""
        matches = list(self._match_items(list(iterate_items(old)), list(iterate_items(new))))
        for old_item, new_item in _pair_blocks(matches):
            item = new_item or old_item
            assert item is not None
            item_path = (*path, item.key)
            if old_item is None or new_item is None:
                yield _make_whole_difference(item_path, old_item, new_item)
                continue
            yield from self._compare_conditions(old_item, new_item, item_path)
            if (old_item.element.tag == _INSERT) != (new_item.element.tag == _INSERT):
                path_of_part = (*path, (old_item if new_item.element.tag == _INSERT else new_item).key)
                old_text, new_text = (format_own_content(each.element) for each in (old_item, new_item))
                yield PartDifference(path_of_part, BLOCK, old_text, new_text, old_item.element, new_item.element)
                continue
            yield from self._compare_values(old_item.element, new_item.element, item_path)
            yield from self.differences(old_item.element, new_item.element, item_path)

    def _compare_conditions(self, old: Item, new: Item, path: tuple[str, ...]) -> Iterator[PartDifference]:
        texts = [CONDITION_SEPARATOR.join(item.conditions) for item in (old, new)]
        if not self.are_equal_texts(*texts):
            yield PartDifference(path, "conditions", texts[0], texts[1], old.element, new.element)

    def _compare_values(self, old: Element, new: Element, path: tuple[str, ...]) -> Iterator[PartDifference]:
        for name in dict.fromkeys([*new.attributes, *old.attributes]):
            values = old.attributes.get(name), new.attributes.get(name)
            if not self.are_equal_texts(*values):
                yield PartDifference(path, name, *values, old, new)
        texts = [" ".join(element.text().split()) for element in (old, new)]
        if not self.are_equal_texts(*texts):
            yield PartDifference(path, "text", texts[0] or None, texts[1] or None, old, new)

    def are_equal_texts(self, old: str | None, new: str | None) -> bool:
        """Return whether two texts are equal after substitution of names and numbers."""
        if old is None or new is None:
            return old is new
        old_text, new_text = self.old.rename_names(old), self.new.rename_names(new)
        return old_text == new_text or self.old.resolve_values(old_text) == self.new.resolve_values(new_text)

    def _match_items(self, old: Sequence[Item], new: Sequence[Item]) -> Iterator[tuple[Item | None, Item | None]]:
        """Yield the matched pairs of elements in the order of the new description.

        Elements without a match follow, with None as the other element.
        """
        remaining_old, remaining_new = list(old), list(new)

        def is_equal(old_item: Item, new_item: Item) -> bool:
            return self.old.normalize_element(old_item.element) == self.new.normalize_element(new_item.element)

        def has_same_conditions(old_item: Item, new_item: Item) -> bool:
            return self.are_equal_texts(" ".join(old_item.conditions), " ".join(new_item.conditions))

        def is_identical(old_item: Item, new_item: Item) -> bool:
            return is_equal(old_item, new_item) and has_same_conditions(old_item, new_item)

        def remap_same_name(old_item: Item, new_item: Item) -> bool:
            name = find_remapped_name(new_item.element)
            return name is not None and find_remapped_name(old_item.element) == name

        pairs: list[tuple[Item | None, Item | None]] = []
        for matches in (is_identical, is_equal, remap_same_name):
            pairs += self._take_matched(remaining_old, remaining_new, matches)
        pairs += self._take_joined_blocks(remaining_old, remaining_new)
        pairs += self._take_matched(remaining_old, remaining_new, has_same_conditions)
        pairs += self._take_matched(remaining_old, remaining_new, self._make_count_check(remaining_old, remaining_new))
        pairs += self._take_renamed(remaining_old, remaining_new)
        positions = {item.element.offset: number for number, item in enumerate(new)}
        pairs.sort(key=lambda pair: -1 if pair[1] is None else positions[pair[1].element.offset])
        yield from pairs
        yield from ((None, item) for item in remaining_new)
        yield from ((item, None) for item in remaining_old)

    def _take_joined_blocks(self, old: list[Item], new: list[Item]) -> list[tuple[Item, Item]]:
        """Remove repeated ``<gazebo>`` elements of a link from both lists, and return them joined."""
        pairs = []
        for key in dict.fromkeys(self.new.rename_key(item) for item in new if item.element.tag == GAZEBO):
            new_items = [item for item in new if self.new.rename_key(item) == key]
            old_items = [item for item in old if self.old.rename_key(item) == key]
            if not old_items or max(len(old_items), len(new_items)) == 1:
                continue
            texts = {self.old.rename_names(" ".join(item.conditions)) for item in old_items}
            texts |= {self.new.rename_names(" ".join(item.conditions)) for item in new_items}
            is_common = len(texts) == 1
            old_item, new_item = (
                join_items(items, items[0].conditions if is_common else None) for items in (old_items, new_items)
            )
            pairs.append((old_item, new_item))
            old[:] = [item for item in old if item not in old_items]
            new[:] = [item for item in new if item not in new_items]
        return pairs

    def _make_count_check(self, old: Sequence[Item], new: Sequence[Item]) -> Callable[[Item, Item], bool]:
        """Return a function that checks that a key occurs equally often in both lists."""
        counts = (
            Counter(self.old.rename_key(item) for item in old),
            Counter(self.new.rename_key(item) for item in new),
        )

        def is_equally_frequent(_: Item, item: Item) -> bool:
            key = self.new.rename_key(item)
            return counts[0][key] == counts[1][key]

        return is_equally_frequent

    def _take_matched(
        self, old: list[Item], new: list[Item], matches: Callable[[Item, Item], bool]
    ) -> list[tuple[Item, Item]]:
        """Remove the matching elements with equal keys from both lists, and return them as pairs."""
        pairs = []
        for new_item in list(new):
            for old_item in old:
                if self.old.rename_key(old_item) == self.new.rename_key(new_item) and matches(old_item, new_item):
                    pairs.append((old_item, new_item))
                    old.remove(old_item)
                    new.remove(new_item)
                    break
        return pairs

    def _take_renamed(self, old: list[Item], new: list[Item]) -> list[tuple[Item, Item]]:
        """Remove the renamed elements from both lists, and return them as pairs.

        Their contents are similar.
        """
        pairs = []
        for new_item in list(new):
            candidates = [item for item in old if item.element.tag == new_item.element.tag]
            rivals = [item for item in new if item.element.tag == new_item.element.tag]
            if len(candidates) == len(rivals) == 1 and self._are_bare_links(candidates[0], new_item):
                pairs.append((candidates[0], new_item))
                old.remove(candidates[0])
                new.remove(new_item)
                continue
            if len(candidates) == len(rivals) == 1 and self._has_call_lost_name(candidates[0], new_item):
                pairs.append((candidates[0], new_item))
                old.remove(candidates[0])
                new.remove(new_item)
                continue
            calls = [item for item in candidates if self._are_calls_with_other_name(item, new_item)]
            if len(calls) == sum(self._are_calls_with_other_name(calls[0], item) for item in rivals if calls) == 1:
                pairs.append((calls[0], new_item))
                old.remove(calls[0])
                new.remove(new_item)
                continue
            best = max(candidates, key=lambda item: self._compute_similarity(item, new_item), default=None)
            if best is not None and self._compute_similarity(best, new_item) >= _MIN_SIMILARITY:
                pairs.append((best, new_item))
                old.remove(best)
                new.remove(new_item)
        return pairs

    def _are_bare_links(self, old: Item, new: Item) -> bool:
        """Return whether two elements are frames: links without contents."""
        return old.element.tag == "link" and not any((*old.element.elements(), *new.element.elements()))

    def _has_call_lost_name(self, old: Item, new: Item) -> bool:
        """Return whether two elements call one macro under equal conditions, the new one without a name."""
        if not new.element.tag.startswith(CALL) or new.element.tag in STATEMENTS:
            return False
        is_lost = "name" in old.element.attributes and "name" not in new.element.attributes
        return is_lost and self.are_equal_texts(" ".join(old.conditions), " ".join(new.conditions))

    def _are_calls_with_other_name(self, old: Item, new: Item) -> bool:
        """Return whether two elements call one macro under equal conditions, with equal arguments except the name."""
        contents = [
            substitution.normalize_element(item.element) for substitution, item in ((self.old, old), (self.new, new))
        ]
        if not contents[1].tag.startswith(CALL) or new.element.tag in STATEMENTS or len(contents[1].attributes) < 2:
            return False
        before, after = (
            content._replace(attributes=frozenset(item for item in content.attributes if item[0] != "name"))
            for content in contents
        )
        conditions = (" ".join(item.conditions) for item in (old, new))
        return before == after and self.are_equal_texts(*conditions)

    def _compute_similarity(self, old: Item, new: Item) -> float:
        """Return the share of equal children of two elements, from 0 to 1."""
        contents = [
            Counter(substitution.normalize_element(child) for child in item.element.elements())
            for substitution, item in ((self.old, old), (self.new, new))
        ]
        total = sum(content.total() for content in contents)
        return 2 * (contents[0] & contents[1]).total() / total if total else 0.0


_Match = tuple[Item | None, Item | None]


def _pair_blocks(matches: Sequence[_Match]) -> Iterator[_Match]:
    """Yield the matches, with a block of the caller as the other version of the element that it replaces.

    Such a block has the tag of the element as its name, as in ``params="*origin"``.
    """
    lone = {is_old: [match[not is_old] for match in matches if match[is_old] is None] for is_old in (True, False)}
    pairs: dict[int, Item] = {}
    for is_old in (True, False):
        for block in lone[is_old]:
            tag = None if block is None or block.element.tag != _INSERT else block.element.attributes.get("name")
            candidates = [item for item in lone[not is_old] if item is not None and item.element.tag == tag]
            if block is not None and len(candidates) == 1:
                pairs[id(block)], pairs[id(candidates[0])] = candidates[0], block
    for old, new in matches:
        if old is None and new is not None and id(new) in pairs:
            yield pairs[id(new)], new
        elif old is None or new is not None or id(old) not in pairs:
            yield old, new


def _make_whole_difference(path: tuple[str, ...], old: Item | None, new: Item | None) -> PartDifference:
    """Return the difference for an element that only one of the descriptions has."""
    old_element, new_element = (None if item is None else item.element for item in (old, new))
    old_text, new_text = (None if item is None else summarize(item) for item in (old, new))
    return PartDifference(path, "", old_text, new_text, old_element, new_element)


def summarize(item: Item) -> str:
    """Return the attributes, text and conditions of an element in one line."""
    element = item.element
    shown = [f"{name}={value}" for name, value in element.attributes.items() if name not in ("name", "reference")]
    conditions = [f"[{CONDITION_SEPARATOR.join(item.conditions)}]"] if item.conditions else []
    return " ".join([*shown, *element.text().split(), *conditions])
