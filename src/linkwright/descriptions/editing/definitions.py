"""The definitions of named values: properties, arguments, macro parameters and YAML files."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import yaml

from linkwright.descriptions.editing.text_ranges import Candidate, TextRange, literal, words
from linkwright.diagnostics import LinkwrightError, SourceText
from linkwright.loading.lean_typing import Any
from linkwright.xacro.faults import Fault, Frame, frames
from linkwright.xacro.macros import parse_parameters
from linkwright.xacro.tracing.references import references
from linkwright.xmltree import Document, Element, Overlay
from linkwright.xmltree.patches import escape, find_start_tag
from linkwright.xmltree.positions import attribute_value_range

_VALUE_ATTRIBUTES = {"xacro:property": ("value", "default"), "xacro:arg": ("default",)}
_MAX_YAML_CHARACTERS = 1_000_000


class Definitions:
    """The texts that define names in a description.

    If several texts define the same name, the caller must try each of them.

    Args:
        documents: the unexpanded XML files of the description.
        other_files: the other files, such as YAML files.
        overlay: texts that replace the contents of files.
    """

    def __init__(self, documents: Sequence[Document], other_files: Iterable[Path], overlay: Overlay) -> None:
        self._ranges_by_name: dict[str, list[TextRange]] = {}
        self._macros: dict[str, Element] = {}
        self._other_files, self._overlay = tuple(other_files), overlay
        self._scalars: list[tuple[tuple[str, ...], TextRange]] | None = None
        for document in documents:
            for element in document.root.walk():
                self._collect(element)

    def of_names(self, text: str, innermost: Frame | None) -> Iterator[TextRange]:
        """Yield the texts that may define the names in a text, beginning with enclosing calls.

        Args:
            text: a text that contains expressions.
            innermost: the macro call in which the text is evaluated.
        """
        for reference in references(text):
            keys = _find_constant_keys(reference.path)
            for frame in frames(innermost):
                text_range = attribute(frame.site, reference.name) or self._default(frame, reference.name)
                if text_range is not None:
                    yield text_range
            yield from self._ranges_by_name.get(reference.name, ())
            if keys:
                yield from self._ranges_by_name.get(keys[-1], ())
                yield from (value_range for path, value_range in self._values() if path[-len(keys) :] == keys)

    def addable_arguments(self, text: str, index: int | None, innermost: Frame | None) -> Iterator[Candidate]:
        """Yield arguments that could be added to calls, in place of a parameter's default.

        Args:
            text: a text that contains expressions.
            index: the index of the number to change, if the parameter has three numbers.
            innermost: the macro call in which the text is evaluated.
        """
        for reference in references(text):
            for frame in frames(innermost):
                default = self._default(frame, reference.name)
                if default is not None and attribute(frame.site, reference.name) is None:
                    candidate = _make_argument_candidate(frame.site, reference.name, words(default), index)
                    if candidate is not None:
                        yield candidate

    def _collect(self, element: Element) -> None:
        name = element.attributes.get("name")
        if not name:
            return
        if element.tag == "xacro:macro":
            self._macros[name] = element
        for key in _VALUE_ATTRIBUTES.get(element.tag, ()):
            text_range = attribute(element, key)
            if text_range is not None:
                self._ranges_by_name.setdefault(name, []).append(text_range)

    def _default(self, frame: Frame, name: str) -> TextRange | None:
        """Return the location of the default of a macro's parameter.

        The result is None if the parameter or its default does not exist.
        """
        macro = self._macros.get((frame.macro or "").rpartition(".")[2])
        params = None if macro is None else attribute(macro, "params")
        if params is None:
            return None
        try:
            parameter = next(
                (candidate for candidate in parse_parameters(params.text) if candidate.name == name),
                None,
            )
        except Fault:
            return None
        if parameter is None or parameter.default is None or parameter.forward:
            return None
        is_quoted = parameter.default[:1] in ("'", '"') and parameter.default[:1] == parameter.default[-1:]
        return params.subrange(
            parameter.default_start + is_quoted, parameter.default_start + len(parameter.default) - is_quoted
        )

    def _values(self) -> list[tuple[tuple[str, ...], TextRange]]:
        """Return the locations of all scalars in the YAML files, each with its keys from the root."""
        if self._scalars is None:
            self._scalars = [item for path in self._other_files for item in _read_scalars(path, self._overlay)]
        return self._scalars


def attribute(element: Element, name: str) -> TextRange | None:
    """Return the location of an attribute's value, or None if it is not in a file."""
    if element.source is None:
        return None
    value_range = attribute_value_range(element.source.text, element.offset, name)
    return None if value_range is None else TextRange(element.source, *value_range)


def _make_argument_candidate(site: Element, name: str, default: list[TextRange], index: int | None) -> Candidate | None:
    tag = find_start_tag(site)
    value_index = 0 if len(default) == 1 else index
    if tag is None or site.source is None or value_index is None or value_index >= len(default):
        return None
    current = literal(default[value_index])
    if current is None:
        return None

    def write(number: float, tolerance: float) -> str:
        texts = [text_range.text for text_range in default]
        texts[value_index] = current.write(number, tolerance)
        return f' {name}="{escape(" ".join(texts))}"'

    return Candidate(
        TextRange(site.source, tag.insertion_offset, tag.insertion_offset), current.value, write, current.is_choice
    )


def _find_constant_keys(path: str) -> tuple[str, ...]:
    """Return the constant keys in an expression.

    For ``config['wheel'].radius`` these are ``("wheel", "radius")``.
    """
    keys: list[str] = []
    try:
        node: ast.AST = ast.parse(path, mode="eval").body
    except (SyntaxError, ValueError):
        return ()
    while isinstance(node, (ast.Attribute, ast.Subscript)):
        if isinstance(node, ast.Attribute):
            keys.append(node.attr)
        elif isinstance(node.slice, ast.Constant):
            keys.append(str(node.slice.value))
        else:
            break
        node = node.value
    return tuple(reversed(keys))


def _read_scalars(path: Path, overlay: Overlay) -> Iterator[tuple[tuple[str, ...], TextRange]]:
    try:
        text = overlay.read(str(path)).text
        if len(text) > _MAX_YAML_CHARACTERS:
            return
        root = yaml.compose(text, Loader=yaml.SafeLoader)
    except (LinkwrightError, yaml.YAMLError, RecursionError):
        return
    yield from _walk_scalars(root, (), SourceText(str(path), text), 0)


def _walk_scalars(
    node: Any, keys: tuple[str, ...], source: SourceText, depth: int
) -> Iterator[tuple[tuple[str, ...], TextRange]]:
    if isinstance(node, yaml.ScalarNode):
        is_quoted = node.style in ("'", '"')
        if keys and (is_quoted or node.style is None):
            end = node.end_mark.index - is_quoted
            yield keys, TextRange(source, end - len(node.value), end)  # a tag may precede the value
    elif depth < 50 and isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            if isinstance(key, yaml.ScalarNode):
                yield from _walk_scalars(value, (*keys, key.value), source, depth + 1)
    elif depth < 50 and isinstance(node, yaml.SequenceNode):
        for index, value in enumerate(node.value):
            yield from _walk_scalars(value, (*keys, str(index)), source, depth + 1)
