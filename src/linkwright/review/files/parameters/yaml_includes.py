"""Resolve includes of YAML files: list items, mapping keys, or the tag ``!include``."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path

import yaml

from linkwright.diagnostics import phrase, quoted_names
from linkwright.review.changes import Location
from linkwright.review.file_pair import FilePair, LimitError, UnreadableFileError
from linkwright.review.files.parameters.yaml_values import collect_values, compose_yaml

_INCLUDE_KEYS = ("include", "$include")
_TAG = "!include"
_MAX_DEPTH = 5
_MAX_INCLUDES = 200
"""The maximum number of includes of a file that are read, including nested includes."""
_MAX_BYTES = 1 << 20


def resolve_includes(pair: FilePair, old: yaml.Node, new: yaml.Node) -> tuple[yaml.Node, yaml.Node]:
    """Return two documents with the included files that differ, which are reported.

    A value that moves into an included file is then unchanged. Files that both documents include are not resolved.
    Documents with too many values are returned unchanged.
    """
    readers = _Includes(pair.old_file, pair.versions.old.root), _Includes(pair.new_file, pair.versions.new.root)
    positions = [dict(reader.names(root)) for reader, root in zip(readers, (old, new), strict=True)]
    added, removed = ([name for name in own if name not in other] for own, other in (positions[::-1], positions))
    if added:
        line, column = positions[1][added[0]]
        text = phrase("included files added: {names}", names=quoted_names(added))
        pair.add(text, Location(pair.new_path, line, column))
    if removed:
        line, column = positions[0][removed[0]]
        text = phrase("included files removed: {names}", names=quoted_names(removed))
        pair.add(text, Location(pair.old_path, line, column, is_old=True))
    expanded = readers[0].expand(old, removed), readers[1].expand(new, added)
    try:
        for root in expanded if added or removed else ():
            collect_values(root, {})
    except LimitError:
        return old, new
    return expanded


@dataclass(frozen=True)
class _Includes:
    """The files that a YAML file of a version includes.

    Attributes:
        file: the YAML file with the includes.
        root: the root folder of the version.
        counter: counts the includes that were read.
    """

    file: Path
    root: Path
    counter: Iterator[int] = field(default_factory=count)

    def names(self, node: yaml.Node) -> Iterator[tuple[str, tuple[int, int]]]:
        """Yield the names of the existing included files, with line and column."""
        name = self._find_included_name(node)
        if name is not None:
            yield name, (node.start_mark.line + 1, node.start_mark.column + 1)
        elif isinstance(node, yaml.MappingNode):
            for key, value in node.value:
                included = self._find_included_by_key(key, value)
                if included is not None:
                    yield included, (key.start_mark.line + 1, key.start_mark.column + 1)
                else:
                    yield from self.names(value)
        elif isinstance(node, yaml.SequenceNode):
            for item in node.value:
                yield from self.names(item)

    def expand(self, node: yaml.Node, names: Collection[str], depth: int = 0) -> yaml.Node:
        """Return a node with the contents of some of the included files."""
        if not names or depth > _MAX_DEPTH:
            return node
        name = self._find_included_name(node)
        if name in names:
            return self._read_content(name or "", node, depth) or node
        if isinstance(node, yaml.MappingNode):
            items: list[tuple[yaml.Node, yaml.Node]] = []
            for key, value in node.value:
                included = self._find_included_by_key(key, value)
                content = self._read_content(included, key, depth) if included in names and included else None
                if isinstance(content, yaml.MappingNode):
                    items += content.value
                else:
                    items.append((key, self.expand(value, names, depth)))
            return yaml.MappingNode(node.tag, items, node.start_mark, node.end_mark, node.flow_style)
        if isinstance(node, yaml.SequenceNode):
            values: list[yaml.Node] = []
            for item in node.value:
                content = self.expand(item, names, depth)
                is_list = (
                    content is not item
                    and self._find_included_name(item) in names
                    and isinstance(content, yaml.SequenceNode)
                )
                values += content.value if is_list else [content]
            return yaml.SequenceNode(node.tag, values, node.start_mark, node.end_mark, node.flow_style)
        return node

    def _find_included_name(self, node: yaml.Node) -> str | None:
        """Return the name of the file that a node includes as a whole, or None for other nodes."""
        if isinstance(node, yaml.ScalarNode):
            return self._find_existing_file(str(node.value)) if node.tag == _TAG else None
        if isinstance(node, yaml.MappingNode) and len(node.value) == 1:
            return self._find_included_by_key(*node.value[0])
        return None

    def _find_included_by_key(self, key: yaml.Node, value: yaml.Node) -> str | None:
        is_include = (
            isinstance(key, yaml.ScalarNode) and key.value in _INCLUDE_KEYS and isinstance(value, yaml.ScalarNode)
        )
        return self._find_existing_file(str(value.value)) if is_include else None

    def _find_existing_file(self, name: str) -> str | None:
        file = self.file.parent / name
        is_inside = bool(name) and file.is_file() and file.resolve().is_relative_to(self.root.resolve())
        return name if is_inside and file.stat().st_size <= _MAX_BYTES else None

    def _read_content(self, name: str, include: yaml.Node, depth: int) -> yaml.Node | None:
        """Return the content of an included file, with the location of the include.

        Returns None if the file cannot be read, or if too many were read.
        """
        file = self.file.parent / name
        if next(self.counter) >= _MAX_INCLUDES:
            return None
        try:
            root = compose_yaml(file.read_text(encoding="utf-8"))
        except (UnreadableFileError, OSError, ValueError):
            return None
        if root is None:
            return None
        inner = _Includes(file, self.root, self.counter)
        root = inner.expand(root, [inner_name for inner_name, _ in inner.names(root)], depth + 1)
        _move_to_include(root, include)
        return root


def _move_to_include(node: yaml.Node, include: yaml.Node) -> None:
    """Set the location of a node and all its descendants to the location of the include."""
    pending = [node]
    while pending:
        current = pending.pop()
        current.start_mark = include.start_mark
        if isinstance(current, yaml.MappingNode):
            pending += [part for pair in current.value for part in pair]
        elif isinstance(current, yaml.SequenceNode):
            pending += current.value
