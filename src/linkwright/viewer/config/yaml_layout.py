"""Writes YAML in the layout of its source, RViz's where RViz wrote it, so that the diff of an edit is one line."""

from __future__ import annotations

import re
from typing import Any

import yaml

_PlainDumper: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)

_ENDLESS = 2**30
"""Width of a line that is never broken."""

_EMPTY_BELOW = re.compile(r"^ +\{\}\r?$", re.MULTILINE)
_INDENTED_ITEMS = re.compile(r"^( *)[^\s#-][^\n]*:[ \r]*\n\1 +- ", re.MULTILINE)


def write(node: yaml.Node, source: str) -> str:
    """A document as text, laid out like its source."""
    if not _INDENTED_ITEMS.search(source):
        return plain(node)
    return _serialized(node, _RvizDumper if _EMPTY_BELOW.search(source) else _IndentingDumper)


def plain(node: yaml.Node) -> str:
    """A document as text, in a layout that is quickly made."""
    return _serialized(node, _PlainDumper)


def _serialized(node: yaml.Node, dumper: Any) -> str:
    text: str = yaml.serialize(node, Dumper=dumper, width=_ENDLESS, allow_unicode=True)
    return text


class _IndentingDumper(yaml.SafeDumper):
    """Indents the items of a sequence."""

    def increase_indent(self, flow: bool = False, indentless: bool = False) -> None:  # noqa: ARG002
        super().increase_indent(flow, False)


class _RvizDumper(_IndentingDumper):
    """Lays out as RViz does: an empty mapping has a line of its own, too."""

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
