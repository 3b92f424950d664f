"""Match the list items of two YAML documents.

An inserted item does not shift the following items.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from difflib import SequenceMatcher

import yaml

from linkwright.review.files.parameters.yaml_values import find_item_name, is_structured_list

_MAX_COMPARISONS = 1_000_000
"""The maximum product of the lengths of two lists whose items are aligned."""
_MAX_SIMILARITIES = 2_500
"""The maximum product of the numbers of different items of two lists that are aligned by their contents."""
_MIN_SIMILARITY = 0.4
_MAX_DEPTH = 4
"""The maximum depth in an item at which values are compared one by one."""


def find_item_labels(old: yaml.Node, new: yaml.Node) -> dict[int, str]:
    """Return labels for the items of lists that have no name, by the identity of the item.

    Matched items have the same label: the number of the new item.
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
            pairs += _match_items(first, second, labels, texts)
    return labels


def _match_items(
    old: yaml.Node, new: yaml.Node, labels: dict[int, str], texts: dict[int, str]
) -> list[tuple[yaml.Node, yaml.Node]]:
    """Label the items of two lists, and return the matched items that differ.

    If only one version has names for its items, items match by their other values.
    """
    old_names, new_names = (
        {name: item for item in node.value if (name := find_item_name(item)) is not None} for node in (old, new)
    )
    pairs = [(old_names[name], item) for item in new.value if (name := find_item_name(item)) in old_names]
    old_items, new_items = ([item for item in node.value if find_item_name(item) is None] for node in (old, new))
    if len(old_items) * len(new_items) > _MAX_COMPARISONS:
        return pairs
    labels |= {id(item): str(number) for number, item in enumerate(new_items)}
    labels |= {id(item): f"old {number}" for number, item in enumerate(old_items)}
    for i, k in _align(old_items, new_items, texts):
        labels[id(old_items[i])] = labels[id(new_items[k])]
        pairs.append((old_items[i], new_items[k]))
    if old_items and not new_items:
        named = [(name, item) for name, item in new_names.items() if name not in old_names]
        for i, k in _match_similar_items(old_items, [item for _, item in named]):
            labels[id(old_items[i])] = named[k][0]
            pairs.append((old_items[i], named[k][1]))
    elif new_items and not old_items:
        named = [(name, item) for name, item in old_names.items() if name not in new_names]
        for i, k in _match_similar_items([item for _, item in named], new_items):
            labels[id(new_items[k])] = named[i][0]
            pairs.append((named[i][1], new_items[k]))
    return pairs


def _align(old: Sequence[yaml.Node], new: Sequence[yaml.Node], texts: dict[int, str]) -> Iterator[tuple[int, int]]:
    """Yield the indexes of matched items: the smallest edit, or for long lists a small one."""
    old_texts, new_texts = ([format_content(item, texts) for item in items] for items in (old, new))
    anchors: list[tuple[int, int]] = []
    if len(old) * len(new) <= _MAX_SIMILARITIES:
        anchors = _find_best_pairs(list(map(_count_values, old)), list(map(_count_values, new)))
    else:
        matcher = SequenceMatcher(None, old_texts, new_texts, autojunk=False)
        for start, new_start, size in matcher.get_matching_blocks():
            anchors += [(start + number, new_start + number) for number in range(size)]
    i, k = 0, 0
    for next_i, next_k in [*anchors, (len(old), len(new))]:
        yield from ((i + a, k + b) for a, b in _match_similar_items(old[i:next_i], new[k:next_k]))
        if next_i < len(old):
            yield next_i, next_k
        i, k = next_i + 1, next_k + 1


def _match_similar_items(old: Sequence[yaml.Node], new: Sequence[yaml.Node]) -> list[tuple[int, int]]:
    """Return the indexes of matched items in the order of both lists.

    Long lists match by order. Other items match if they have common values, or if the same number of
    items was removed and added.
    """
    in_order = [(number, number) for number in range(min(len(old), len(new)))]
    if len(old) * len(new) > _MAX_SIMILARITIES:
        return in_order
    old_facts, new_facts = (list(map(_count_values, items)) for items in (old, new))
    if len(old) == len(new) and all(set(a) & set(b) for a, b in zip(old_facts, new_facts, strict=True)):
        return in_order
    if len(old) == len(new) and not any(isinstance(item, yaml.MappingNode) for item in (*old, *new)):
        return in_order
    return _find_best_pairs(old_facts, new_facts)


def _find_best_pairs(old: Sequence[Counter[str]], new: Sequence[Counter[str]]) -> list[tuple[int, int]]:
    """Return the indexes of the most similar items in the order of both lists."""
    best_scores = [[0.0] * (len(new) + 1) for _ in range(len(old) + 1)]
    scores = [[_compute_similarity(a, b) for b in new] for a in old]
    for i, row in enumerate(scores, 1):
        for k, similarity in enumerate(row, 1):
            paired_score = best_scores[i - 1][k - 1] + similarity if similarity >= _MIN_SIMILARITY else 0.0
            best_scores[i][k] = max(best_scores[i - 1][k], best_scores[i][k - 1], paired_score)
    pairs = []
    i, k = len(old), len(new)
    while i and k:
        if best_scores[i][k] == best_scores[i - 1][k]:
            i -= 1
        elif best_scores[i][k] == best_scores[i][k - 1]:
            k -= 1
        else:
            i, k = i - 1, k - 1
            pairs.append((i, k))
    return pairs[::-1]


def _count_values(node: yaml.Node) -> Counter[str]:
    """Return the paths of the values in an item, each with its value."""
    return Counter(_walk_values(node, "", 0))


def _walk_values(node: yaml.Node, path: str, depth: int) -> Iterator[str]:
    children: list[tuple[str, yaml.Node]] = []
    if isinstance(node, yaml.MappingNode):
        children = [(str(key.value), value) for key, value in node.value]
    elif isinstance(node, yaml.SequenceNode):
        children = [(str(number), value) for number, value in enumerate(node.value)]
    if not children or depth >= _MAX_DEPTH:
        yield f"{path}={format_content(node, {})}"
        return
    for key, value in children:
        yield from _walk_values(value, f"{path}.{key}", depth + 1)


def _compute_similarity(old: Counter[str], new: Counter[str]) -> float:
    total = old.total() + new.total()
    return 2 * (old & new).total() / total if total else 1.0


def format_content(node: yaml.Node, texts: dict[int, str]) -> str:
    """Return the content of a node as text, which is equal for equal content."""
    if id(node) not in texts:
        if isinstance(node, yaml.MappingNode):
            items = sorted(f"{key.value}: {format_content(value, texts)}" for key, value in node.value)
            texts[id(node)] = f"{{{', '.join(items)}}}"
        elif isinstance(node, yaml.SequenceNode):
            texts[id(node)] = f"[{', '.join(format_content(item, texts) for item in node.value)}]"
        else:
            texts[id(node)] = str(node.value)
    return texts[id(node)]
