"""YAML as a tree that is edited in place.

Values without edits keep their spelling. RViz's files contain many keys that this program does not use. The tree
consists of PyYAML's nodes, which preserve the order of keys, the quoting and the spelling of every scalar, and the line
number of every value.
"""

from __future__ import annotations

import re
from bisect import bisect
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import yaml

from linkwright.diagnostics import Diagnostic, LinkwrightError, SourceText, Span, foreign, phrase

_Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_Resolver: Any = yaml.resolver.Resolver

MAX_DEPTH = 100
"""The deepest nesting that is read. PyYAML builds nodes by recursion, without a limit."""

MAX_NODES = 1_000_000
"""The largest number of nodes after aliases are expanded. A few lines of YAML can expand to billions of nodes."""

_STRING = "tag:yaml.org,2002:str"
_NULL = "tag:yaml.org,2002:null"
_MAPPING = "tag:yaml.org,2002:map"
_SEQUENCE = "tag:yaml.org,2002:seq"


@dataclass(frozen=True, slots=True)
class Scalar:
    """A scalar with its spelling and its position in the file."""

    text: str
    span: Span


@dataclass(frozen=True, slots=True)
class SavedEntry:
    """A key of a mapping and its previous value, or None if the mapping did not have the key."""

    key: str
    value: yaml.Node | None


class Section:
    """A mapping in an RViz configuration file.

    A path of keys identifies a scalar. If a value has children, RViz stores the value itself under ``Value`` in the
    mapping of the children. A path that ends at such a mapping refers to that value.
    """

    def __init__(self, node: yaml.MappingNode, source: SourceText) -> None:
        self.node = node
        self.source = source

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Section) and self.node is other.node

    def __hash__(self) -> int:
        return id(self.node)

    def keys(self) -> list[str]:
        """Return the keys, in the order of the file."""
        return [key.value for key, _ in self.node.value if isinstance(key, yaml.ScalarNode)]

    def scalar(self, *path: str) -> Scalar | None:
        """Return the scalar at a path, or None if there is none or if the scalar is null."""
        node = self._find_scalar(path)
        return None if node is None else Scalar(node.value, self.span(node))

    def text(self, *path: str) -> str | None:
        """Return the text of the scalar at a path, or None.

        This is faster than `scalar`, which adds the position.
        """
        node = self._find_scalar(path)
        return None if node is None else str(node.value)

    def section(self, *path: str) -> Section | None:
        """Return the mapping at a path, or None if there is no mapping there."""
        node = self._find(path)
        return Section(node, self.source) if isinstance(node, yaml.MappingNode) else None

    def sections(self, *path: str) -> Iterator[Section]:
        """Yield the mappings in the sequence at a path, skipping other items."""
        node = self._find(path)
        if isinstance(node, yaml.SequenceNode):
            for item in node.value:
                if isinstance(item, yaml.MappingNode):
                    yield Section(item, self.source)

    def put(self, path: tuple[str, ...], text: str, *, string: bool = False, nested: bool = False) -> None:
        """Set the scalar at a path, creating missing mappings along the path.

        Args:
            path: keys, at least one.
            text: the spelling of the value.
            string: whether the value is a string regardless of its spelling (it is then quoted if necessary).
            nested: whether the value has children, so that it is stored under ``Value``.
        """
        tag = _STRING if string else _Resolver().resolve(yaml.ScalarNode, text, (True, False))
        parent = self.node
        for key in path[:-1]:
            parent = _get_or_create_mapping(parent, key)
        existing_node = _find_child(parent, path[-1])
        # RViz 1 writes a topic as a scalar, although in RViz 2 its settings are children of the topic.
        is_scalar = isinstance(existing_node, yaml.ScalarNode) and existing_node.tag != _NULL
        if isinstance(existing_node, yaml.MappingNode) or (nested and not is_scalar):
            parent, last_key = _get_or_create_mapping(parent, path[-1]), "Value"
        else:
            last_key = path[-1]
        _set_value(parent, last_key, yaml.ScalarNode(tag, text))

    def copy_entry(self, key: str) -> SavedEntry:
        """Return a copy of a key and its value, for `restore`."""
        node = _find_child(self.node, key)
        return SavedEntry(key, None if node is None else _copy(node))

    def restore(self, saved_entry: SavedEntry) -> None:
        """Restore the previous value of a key, or remove the key if it had no value."""
        if saved_entry.value is not None:
            _set_value(self.node, saved_entry.key, _copy(saved_entry.value))
            return
        self.node.value[:] = [pair for pair in self.node.value if pair[0].value != saved_entry.key]

    def span(self, node: yaml.Node | None = None) -> Span:
        """Return the range of a node in the file, by default the range of this mapping."""
        return _get_span(node or self.node, self.source)

    def _find_scalar(self, path: tuple[str, ...]) -> yaml.ScalarNode | None:
        node = self._find(path)
        if isinstance(node, yaml.MappingNode):
            node = _find_child(node, "Value")
        return node if isinstance(node, yaml.ScalarNode) and node.tag != _NULL else None

    def _find(self, path: tuple[str, ...]) -> yaml.Node | None:
        node: yaml.Node | None = self.node
        for key in path:
            if not isinstance(node, yaml.MappingNode):
                return None
            node = _find_child(node, key)
        return node


def parse(text: str, name: str) -> Section:
    """Return the root mapping of a document.

    Raises:
        LinkwrightError: RVIZ102, the text is not YAML or is nested too deep; RVIZ103, its root is not a mapping.
    """
    source = SourceText(name, text)
    try:
        _check_depth(text, source)
        # RViz reads only the first document of a file.
        root = next(yaml.compose_all(text, Loader=_Loader), None)
    except yaml.YAMLError as error:
        raise LinkwrightError(_make_yaml_diagnostic(error, source)) from None
    if not isinstance(root, yaml.MappingNode):
        message = (
            phrase("'{name}' is empty", name=name)
            if root is None
            else phrase("'{name}' is not a mapping of keys to values", name=name)
        )
        hint = phrase("an RViz configuration begins with 'Panels:' and 'Visualization Manager:'")
        raise LinkwrightError(Diagnostic("RVIZ103", message, source.span(0, 0), hint=hint, source=source))
    if "*" in text:
        _expand_aliases(root, source)
    return Section(root, source)


def write(section: Section) -> str:
    """Return the document as text, preserving key order, scalars and layout of the source."""
    return _format_in_layout(section.node, section.source.text)


def are_same(first: Section, other: Section) -> bool:
    """Return whether two documents would be written as the same text."""
    return _format_in_default_layout(first.node) == _format_in_default_layout(other.node)


def new_section(source: SourceText) -> Section:
    """Return an empty mapping that is not part of a document."""
    return Section(yaml.MappingNode(_MAPPING, [], flow_style=False), source)


def copy_section(section: Section) -> Section:
    """Return a copy of a mapping that is not part of a document."""
    node = _copy(section.node)
    assert isinstance(node, yaml.MappingNode)
    return Section(node, section.source)


def insert_section(parent: Section, key: str, section: Section, before: Section | None = None) -> None:
    """Insert a mapping into the sequence under a key.

    The sequence is created if it is missing.

    Args:
        parent: the mapping with the key.
        key: the key of the sequence.
        section: the mapping to insert.
        before: the item to insert before; None or an unknown item to append.
    """
    sequence = _find_child(parent.node, key)
    if not isinstance(sequence, yaml.SequenceNode):
        sequence = yaml.SequenceNode(_SEQUENCE, [], flow_style=False)
        _set_value(parent.node, key, sequence)
    elif sequence.flow_style and not sequence.value:
        sequence.flow_style = False
    items = sequence.value
    insert_index = next(
        (index for index, item in enumerate(items) if before is not None and item is before.node), len(items)
    )
    items.insert(insert_index, section.node)


def remove_section(parent: Section, key: str, section: Section) -> None:
    """Remove a mapping from the sequence under a key."""
    sequence = _find_child(parent.node, key)
    if isinstance(sequence, yaml.SequenceNode):
        sequence.value[:] = [item for item in sequence.value if item is not section.node]


def get_items(parent: Section, key: str) -> list[yaml.Node] | None:
    """Return the item nodes of the sequence under a key, or None if the key has no sequence."""
    sequence = _find_child(parent.node, key)
    return list(sequence.value) if isinstance(sequence, yaml.SequenceNode) else None


@dataclass(frozen=True, slots=True)
class SavedSequence:
    """The previous node of a key, without a copy, and its items if the node was a sequence."""

    node: yaml.Node | None
    items: list[yaml.Node] | None


def copy_sequence(parent: Section, key: str) -> SavedSequence:
    """Return the current node of a key and the items of its sequence, for `restore_sequence`."""
    return SavedSequence(_find_child(parent.node, key), get_items(parent, key))


def restore_sequence(parent: Section, key: str, saved_sequence: SavedSequence) -> None:
    """Restore the node and the items that `copy_sequence` returned for a key."""
    if saved_sequence.node is None:
        parent.restore(SavedEntry(key, None))
        return
    if isinstance(saved_sequence.node, yaml.SequenceNode):
        saved_sequence.node.value[:] = saved_sequence.items or []
    _set_value(parent.node, key, saved_sequence.node)


@dataclass(frozen=True, slots=True)
class NewSection:
    """A mapping that was created on demand, for `remove_unchanged`.

    Attributes:
        parent: the mapping that contains the new mapping.
        saved_entry: the previous value of the holder's key.
        section: the new mapping.
        keys: the keys that the new mapping had when it was created.
    """

    parent: Section
    saved_entry: SavedEntry
    section: Section
    keys: list[str]


def make_section(section: Section, *path: str) -> tuple[Section, list[NewSection]]:
    """Return the mapping at a path, and the mappings that were created along the path."""
    new_sections = []
    for key in path:
        child_section = section.section(key)
        if child_section is None:
            saved_entry = section.copy_entry(key)
            child_section = ensure_section(section, key)
            new_sections.append(NewSection(section, saved_entry, child_section, child_section.keys()))
        section = child_section
    return section, new_sections


def remove_unchanged(new_sections: list[NewSection]) -> list[NewSection]:
    """Remove new mappings without further keys, and return the remaining new mappings.

    The mappings are removed from the last to the first, up to the first that has further keys.
    """
    remaining_sections = list(new_sections)
    while remaining_sections and remaining_sections[-1].section.keys() == remaining_sections[-1].keys:
        removed_section = remaining_sections.pop()
        removed_section.parent.restore(removed_section.saved_entry)
    return remaining_sections


def ensure_section(section: Section, *path: str) -> Section:
    """Return the mapping at a path, creating it if it is missing."""
    node = section.node
    for key in path:
        node = _get_or_create_mapping(node, key)
    return Section(node, section.source)


def _copy(node: yaml.Node, *, deep: bool = True) -> yaml.Node:
    """Return a copy of a node, by default deep.

    The `copy` module cannot copy libyaml's marks.
    """
    if isinstance(node, yaml.ScalarNode):
        return yaml.ScalarNode(node.tag, node.value, node.start_mark, node.end_mark, node.style)
    assert isinstance(node, yaml.CollectionNode)
    value = list(node.value)
    if deep and isinstance(node, yaml.SequenceNode):
        value = [_copy(item) for item in value]
    elif deep:
        value = [(_copy(key), _copy(child)) for key, child in value]
    return type(node)(node.tag, value, node.start_mark, node.end_mark, node.flow_style)


def _get_span(node: yaml.Node, source: SourceText) -> Span:
    start, end = node.start_mark, node.end_mark
    if start is None or end is None:
        return source.span(0, 0)
    return Span(source.name, start.line + 1, start.column + 1, end.line + 1, end.column + 1)


def _find_child(node: yaml.MappingNode, key: str) -> yaml.Node | None:
    child: yaml.Node | None = None
    for name, value in node.value:
        if isinstance(name, yaml.ScalarNode) and name.value == key:
            child = value  # the last of several equal keys is used, as in RViz
    return child


def _get_or_create_mapping(node: yaml.MappingNode, key: str) -> yaml.MappingNode:
    child = _find_child(node, key)
    if isinstance(child, yaml.MappingNode):
        if child.flow_style and not child.value:
            child.flow_style = False
        return child
    mapping = yaml.MappingNode(_MAPPING, [], flow_style=False)
    if isinstance(child, yaml.ScalarNode) and child.tag != _NULL:
        _set_value(mapping, "Value", child)
    _set_value(node, key, mapping)
    return mapping


def _set_value(node: yaml.MappingNode, key: str, value: yaml.Node) -> None:
    for index in range(len(node.value) - 1, -1, -1):
        name = node.value[index][0]
        if isinstance(name, yaml.ScalarNode) and name.value == key:
            node.value[index] = (name, value)
            return
    names = [name.value for name, _ in node.value if isinstance(name, yaml.ScalarNode)]
    is_sorted = len(names) == len(node.value) and names == sorted(names)
    position = (
        bisect(names, key) if is_sorted else len(names)
    )  # as in RViz, whose keys are mostly in alphabetical order
    node.value.insert(position, (yaml.ScalarNode(_STRING, key), value))


def _check_depth(text: str, source: SourceText) -> None:
    depth = 0
    for event in yaml.parse(text, Loader=_Loader):
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
            if depth > MAX_DEPTH:
                mark = event.start_mark
                span = source.span(source.offset(mark.line + 1, mark.column + 1)) if mark else None
                message = phrase(
                    "the document is nested more than {maximum_depth} levels deep", maximum_depth=MAX_DEPTH
                )
                raise LinkwrightError(Diagnostic("RVIZ102", message, span, source=source))
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1


def _expand_aliases(root: yaml.Node, source: SourceText) -> None:
    """Replace each alias with a copy of its node, so that copies can be edited separately."""
    visited_ids: set[int] = set()
    count = 0

    def visit(node: yaml.Node, ancestors: tuple[int, ...]) -> yaml.Node:
        nonlocal count
        count += 1
        if id(node) in ancestors or count > MAX_NODES:
            message = (
                phrase("an alias refers to itself")
                if id(node) in ancestors
                else phrase("the file has more than {maximum_nodes} values", maximum_nodes=MAX_NODES)
            )
            raise LinkwrightError(Diagnostic("RVIZ102", message, _get_span(node, source), source=source))
        if id(node) in visited_ids:
            node = _copy(node, deep=False)
        visited_ids.add(id(node))
        path = (*ancestors, id(node))
        if isinstance(node, yaml.SequenceNode):
            node.value[:] = [visit(item, path) for item in node.value]
        elif isinstance(node, yaml.MappingNode):
            node.value[:] = [(visit(key, path), visit(value, path)) for key, value in node.value]
        return node

    visit(root, ())


def _make_yaml_diagnostic(error: yaml.YAMLError, source: SourceText) -> Diagnostic:
    mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    problem = getattr(error, "problem", None) or getattr(error, "reason", None) or str(error)
    span = None
    if mark is not None:
        span = source.span(source.offset(mark.line + 1, mark.column + 1))
    from linkwright.files.yaml_documents import yaml_hint  # few files are malformed

    hint = None if span is None else yaml_hint(source, span.line)
    return Diagnostic(
        "RVIZ102",
        phrase("the file is not valid YAML: {problem}", problem=foreign(problem)),
        span,
        hint=hint,
        source=source,
    )


_PlainDumper: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)

_UNLIMITED_WIDTH = 2**30
"""A width at which lines are never broken."""

_EMPTY_MAPPING_LINE = re.compile(r"^ +\{\}\r?$", re.MULTILINE)
_INDENTED_ITEMS = re.compile(r"^( *)[^\s#-][^\n]*:[ \r]*\n\1 +- ", re.MULTILINE)


def _format_in_layout(node: yaml.Node, source: str) -> str:
    """Return a node as text in the layout of a source text."""
    if not _INDENTED_ITEMS.search(source):
        return _format_in_default_layout(node)
    return _serialize(node, _RvizDumper if _EMPTY_MAPPING_LINE.search(source) else _IndentingDumper)


def _format_in_default_layout(node: yaml.Node) -> str:
    """Return a document as text in libyaml's default layout.

    The conversion is fast.
    """
    return _serialize(node, _PlainDumper)


def _serialize(node: yaml.Node, dumper: Any) -> str:
    text: str = yaml.serialize(node, Dumper=dumper, width=_UNLIMITED_WIDTH, allow_unicode=True)
    return text


class _IndentingDumper(yaml.SafeDumper):
    """A YAML dumper that indents the items of sequences."""

    def increase_indent(self, flow: bool = False, indentless: bool = False) -> None:
        super().increase_indent(flow, False)


class _RvizDumper(_IndentingDumper):
    """A YAML dumper with the layout of RViz.

    Even an empty mapping is on a separate line.
    """

    def expect_block_mapping_simple_value(self) -> None:
        if not (isinstance(self.event, yaml.MappingStartEvent) and self.check_empty_mapping()):
            super().expect_block_mapping_simple_value()
            return
        self.write_indicator(":", False)
        self.states.append(self.expect_block_mapping_key)
        indent, self.indent = self.indent, (self.indent or 0) + 2
        self.write_indent()
        self.indent = indent
        self.expect_node(mapping=True)
