"""The source locations of the parts of a computed name, and edits that change the name.

A name such as ``${prefix}wheel`` consists of literal parts and expressions. The first proposals change the literal
parts, and the expressions keep their values. The next ones change the value of an expression at its source: the macro
call, the default of a parameter, a property, or the default of an argument. The proposals must still be proved by
expansions.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.language.includes import real_path
from linkwright.language.proof import Edit
from linkwright.language.workspace import Workspace
from linkwright.xacro.expressions.template import Token, TokenKind, tokenize
from linkwright.xacro.faults import Fault, Frame
from linkwright.xacro.macros import parse_parameters
from linkwright.xmltree import Element, Text
from linkwright.xmltree.positions import attribute_value_range
from linkwright.xmltree.tokens import Kind, tokens

_NAME = re.compile(r"\s*([A-Za-z_]\w*)\s*")
_ARGUMENT = re.compile(r"arg\s+(\S+)\s*")
_OPTIONAL_VARIABLE = re.compile(r"\$\(optenv\s+\S+\s+([^()]*?)\s*\)")
_MAX_DEPTH = 12
_MAX_EXPRESSIONS = 8


@dataclass(frozen=True, slots=True)
class SourceValue:
    """A text of a file, as written.

    Attributes:
        file: the file that contains the text.
        start: the offset of the text.
        text: the text, which may contain expressions.
        frame: the macro call or include in which it is evaluated, or None.
    """

    file: Path
    start: int
    text: str
    frame: Frame | None

    @property
    def is_literal(self) -> bool:
        """Whether the text contains no expressions."""
        return "$" not in self.text


def source_value(element: Element, key: str) -> SourceValue | None:
    """Return the source of an attribute or text of an expanded element, or None.

    Args:
        element: an element of an expansion.
        key: the name of the attribute, or an empty string for the text of the element.
    """
    source = element.source
    if source is None:
        return None
    value_range = attribute_value_range(source.text, element.offset, key) if key else _find_text_range(element)
    if value_range is None:
        return None
    frame = element.origin if isinstance(element.origin, Frame) else None
    return SourceValue(real_path(source.name), value_range[0], source.text[value_range[0] : value_range[1]], frame)


def _find_text_range(element: Element) -> tuple[int, int] | None:
    for child in element.children:
        if isinstance(child, Text) and child.data.strip() and child.source is element.source:
            source = element.source
            if source is None:
                return None
            end = source.text.find("<", child.offset)
            source_text = source.text[child.offset : end if end >= 0 else len(source.text)]
            start = child.offset + len(source_text) - len(source_text.lstrip())
            return start, start + len(source_text.strip())
    return None


def rename_in_template(old: str, new: str, value: str) -> str | None:
    """Return the value of a name after a change of its text, or None if the expressions differ.

    Args:
        old: the text, such as ``${prefix}wheel``.
        new: the new text, such as ``${prefix}tire``.
        value: the present value, such as ``left_wheel``.
    """
    old_parts, new_parts = _split_parts(old), _split_parts(new)
    expressions = [part.text for part in old_parts if part.kind is not TokenKind.TEXT]
    if [part.text for part in new_parts if part.kind is not TokenKind.TEXT] != expressions:
        return None
    pattern = "".join(re.escape(part.text) if part.kind is TokenKind.TEXT else "(.*?)" for part in old_parts)
    match = re.fullmatch(pattern, value, re.DOTALL)
    if match is None:
        return None
    values = iter(match.groups())
    return "".join(part.text if part.kind is TokenKind.TEXT else next(values) for part in new_parts)


class NameSources:
    """A generator of proposed edits for computed names.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        files: the files to search for properties, arguments and macros.
    """

    def __init__(self, workspace: Workspace, texts: Mapping[Path, str], files: list[Path]) -> None:
        self._project, self._texts = workspace, texts
        self._tags = {file: [*_find_start_tags(workspace.text(file, texts) or "")] for file in files}

    def edits(self, source: SourceValue, value: str, new: str) -> Iterator[tuple[Edit, ...]]:
        """Yield proposals of edits that give a text a new value, the most likely first.

        Args:
            source: the text.
            value: its present value.
            new: its new value.
        """
        yield from self._generate_edits(source, value, new, 0)

    def _generate_edits(self, source: SourceValue, value: str, new: str, depth: int) -> Iterator[tuple[Edit, ...]]:
        if value == new or depth > _MAX_DEPTH:
            return
        if source.is_literal:
            if source.text == value:
                yield (Edit(source.file, source.start, source.start + len(value), new),)
            return
        parts = _split_parts(source.text)
        expressions = [part for part in parts if part.kind is not TokenKind.TEXT]
        if not parts or len(expressions) > _MAX_EXPRESSIONS:
            return
        yield from self._generate_literal_edits(source, parts, value, new)
        yield from self._generate_expression_edits(source, parts, value, new, depth)

    def _generate_literal_edits(
        self, source: SourceValue, parts: Sequence[Token], value: str, new: str
    ) -> Iterator[tuple[Edit, ...]]:
        """Yield the edits of the literal parts that give the new value, with equal expressions."""
        values = self._match_values(source, parts, value)
        if values is None:
            return
        new_template = "".join(
            "(.*?)" if part.kind is TokenKind.TEXT else re.escape(text)
            for part, text in zip(parts, values, strict=True)
        )
        changed = re.fullmatch(new_template, new, re.DOTALL)
        if changed is None:
            return
        new_literals = iter(changed.groups())
        edits = []
        for part in parts:
            if part.kind is TokenKind.TEXT:
                text = next(new_literals)
                if text != part.text:
                    edits.append(Edit(source.file, source.start + part.start, source.start + part.end, text))
        if edits and all(edit.text for edit in edits):
            yield tuple(edits)

    def _generate_expression_edits(
        self, source: SourceValue, parts: Sequence[Token], value: str, new: str, depth: int
    ) -> Iterator[tuple[Edit, ...]]:
        """Yield the edits that change the value of one expression, which may occur repeatedly."""
        values = self._match_values(source, parts, value)
        if values is None:
            return
        expressions = [
            (part, text) for part, text in zip(parts, values, strict=True) if part.kind is not TokenKind.TEXT
        ]
        for changed in dict.fromkeys(part.text for part, _ in reversed(expressions)):
            has_group = False
            pieces = []
            for part, text in zip(parts, values, strict=True):
                if part.kind is TokenKind.TEXT or part.text != changed:
                    pieces.append(re.escape(text))
                else:
                    pieces.append("(?P=new)" if has_group else "(?P<new>.+)")
                    has_group = True
            matched = re.fullmatch("".join(pieces), new, re.DOTALL)
            part, text = next(pair for pair in expressions if pair[0].text == changed)
            if matched is not None:
                for origin in self._find_sources(part, source.frame):
                    yield from self._generate_edits(origin, text, matched["new"], depth + 1)

    def _match_values(self, source: SourceValue, parts: Sequence[Token], value: str) -> list[str] | None:
        """Return the values of the parts of a text, or None if they do not fit its value."""
        known_values = [
            part.text if part.kind is TokenKind.TEXT else self._find_value(part, source.frame, 0) for part in parts
        ]
        pattern = "".join("(.*?)" if text is None else f"({re.escape(text)})" for text in known_values)
        match = re.fullmatch(pattern, value, re.DOTALL)
        if match is None:
            loose = "".join(f"({re.escape(part.text)})" if part.kind is TokenKind.TEXT else "(.*?)" for part in parts)
            match = re.fullmatch(loose, value, re.DOTALL)
        return None if match is None else [*match.groups()]

    def _find_value(self, part: Token, frame: Frame | None, depth: int) -> str | None:
        """Return the value of a name in an expression if literal texts define it, or None."""
        source = next(self._find_sources(part, frame), None) if depth <= _MAX_DEPTH else None
        if source is None:
            return None
        values = [
            inner.text if inner.kind is TokenKind.TEXT else self._find_value(inner, source.frame, depth + 1)
            for inner in _split_parts(source.text)
        ]
        return "".join(text for text in values if text is not None) if None not in values else None

    def _find_sources(self, part: Token, frame: Frame | None) -> Iterator[SourceValue]:
        """Yield the texts from which an expression may get its value."""
        if part.kind is TokenKind.EXPRESSION:
            name = _NAME.fullmatch(part.text)
            if name is not None:
                yield from self._find_sources_of_name(name[1], frame)
            return
        argument = _ARGUMENT.fullmatch(part.text)
        if argument is not None:
            yield from self._find_attribute_values("xacro:arg", argument[1], "default")

    def _find_sources_of_name(self, name: str, frame: Frame | None) -> Iterator[SourceValue]:
        while frame is not None:
            source = frame.site.source
            value_range = None if source is None else attribute_value_range(source.text, frame.site.offset, name)
            if frame.macro is not None and source is not None:
                if value_range is not None:
                    yield SourceValue(
                        real_path(source.name),
                        value_range[0],
                        source.text[value_range[0] : value_range[1]],
                        frame.outer,
                    )
                    return
                default = self._find_parameter_default(frame.macro, name, frame)
                if default is not None:
                    yield default
                    return
            frame = frame.outer
        yield from self._find_attribute_values("xacro:property", name, "value")

    def _find_parameter_default(self, macro: str, name: str, frame: Frame) -> SourceValue | None:
        """Return the default of a parameter of a macro, or None."""
        called = macro.rpartition(".")[2].removeprefix("xacro:")
        for file, tags in self._tags.items():
            for tag, attributes in tags:
                if tag == "xacro:macro" and attributes.get("name", ("", 0))[0].removeprefix("xacro:") == called:
                    params, start = attributes.get("params", ("", 0))
                    try:
                        parameters = parse_parameters(params)
                    except Fault:
                        continue
                    for parameter in parameters:
                        if parameter.name == name and parameter.default:
                            text = parameter.default
                            begin = start + parameter.default_start
                            if text[:1] in ("'", '"') and text[-1:] == text[:1] and len(text) > 1:
                                text, begin = text[1:-1], begin + 1
                            return SourceValue(file, begin, text, frame)
        return None

    def _find_attribute_values(self, tag: str, name: str, key: str) -> Iterator[SourceValue]:
        """Yield the values of an attribute of the elements with a tag and a name."""
        for file, tags in self._tags.items():
            for other, attributes in tags:
                if other == tag and attributes.get("name", ("", 0))[0] == name and key in attributes:
                    text, start = attributes[key]
                    default = _OPTIONAL_VARIABLE.fullmatch(text)  # An environment variable seldom provides the value.
                    if default is not None:
                        text, start = default[1], start + default.start(1)
                    yield SourceValue(file, start, text, None)


def _find_start_tags(text: str) -> Iterator[tuple[str, dict[str, tuple[str, int]]]]:
    """Yield the start tags of macros, properties and arguments, with their attributes."""
    for token in tokens(text):
        if token.kind is Kind.START and token.name in ("xacro:macro", "xacro:property", "xacro:arg"):
            yield (
                token.name,
                {attribute.name: (attribute.value or "", attribute.value_start) for attribute in token.attributes()},
            )


def _split_parts(text: str) -> Sequence[Token]:
    """Return the literal parts and expressions of a text, or an empty list if it is malformed."""
    try:
        return tokenize(text)
    except Fault:
        return []
