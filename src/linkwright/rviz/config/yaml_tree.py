"""YAML as a tree that is edited in place: untouched parts are written back as they were read.

RViz's files contain much that this program does not know. The tree consists of PyYAML's nodes, so that key order,
quoting and the spelling of every scalar survive, and every value has its line number.
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

MAXIMUM_DEPTH = 100
"""Deepest nesting that is read. PyYAML builds nodes by recursion, without a bound of its own."""

MAXIMUM_NODES = 1_000_000
"""Most keys and values of a document with its aliases expanded: a few lines of YAML can expand to billions."""

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
class Memory:
    """The former value of a key in a mapping; None if the mapping did not have the key."""

    key: str
    value: yaml.Node | None


class Section:
    """A mapping in the file.

    A path of keys identifies a scalar. If a value has children, RViz stores the value itself under ``Value`` in the
    mapping of the children; a path that ends at such a mapping refers to that value.
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
        node = self._scalar_node(path)
        return None if node is None else Scalar(node.value, self.span(node))

    def text(self, *path: str) -> str | None:
        """Return the text of the scalar at a path, or None; faster than `scalar`, which adds the position."""
        node = self._scalar_node(path)
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
            nested: whether the value has children of its own, and so is stored under ``Value``.
        """
        tag = _STRING if string else _Resolver().resolve(yaml.ScalarNode, text, (True, False))
        parent = self.node
        for key in path[:-1]:
            parent = _child_mapping(parent, key)
        there = _child(parent, path[-1])
        # RViz 1 writes a topic as a scalar, although its settings are children here.
        plain = isinstance(there, yaml.ScalarNode) and there.tag != _NULL
        if isinstance(there, yaml.MappingNode) or (nested and not plain):
            parent, last = _child_mapping(parent, path[-1]), "Value"
        else:
            last = path[-1]
        _set(parent, last, yaml.ScalarNode(tag, text))

    def memory(self, key: str) -> Memory:
        """Return the current value of a key, for `recall`."""
        there = _child(self.node, key)
        return Memory(key, None if there is None else _copy(there))

    def recall(self, memory: Memory) -> None:
        """Restore the former value of a key, or remove the key if it had none."""
        if memory.value is not None:
            _set(self.node, memory.key, _copy(memory.value))
            return
        self.node.value[:] = [pair for pair in self.node.value if pair[0].value != memory.key]

    def span(self, node: yaml.Node | None = None) -> Span:
        """Return the range of a node in its file; by default that of the mapping itself."""
        return _span(node or self.node, self.source)

    def _scalar_node(self, path: tuple[str, ...]) -> yaml.ScalarNode | None:
        node = self._find(path)
        if isinstance(node, yaml.MappingNode):
            node = _child(node, "Value")
        return node if isinstance(node, yaml.ScalarNode) and node.tag != _NULL else None

    def _find(self, path: tuple[str, ...]) -> yaml.Node | None:
        node: yaml.Node | None = self.node
        for key in path:
            if not isinstance(node, yaml.MappingNode):
                return None
            node = _child(node, key)
        return node


def parse(text: str, name: str) -> Section:
    """Return the root of a document, which must be a mapping.

    Raises:
        LinkwrightError: RVIZ102, the text is not YAML or is nested too deep; RVIZ103, its root is not a mapping.
    """
    source = SourceText(name, text)
    try:
        _check_depth(text, source)
        # RViz reads only the first document of a file.
        root = next(yaml.compose_all(text, Loader=_Loader), None)
    except yaml.YAMLError as error:
        raise LinkwrightError(_not_yaml(error, source)) from None
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
    return _text_in_layout(section.node, section.source.text)


def same(one: Section, other: Section) -> bool:
    """Return whether two documents would be written as the same text."""
    return _plain(one.node) == _plain(other.node)


def new_section(source: SourceText) -> Section:
    """Return an empty mapping that is not part of a document."""
    return Section(yaml.MappingNode(_MAPPING, [], flow_style=False), source)


def copy_section(section: Section) -> Section:
    """Return a copy of a mapping that is not part of a document."""
    node = _copy(section.node)
    assert isinstance(node, yaml.MappingNode)
    return Section(node, section.source)


def insert_section(parent: Section, key: str, section: Section, before: Section | None = None) -> None:
    """Insert a mapping into the sequence under a key, which is created if it is missing.

    Args:
        parent: the mapping with the key.
        key: the key of the sequence.
        section: the mapping to insert.
        before: the item to insert before; None or an unknown item to append.
    """
    sequence = _child(parent.node, key)
    if not isinstance(sequence, yaml.SequenceNode):
        sequence = yaml.SequenceNode(_SEQUENCE, [], flow_style=False)
        _set(parent.node, key, sequence)
    elif sequence.flow_style and not sequence.value:
        sequence.flow_style = False
    items = sequence.value
    at = next((index for index, item in enumerate(items) if before is not None and item is before.node), len(items))
    items.insert(at, section.node)


def remove_section(parent: Section, key: str, section: Section) -> None:
    """Remove a mapping from the sequence under a key."""
    sequence = _child(parent.node, key)
    if isinstance(sequence, yaml.SequenceNode):
        sequence.value[:] = [item for item in sequence.value if item is not section.node]


def entries(parent: Section, key: str) -> list[yaml.Node] | None:
    """Return the item nodes of the sequence under a key, or None if the key has no sequence."""
    sequence = _child(parent.node, key)
    return list(sequence.value) if isinstance(sequence, yaml.SequenceNode) else None


@dataclass(frozen=True, slots=True)
class SequenceMemory:
    """The former node of a key, with its items if the node was a sequence; nothing is copied."""

    node: yaml.Node | None
    items: list[yaml.Node] | None


def remember_sequence(parent: Section, key: str) -> SequenceMemory:
    """Return the current node of a key and the items of its sequence, for `recall_sequence`."""
    return SequenceMemory(_child(parent.node, key), entries(parent, key))


def recall_sequence(parent: Section, key: str, memory: SequenceMemory) -> None:
    """Restore the value of the key of a sequence, with its items."""
    if memory.node is None:
        parent.recall(Memory(key, None))
        return
    if isinstance(memory.node, yaml.SequenceNode):
        memory.node.value[:] = memory.items or []
    _set(parent.node, key, memory.node)


@dataclass(frozen=True, slots=True)
class NewSection:
    """A mapping that was created on demand, for `remove_unchanged`.

    Attributes:
        holder: the mapping that contains the new one.
        memory: the former value of the holder's key.
        section: the new mapping itself.
        keys: the keys that the new mapping had when it was created.
    """

    holder: Section
    memory: Memory
    section: Section
    keys: list[str]


def make_section(section: Section, *path: str) -> tuple[Section, list[NewSection]]:
    """Return the mapping at a path, created if it is missing, and all mappings created for it."""
    new_sections = []
    for key in path:
        there = section.section(key)
        if there is None:
            memory = section.memory(key)
            there = ensure_section(section, key)
            new_sections.append(NewSection(section, memory, there, there.keys()))
        section = there
    return section, new_sections


def remove_unchanged(new_sections: list[NewSection]) -> list[NewSection]:
    """Remove new mappings that have no added keys, and return the others.

    The mappings are removed from the last to the first, until one of them has added keys.
    """
    left = list(new_sections)
    while left and left[-1].section.keys() == left[-1].keys:
        gone = left.pop()
        gone.holder.recall(gone.memory)
    return left


def ensure_section(section: Section, *path: str) -> Section:
    """Return the mapping at a path, created if it is missing."""
    node = section.node
    for key in path:
        node = _child_mapping(node, key)
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


def _span(node: yaml.Node, source: SourceText) -> Span:
    start, end = node.start_mark, node.end_mark
    if start is None or end is None:
        return source.span(0, 0)
    return Span(source.name, start.line + 1, start.column + 1, end.line + 1, end.column + 1)


def _child(node: yaml.MappingNode, key: str) -> yaml.Node | None:
    found: yaml.Node | None = None
    for name, value in node.value:
        if isinstance(name, yaml.ScalarNode) and name.value == key:
            found = value  # the last one wins, as in RViz
    return found


def _child_mapping(node: yaml.MappingNode, key: str) -> yaml.MappingNode:
    found = _child(node, key)
    if isinstance(found, yaml.MappingNode):
        if found.flow_style and not found.value:
            found.flow_style = False
        return found
    mapping = yaml.MappingNode(_MAPPING, [], flow_style=False)
    if isinstance(found, yaml.ScalarNode) and found.tag != _NULL:
        _set(mapping, "Value", found)
    _set(node, key, mapping)
    return mapping


def _set(node: yaml.MappingNode, key: str, value: yaml.Node) -> None:
    for index in range(len(node.value) - 1, -1, -1):
        name = node.value[index][0]
        if isinstance(name, yaml.ScalarNode) and name.value == key:
            node.value[index] = (name, value)
            return
    names = [name.value for name, _ in node.value if isinstance(name, yaml.ScalarNode)]
    ordered = len(names) == len(node.value) and names == sorted(names)
    at = bisect(names, key) if ordered else len(names)  # as in RViz, whose keys are mostly in alphabetical order
    node.value.insert(at, (yaml.ScalarNode(_STRING, key), value))


def _check_depth(text: str, source: SourceText) -> None:
    depth = 0
    for event in yaml.parse(text, Loader=_Loader):
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
            if depth > MAXIMUM_DEPTH:
                at = event.start_mark
                span = source.span(source.offset(at.line + 1, at.column + 1)) if at else None
                message = phrase("nested deeper than {maximum_depth} levels", maximum_depth=MAXIMUM_DEPTH)
                raise LinkwrightError(Diagnostic("RVIZ102", message, span, source=source))
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1


def _expand_aliases(root: yaml.Node, source: SourceText) -> None:
    """Replace each alias with a copy of its node, so that an edit of one does not change the others."""
    seen: set[int] = set()
    count = 0

    def visit(node: yaml.Node, above: tuple[int, ...]) -> yaml.Node:
        nonlocal count
        count += 1
        if id(node) in above or count > MAXIMUM_NODES:
            message = (
                phrase("an alias refers to itself")
                if id(node) in above
                else phrase("it has more than {maximum_nodes} values", maximum_nodes=MAXIMUM_NODES)
            )
            raise LinkwrightError(Diagnostic("RVIZ102", message, _span(node, source), source=source))
        if id(node) in seen:
            node = _copy(node, deep=False)
        seen.add(id(node))
        below = (*above, id(node))
        if isinstance(node, yaml.SequenceNode):
            node.value[:] = [visit(item, below) for item in node.value]
        elif isinstance(node, yaml.MappingNode):
            node.value[:] = [(visit(key, below), visit(value, below)) for key, value in node.value]
        return node

    visit(root, ())


def _not_yaml(error: yaml.YAMLError, source: SourceText) -> Diagnostic:
    mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    problem = getattr(error, "problem", None) or getattr(error, "reason", None) or str(error)
    span = None
    if mark is not None:
        span = source.span(source.offset(mark.line + 1, mark.column + 1))
    hint = None
    if span is not None and "\t" in source.line(span.line):
        hint = phrase("indent with spaces: YAML does not allow tabs")
    return Diagnostic(
        "RVIZ102", phrase("not valid YAML: {problem}", problem=foreign(problem)), span, hint=hint, source=source
    )


_PlainDumper: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)

_ENDLESS = 2**30
"""A width at which lines are never broken."""

_EMPTY_BELOW = re.compile(r"^ +\{\}\r?$", re.MULTILINE)
_INDENTED_ITEMS = re.compile(r"^( *)[^\s#-][^\n]*:[ \r]*\n\1 +- ", re.MULTILINE)


def _text_in_layout(node: yaml.Node, source: str) -> str:
    """Return a node as text in the layout of a source text."""
    if not _INDENTED_ITEMS.search(source):
        return _plain(node)
    return _serialize(node, _RvizDumper if _EMPTY_BELOW.search(source) else _IndentingDumper)


def _plain(node: yaml.Node) -> str:
    """Return a document as text in libyaml's default layout, which is fast."""
    return _serialize(node, _PlainDumper)


def _serialize(node: yaml.Node, dumper: Any) -> str:
    text: str = yaml.serialize(node, Dumper=dumper, width=_ENDLESS, allow_unicode=True)
    return text


class _IndentingDumper(yaml.SafeDumper):
    """A YAML dumper that indents the items of sequences."""

    def increase_indent(self, flow: bool = False, indentless: bool = False) -> None:
        super().increase_indent(flow, False)


class _RvizDumper(_IndentingDumper):
    """A YAML dumper with RViz's layout, in which even an empty mapping is on a line of its own."""

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
