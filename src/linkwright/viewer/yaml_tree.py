"""YAML as a tree that is read and changed in place, so that what nobody asks for is written back as it was.

RViz's files hold much that this program does not know. The tree keeps PyYAML's nodes: key order, quoting and the
spelling of every scalar survive, and every value knows its line.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import yaml

from linkwright.diagnostics import Diagnostic, LinkwrightError, SourceText, Span

_Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_Resolver: Any = yaml.resolver.Resolver
_Dumper: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)

MAXIMUM_DEPTH = 100
"""Deepest nesting read. PyYAML builds nodes by recursion, without a bound of its own."""

_STRING = "tag:yaml.org,2002:str"
_NULL = "tag:yaml.org,2002:null"
_MAPPING = "tag:yaml.org,2002:map"
_SEQUENCE = "tag:yaml.org,2002:seq"


@dataclass(frozen=True, slots=True)
class Scalar:
    """A scalar as it is spelt in the file, and where."""

    text: str
    span: Span


class Section:
    """A mapping of the file.

    A scalar is asked for by its path of keys. RViz stores a value that has parts of its own under ``Value`` among
    them; a path that ends at such a mapping means that value.
    """

    def __init__(self, node: yaml.MappingNode, source: SourceText) -> None:
        self.node = node
        self.source = source

    def keys(self) -> list[str]:
        """The keys, in the order of the file."""
        return [key.value for key, _ in self.node.value if isinstance(key, yaml.ScalarNode)]

    def scalar(self, *path: str) -> Scalar | None:
        """The scalar at a path; None where there is none or it is null."""
        node = self._find(path)
        if isinstance(node, yaml.MappingNode):
            node = _child(node, "Value")
        if not isinstance(node, yaml.ScalarNode) or node.tag == _NULL:
            return None
        return Scalar(node.value, self.span(node))

    def section(self, *path: str) -> Section | None:
        """The mapping at a path, or None."""
        node = self._find(path)
        return Section(node, self.source) if isinstance(node, yaml.MappingNode) else None

    def sections(self, *path: str) -> Iterator[Section]:
        """The mappings in the sequence at a path; other items are passed over."""
        node = self._find(path)
        if isinstance(node, yaml.SequenceNode):
            for item in node.value:
                if isinstance(item, yaml.MappingNode):
                    yield Section(item, self.source)

    def put(self, path: tuple[str, ...], text: str, *, string: bool = False, nested: bool = False) -> None:
        """Set the scalar at a path, making the mappings on the way.

        Args:
            path: keys, at least one.
            text: the spelling of the value.
            string: whether it is a string whatever it looks like (then it is quoted where it must be).
            nested: whether the value has parts of its own, and so goes under ``Value``.
        """
        tag = _STRING if string else _Resolver().resolve(yaml.ScalarNode, text, (True, False))
        parent = self.node
        for key in path[:-1]:
            parent = _child_mapping(parent, key)
        if nested or isinstance(_child(parent, path[-1]), yaml.MappingNode):
            parent, last = _child_mapping(parent, path[-1]), "Value"
        else:
            last = path[-1]
        _set(parent, last, yaml.ScalarNode(tag, text))

    def span(self, node: yaml.Node | None = None) -> Span:
        """Where a node of this file begins and ends; the mapping itself by default."""
        node = node or self.node
        start, end = node.start_mark, node.end_mark
        if start is None or end is None:
            return self.source.span(0, 0)
        return Span(self.source.name, start.line + 1, start.column + 1, end.line + 1, end.column + 1)

    def _find(self, path: tuple[str, ...]) -> yaml.Node | None:
        node: yaml.Node | None = self.node
        for key in path:
            if not isinstance(node, yaml.MappingNode):
                return None
            node = _child(node, key)
        return node


def parse(text: str, name: str) -> Section:
    """Read a document whose root is a mapping.

    Raises:
        LinkwrightError: RVIZ102, not YAML; RVIZ103, its root is no mapping.
    """
    source = SourceText(name, text)
    try:
        _check_depth(text, source)
        root = yaml.compose(text, Loader=_Loader)
    except yaml.YAMLError as error:
        raise LinkwrightError(_not_yaml(error, source)) from None
    if not isinstance(root, yaml.MappingNode):
        message = f"'{name}' is empty" if root is None else f"'{name}' holds no keys and values"
        hint = "an RViz configuration begins with 'Panels:' and 'Visualization Manager:'"
        raise LinkwrightError(Diagnostic("RVIZ103", message, source.span(0, 0), hint=hint, source=source))
    return Section(root, source)


def write(section: Section) -> str:
    """The document as text; keys in their order, scalars spelt as they were read."""
    text: str = yaml.serialize(section.node, Dumper=_Dumper, width=2**30, allow_unicode=True)
    return text


def empty(name: str) -> Section:
    """A document without keys."""
    return Section(yaml.MappingNode(_MAPPING, [], flow_style=False), SourceText(name, ""))


def append_section(section: Section, key: str) -> Section:
    """A new mapping at the end of the sequence under a key, which is made where it is missing."""
    sequence = _child(section.node, key)
    if not isinstance(sequence, yaml.SequenceNode):
        sequence = yaml.SequenceNode(_SEQUENCE, [], flow_style=False)
        _set(section.node, key, sequence)
    item = yaml.MappingNode(_MAPPING, [], flow_style=False)
    sequence.value.append(item)
    return Section(item, section.source)


def ensure_section(section: Section, *path: str) -> Section:
    """The mapping at a path, made where it is missing."""
    node = section.node
    for key in path:
        node = _child_mapping(node, key)
    return Section(node, section.source)


def _child(node: yaml.MappingNode, key: str) -> yaml.Node | None:
    found: yaml.Node | None = None
    for name, value in node.value:
        if isinstance(name, yaml.ScalarNode) and name.value == key:
            found = value  # as in RViz, the last of two wins
    return found


def _child_mapping(node: yaml.MappingNode, key: str) -> yaml.MappingNode:
    found = _child(node, key)
    if isinstance(found, yaml.MappingNode):
        if found.flow_style and not found.value:
            found.flow_style = False
        return found
    made = yaml.MappingNode(_MAPPING, [], flow_style=False)
    if isinstance(found, yaml.ScalarNode) and found.tag != _NULL:
        _set(made, "Value", found)
    _set(node, key, made)
    return made


def _set(node: yaml.MappingNode, key: str, value: yaml.Node) -> None:
    for index in range(len(node.value) - 1, -1, -1):
        name = node.value[index][0]
        if isinstance(name, yaml.ScalarNode) and name.value == key:
            node.value[index] = (name, value)
            return
    node.value.append((yaml.ScalarNode(_STRING, key), value))


def _check_depth(text: str, source: SourceText) -> None:
    depth = 0
    for event in yaml.parse(text, Loader=_Loader):
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
            if depth > MAXIMUM_DEPTH:
                at = event.start_mark
                span = source.span(source.offset(at.line + 1, at.column + 1)) if at else None
                message = f"nested deeper than {MAXIMUM_DEPTH} levels"
                raise LinkwrightError(Diagnostic("RVIZ102", message, span, source=source))
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1


def _not_yaml(error: yaml.YAMLError, source: SourceText) -> Diagnostic:
    mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    problem = getattr(error, "problem", None) or getattr(error, "reason", None) or str(error)
    span = None
    if mark is not None:
        span = source.span(source.offset(mark.line + 1, mark.column + 1))
    hint = None
    if span is not None and "\t" in source.line(span.line):
        hint = "indent with spaces: YAML does not allow tabs"
    return Diagnostic("RVIZ102", f"not valid YAML: {problem}", span, hint=hint, source=source)
