"""Read the texts of a YAML file that are YAML themselves, such as the file that a deployment writes for a node."""

from __future__ import annotations

import re
from collections.abc import Iterator

import yaml

from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.yaml_values import compose_yaml

_KEY = re.compile(r"[\w/.*-]+")
_MIN_KEYS = 2
"""The minimum number of keys of a mapping. A sentence with a colon is a mapping with one key, too."""
_NODE_PARAMETERS = "ros__parameters"
"""The key below which a text is the value of a parameter of a node."""


def read_embedded_texts(root: yaml.Node) -> None:
    """Replace literal block texts that are mappings by the mappings, with their places in the file.

    Args:
        root: the root node of the document, which is changed.
    """
    for parent, index, text in _list_block_texts(root, set()):
        mapping = _read_mapping(text)
        if mapping is not None and isinstance(parent, yaml.MappingNode):
            parent.value[index] = (parent.value[index][0], mapping)


def _list_block_texts(node: yaml.Node, seen: set[int]) -> Iterator[tuple[yaml.MappingNode, int, yaml.ScalarNode]]:
    """Yield the values of mappings that are literal block texts, with their mappings and positions."""
    if id(node) in seen:
        return
    seen.add(id(node))
    if isinstance(node, yaml.SequenceNode):
        for item in node.value:
            yield from _list_block_texts(item, seen)
    elif isinstance(node, yaml.MappingNode):
        for index, (key, value) in enumerate(list(node.value)):
            if isinstance(value, yaml.ScalarNode) and value.style == "|":
                yield node, index, value
            elif key.value != _NODE_PARAMETERS:
                yield from _list_block_texts(value, seen)


def _read_mapping(text: yaml.ScalarNode) -> yaml.MappingNode | None:
    """Return the mapping that a literal block text contains, or None if it is another text."""
    try:
        root = compose_yaml(text.value)
    except UnreadableFileError:
        return None
    if not isinstance(root, yaml.MappingNode) or len(root.value) < _MIN_KEYS:
        return None
    if not all(isinstance(key, yaml.ScalarNode) and _KEY.fullmatch(key.value) for key, _ in root.value):
        return None
    start = text.start_mark
    lines = (start.buffer or "")[start.pointer :].split("\n")[1:]
    first = next((line for line in lines if line.strip()), "")
    _move(root, start.line + 1, len(first) - len(first.lstrip()), set())
    return root


def _move(node: yaml.Node, lines: int, columns: int, seen: set[int]) -> None:
    """Move a node, and those in it, by a number of lines and columns."""
    if id(node) in seen:
        return
    seen.add(id(node))
    mark = node.start_mark
    node.start_mark = yaml.Mark(mark.name, mark.index, mark.line + lines, mark.column + columns, None, 0)
    pairs = node.value if isinstance(node, yaml.MappingNode) else ()
    items = node.value if isinstance(node, yaml.SequenceNode) else (part for pair in pairs for part in pair)
    for item in items:
        _move(item, lines, columns, seen)
