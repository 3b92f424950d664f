"""Items of lists in YAML that belong together in both versions, so that an inserted item does not shift the others."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from difflib import SequenceMatcher

import yaml

from linkwright.review.files.yaml_values import is_structured_list, name_of_item

_MAX_COMPARISONS = 1_000_000
"""The maximum product of the lengths of two lists whose items are aligned."""
_MAX_SIMILARITIES = 2_500
"""The maximum product of the numbers of different items of two lists that are aligned by their contents."""
_MIN_SIMILARITY = 0.4


def item_labels(old: yaml.Node, new: yaml.Node) -> dict[int, str]:
    """Return labels for the items of lists that have no name, by the identity of the item.

    Items that belong together have the same label: the number of the new item.
    """
    labels: dict[int, str] = {}
    visited: set[tuple[int, int]] = set()
    texts: dict[int, str] = {}
    pairs = [(old, new)]
    while pairs:
        first, second = pairs.pop()
        if (id(first), id(second)) in visited:
            continue
        visited.add((id(first), id(second)))
        if isinstance(first, yaml.MappingNode) and isinstance(second, yaml.MappingNode):
            old_values = {str(key.value): value for key, value in first.value}
            pairs += [
                (old_values[name], value) for key, value in second.value if (name := str(key.value)) in old_values
            ]
        elif is_structured_list(first) and is_structured_list(second):
            pairs += _matched_items(first, second, labels, texts)
    return labels


def _matched_items(
    old: yaml.Node, new: yaml.Node, labels: dict[int, str], texts: dict[int, str]
) -> list[tuple[yaml.Node, yaml.Node]]:
    """Label the items of two lists, and return the items that belong together and differ."""
    old_names = {name: item for item in old.value if (name := name_of_item(item)) is not None}
    pairs = [(old_names[name], item) for item in new.value if (name := name_of_item(item)) in old_names]
    old_items, new_items = ([item for item in node.value if name_of_item(item) is None] for node in (old, new))
    if len(old_items) * len(new_items) > _MAX_COMPARISONS:
        return pairs
    old_texts, new_texts = ([_text(item, texts) for item in items] for items in (old_items, new_items))
    matcher = SequenceMatcher(None, old_texts, new_texts, autojunk=False)
    for tag, old_start, old_end, new_start, new_end in matcher.get_opcodes():
        labels |= {id(new_items[number]): str(number) for number in range(new_start, new_end)}
        labels |= {id(old_items[number]): f"old {number}" for number in range(old_start, old_end)}
        matched = (
            zip(range(old_end - old_start), range(new_end - new_start), strict=True)
            if tag == "equal"
            else _similar_items(old_items[old_start:old_end], new_items[new_start:new_end])
        )
        for i, k in matched:
            first, second = old_items[old_start + i], new_items[new_start + k]
            labels[id(first)] = labels[id(second)]
            pairs.append((first, second))
    return pairs


def _similar_items(old: Sequence[yaml.Node], new: Sequence[yaml.Node]) -> list[tuple[int, int]]:
    """Return the numbers of the items that are versions of the same one, in the order of both lists.

    Many items belong together by their order. Others do if they have something in common, or if as many have gone as
    have come.
    """
    in_order = [(number, number) for number in range(min(len(old), len(new)))]
    if len(old) * len(new) > _MAX_SIMILARITIES:
        return in_order
    old_facts, new_facts = (list(map(_facts, items)) for items in (old, new))
    if len(old) == len(new) and all(set(a) & set(b) for a, b in zip(old_facts, new_facts, strict=True)):
        return in_order
    if len(old) == len(new) and not any(isinstance(item, yaml.MappingNode) for item in (*old, *new)):
        return in_order
    best: dict[tuple[int, int], tuple[float, list[tuple[int, int]]]] = {}
    for i in range(len(old) + 1):
        for k in range(len(new) + 1):
            if not i or not k:
                best[i, k] = 0.0, []
                continue
            options = [best[i - 1, k], best[i, k - 1]]
            similarity = _similarity(old_facts[i - 1], new_facts[k - 1])
            if similarity >= _MIN_SIMILARITY:
                total, pairs = best[i - 1, k - 1]
                options.append((total + similarity, [*pairs, (i - 1, k - 1)]))
            best[i, k] = max(options, key=lambda option: option[0])
    return best[len(old), len(new)][1]


def _facts(node: yaml.Node) -> Counter[str]:
    """Return the keys of an item, and its keys with their values."""
    if isinstance(node, yaml.MappingNode):
        values = [(str(key.value), _text(value, {})) for key, value in node.value]
    elif isinstance(node, yaml.SequenceNode):
        values = [(str(number), _text(value, {})) for number, value in enumerate(node.value)]
    else:
        values = [("", _text(node, {}))]
    return Counter(f"{key}={value}" for key, value in values)


def _similarity(old: Counter[str], new: Counter[str]) -> float:
    total = old.total() + new.total()
    return 2 * (old & new).total() / total if total else 1.0


def _text(node: yaml.Node, texts: dict[int, str]) -> str:
    """Return the content of a node as text, which is equal for equal content."""
    if id(node) not in texts:
        if isinstance(node, yaml.MappingNode):
            items = sorted(f"{key.value}: {_text(value, texts)}" for key, value in node.value)
            texts[id(node)] = f"{{{', '.join(items)}}}"
        elif isinstance(node, yaml.SequenceNode):
            texts[id(node)] = f"[{', '.join(_text(item, texts) for item in node.value)}]"
        else:
            texts[id(node)] = str(node.value)
    return texts[id(node)]
