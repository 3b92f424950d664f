"""Report keys that a YAML file newly repeats in a mapping."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator

import yaml

from linkwright.diagnostics import phrase
from linkwright.review.changes import Change, Location
from linkwright.review.file_pair import FilePair

_MERGE_KEY = "<<"


def report_repeated_keys(pair: FilePair, old: yaml.Node | None, new: yaml.Node | None) -> None:
    """Report the keys that only the new version repeats; programs read the last value, and no error is shown.

    Args:
        pair: both versions of the file.
        old: the root node of the old version.
        new: the root node of the new version.
    """
    known, found = ([_drop_numbers(path) for path, _ in _list_repeated(root, "", set())] for root in (old, new))
    lost = [path for path in known if path not in found]
    for path, key in _list_repeated(new, "", set()):
        text = _drop_numbers(path)
        if text not in known and not any(_are_renamed(other, text) for other in lost):
            mark = key.start_mark
            text = phrase("key '{name}' is repeated in its mapping", name=path)
            pair.changes.append(Change(text, location=Location(pair.new_path, mark.line + 1, mark.column + 1)))


def _are_renamed(old: str, new: str) -> bool:
    """Return whether two paths of a key differ in one name of a mapping that contains it."""
    names = [path.split(".") for path in (old, new)]
    differing = [first != second for first, second in zip(*names, strict=False)]
    return len(names[0]) == len(names[1]) and sum(differing) == 1 and not differing[-1]


def _drop_numbers(path: str) -> str:
    """Return the path of a key without the numbers of list items, which change if an item is added before them."""
    return re.sub(r"\[\d+\]", "[]", path)


def _list_repeated(node: yaml.Node | None, path: str, seen: set[int]) -> Iterator[tuple[str, yaml.Node]]:
    """Yield the paths of repeated keys, with the last key of each. Nodes with aliases are read once."""
    if node is None or id(node) in seen:
        return
    seen.add(id(node))
    if isinstance(node, yaml.SequenceNode):
        for number, item in enumerate(node.value):
            yield from _list_repeated(item, f"{path}[{number}]", seen)
    elif isinstance(node, yaml.MappingNode):
        keys = [key for key, _ in node.value if isinstance(key, yaml.ScalarNode) and key.value != _MERGE_KEY]
        counts = Counter(key.value for key in keys)
        last = {key.value: key for key in keys if counts[key.value] > 1}
        yield from ((_join(path, name), key) for name, key in last.items())
        for key, value in node.value:
            yield from _list_repeated(value, _join(path, key.value), seen)


def _join(path: str, key: object) -> str:
    return f"{path}.{key}" if path else str(key)
