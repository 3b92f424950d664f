"""Items of lists in YAML that belong together in both versions, so that an inserted item does not shift the others."""

from __future__ import annotations

from difflib import SequenceMatcher

import yaml

from linkwright.review.files.yaml_values import is_structured_list, name_of_item

_MAX_COMPARISONS = 1_000_000
"""The product of the lengths of two lists up to which their items are aligned."""


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
    for _, old_start, old_end, new_start, new_end in matcher.get_opcodes():
        count = min(old_end - old_start, new_end - new_start)
        for offset in range(count):
            first, second = old_items[old_start + offset], new_items[new_start + offset]
            labels[id(first)] = labels[id(second)] = str(new_start + offset)
            pairs.append((first, second))
        for number in range(new_start + count, new_end):
            labels[id(new_items[number])] = str(number)
        for number in range(old_start + count, old_end):
            labels[id(old_items[number])] = f"old {number}"
    return pairs


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
