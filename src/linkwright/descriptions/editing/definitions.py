"""The definitions of named values: properties, arguments, macro parameters and YAML files."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import yaml

from linkwright.descriptions.editing.places import Candidate, Place, literal, words
from linkwright.diagnostics import LinkwrightError, SourceText
from linkwright.loading.lean_typing import Any
from linkwright.xacro.faults import Fault, Frame, frames
from linkwright.xacro.macros import parse_parameters
from linkwright.xacro.tracing.references import references
from linkwright.xmltree import Document, Element, Overlay
from linkwright.xmltree.patches import escaped, start_tag_of
from linkwright.xmltree.positions import attribute_value_range

_VALUES = {"xacro:property": ("value", "default"), "xacro:arg": ("default",)}
_MOST_YAML = 1_000_000


class Definitions:
    """The texts that define names in a description.

    If several texts define the same name, the caller must try each of them.

    Args:
        documents: the unexpanded XML files of the description.
        others: the other files, such as YAML files.
        overlay: texts that replace those of files.
    """

    def __init__(self, documents: Sequence[Document], others: Iterable[Path], overlay: Overlay) -> None:
        self._named: dict[str, list[Place]] = {}
        self._macros: dict[str, Element] = {}
        self._others, self._overlay = tuple(others), overlay
        self._scalars: list[tuple[tuple[str, ...], Place]] | None = None
        for document in documents:
            for element in document.root.walk():
                self._collect(element)

    def of_names(self, text: str, innermost: Frame | None) -> Iterator[Place]:
        """Yield the texts that may define the names in a text, those of enclosing calls first.

        Args:
            text: a text that contains expressions.
            innermost: the macro call in which the text is evaluated.
        """
        for reference in references(text):
            keys = _keys(reference.path)
            for frame in frames(innermost):
                place = attribute(frame.site, reference.name) or self._default(frame, reference.name)
                if place is not None:
                    yield place
            yield from self._named.get(reference.name, ())
            if keys:
                yield from self._named.get(keys[-1], ())
                yield from (place for path, place in self._values() if path[-len(keys) :] == keys)

    def given(self, text: str, index: int | None, innermost: Frame | None) -> Iterator[Candidate]:
        """Yield arguments that could be added to calls that use a parameter's default.

        Args:
            text: a text that contains expressions.
            index: the index of the number to change, if the parameter has three numbers.
            innermost: the macro call in which the text is evaluated.
        """
        for reference in references(text):
            for frame in frames(innermost):
                default = self._default(frame, reference.name)
                if default is not None and attribute(frame.site, reference.name) is None:
                    found = _given(frame.site, reference.name, words(default), index)
                    if found is not None:
                        yield found

    def _collect(self, element: Element) -> None:
        name = element.attributes.get("name")
        if not name:
            return
        if element.tag == "xacro:macro":
            self._macros[name] = element
        for key in _VALUES.get(element.tag, ()):
            place = attribute(element, key)
            if place is not None:
                self._named.setdefault(name, []).append(place)

    def _default(self, frame: Frame, name: str) -> Place | None:
        """Return the location of the default of a macro's parameter.

        The result is None if the parameter or its default does not exist.
        """
        macro = self._macros.get((frame.macro or "").rpartition(".")[2])
        params = None if macro is None else attribute(macro, "params")
        if params is None:
            return None
        try:
            found = next(
                (parse_parameter for parse_parameter in parse_parameters(params.text) if parse_parameter.name == name),
                None,
            )
        except Fault:
            return None
        if found is None or found.default is None or found.forward:
            return None
        quoted = found.default[:1] in ("'", '"') and found.default[:1] == found.default[-1:]
        return params.part(found.default_start + quoted, found.default_start + len(found.default) - quoted)

    def _values(self) -> list[tuple[tuple[str, ...], Place]]:
        """Return the locations of all scalars in the YAML files, each with the keys that lead there."""
        if self._scalars is None:
            self._scalars = [item for path in self._others for item in _scalars_of(path, self._overlay)]
        return self._scalars


def attribute(element: Element, name: str) -> Place | None:
    """Return the location of an attribute's value, or None if it is not in a file."""
    if element.source is None:
        return None
    found = attribute_value_range(element.source.text, element.offset, name)
    return None if found is None else Place(element.source, *found)


def _given(site: Element, name: str, default: list[Place], index: int | None) -> Candidate | None:
    tag = start_tag_of(site)
    at = 0 if len(default) == 1 else index
    if tag is None or site.source is None or at is None or at >= len(default):
        return None
    known = literal(default[at])
    if known is None:
        return None

    def write(number: float, tolerance: float) -> str:
        texts = [place.text for place in default]
        texts[at] = known.write(number, tolerance)
        return f' {name}="{escaped(" ".join(texts))}"'

    return Candidate(Place(site.source, tag.room, tag.room), known.value, write, known.is_choice)


def _keys(path: str) -> tuple[str, ...]:
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


def _scalars_of(path: Path, overlay: Overlay) -> Iterator[tuple[tuple[str, ...], Place]]:
    try:
        text = overlay.read(str(path)).text
        if len(text) > _MOST_YAML:
            return
        root = yaml.compose(text, Loader=yaml.SafeLoader)
    except (LinkwrightError, yaml.YAMLError, RecursionError):
        return
    yield from _walk(root, (), SourceText(str(path), text), 0)


def _walk(node: Any, keys: tuple[str, ...], source: SourceText, depth: int) -> Iterator[tuple[tuple[str, ...], Place]]:
    if isinstance(node, yaml.ScalarNode):
        quoted = node.style in ("'", '"')
        if keys and (quoted or node.style is None):
            end = node.end_mark.index - quoted
            yield keys, Place(source, end - len(node.value), end)  # a tag may precede the value
    elif depth < 50 and isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            if isinstance(key, yaml.ScalarNode):
                yield from _walk(value, (*keys, key.value), source, depth + 1)
    elif depth < 50 and isinstance(node, yaml.SequenceNode):
        for index, value in enumerate(node.value):
            yield from _walk(value, (*keys, str(index)), source, depth + 1)
