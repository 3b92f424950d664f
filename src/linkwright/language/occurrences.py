"""The definitions and uses of names in an XML text, such as macros, properties and links.

Nothing is expanded, so the branches of conditions and uncalled macros also count. A property is identified by its
name alone, because xacro's scopes are dynamic. A name that equals a parameter of an enclosing macro denotes this
parameter.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.language.definitions import NameKind
from linkwright.language.expressions import decode_entities
from linkwright.language.grammar import PREFIX, XACRO
from linkwright.loading.deferred import lazy_pattern
from linkwright.schema.name_tags import JOINT_TAG, LINK_TAG
from linkwright.xacro.expressions.template import TokenKind, tokenize
from linkwright.xacro.faults import Fault
from linkwright.xacro.macros import Parameter, parse_parameters
from linkwright.xmltree.tokens import Kind, Token, TokenAttribute, tokens

_INNERMOST = lazy_pattern(r"\$\([^()]*\)|\$\{[^{}]*\}")
_LINK_KIND, _JOINT_KIND = (NameKind.LINK,), (NameKind.JOINT,)
_LINK_AND_JOINT_KINDS = (NameKind.LINK, NameKind.JOINT)
_REFERENCE_KINDS: dict[tuple[str, str], tuple[NameKind, ...]] = {
    ("parent", "link"): _LINK_KIND,
    ("child", "link"): _LINK_KIND,
    ("mimic", "joint"): _JOINT_KIND,
    ("gazebo", "reference"): _LINK_AND_JOINT_KINDS,
    ("chain", "base_link"): _LINK_KIND,
    ("chain", "tip_link"): _LINK_KIND,
    ("disable_collisions", "link1"): _LINK_KIND,
    ("disable_collisions", "link2"): _LINK_KIND,
    ("enable_collisions", "link1"): _LINK_KIND,
    ("enable_collisions", "link2"): _LINK_KIND,
    ("disable_default_collisions", "link"): _LINK_KIND,
    ("virtual_joint", "child_link"): _LINK_KIND,
    ("end_effector", "parent_link"): _LINK_KIND,
    ("link_sphere_approximation", "link"): _LINK_KIND,
    ("passive_joint", "name"): _JOINT_KIND,
    ("material", "name"): (NameKind.MATERIAL,),
    ("xacro:call", "macro"): (NameKind.MACRO,),
}
"""The kinds of names that a value may refer to, by element and attribute."""
_JOINT_USERS = frozenset({"transmission", "ros2_control", "group", "group_state"})
"""Elements in which ``<joint>`` and ``<link>`` use a name instead of defining it."""


@dataclass(frozen=True, slots=True)
class Occurrence:
    """A name in a text.

    Attributes:
        kind: the kind of the name.
        name: the name as written. The name of a link, joint or material may contain expressions.
        file: the file that contains it.
        start: the offset of the first character.
        is_definition: whether it defines the name.
        owner: for a parameter, its macro, and otherwise the enclosing macro, or an empty string.
    """

    kind: NameKind
    name: str
    file: Path
    start: int
    is_definition: bool = False
    owner: str = ""

    @property
    def end(self) -> int:
        """The offset after the last character."""
        return self.start + len(self.name)


def kinds_of_reference(tag: str, attribute: str) -> tuple[NameKind, ...]:
    """Return the kinds of names that an attribute may refer to, or an empty tuple."""
    return _REFERENCE_KINDS.get((tag, attribute), ())


def kinds_of_text(tag: str) -> tuple[NameKind, ...]:
    """Return the kinds of names that an element's text may contain, or an empty tuple.

    The kinds follow from the tag, as in the parameters ``<left_joint>`` and ``<robot_base_frame>`` of plugins.
    """
    if JOINT_TAG.search(tag):
        return _JOINT_KIND
    return _LINK_KIND if LINK_TAG.search(tag) else ()


def occurrences_in(text: str, file: Path) -> Iterator[Occurrence]:
    """Yield the names in a text, which may be incomplete."""
    yield from _Scan(text, file).all()


class _Scan:
    """One pass over a text, with the macros and elements around the current position."""

    def __init__(self, text: str, file: Path) -> None:
        self._text = text
        self._file = file
        self._is_srdf = ".srdf" in file.name
        self._macros: list[tuple[str, frozenset[str]]] = []
        self._tags: list[str] = []
        self._namespaces = frozenset(re.findall(r"<xacro:include\b[^<>]*?\bns=[\"'](\w+)", text))

    def all(self) -> Iterator[Occurrence]:
        """Yield the names in the whole text."""
        for token in tokens(self._text):
            if token.kind is Kind.START and token.name:
                yield from self._start_tag(token)
                if not token.is_empty_element:
                    self._tags.append(token.name)
            elif token.kind is Kind.END:
                yield from self._macro_use(token)
                if token.name in self._tags:
                    while self._tags.pop() != token.name:
                        pass
                if token.name == "xacro:macro" and self._macros:
                    self._macros.pop()
            elif token.kind is Kind.TEXT and token.text.strip():
                yield from self._character_data(token)

    @property
    def _macro(self) -> str:
        return self._macros[-1][0] if self._macros else ""

    def _start_tag(self, token: Token) -> Iterator[Occurrence]:
        tag = token.name
        attributes = {attribute.name: attribute for attribute in token.attributes() if attribute.value is not None}
        yield from self._macro_use(token)
        for attribute in attributes.values():
            yield from self.in_text(attribute.value or "", attribute.value_start)
        if tag == "xacro:macro":
            yield from self._macro_definition(attributes, is_empty=token.is_empty_element)
        elif tag in ("xacro:property", "xacro:insert_block"):
            yield from self._property(attributes.get("name"), is_definition=tag == "xacro:property")
        elif tag == "xacro:arg":
            yield from self._named_occurrences(NameKind.ARGUMENT, attributes.get("name"), is_definition=True)
        elif tag.startswith(PREFIX) and tag not in XACRO:
            owner = tag.removeprefix(PREFIX).rpartition(".")[2]
            for attribute in attributes.values():
                yield Occurrence(NameKind.PARAMETER, attribute.name, self._file, attribute.start, owner=owner)
        else:
            yield from self._robot_names(token, attributes)

    def _macro_definition(self, attributes: dict[str, TokenAttribute], *, is_empty: bool) -> Iterator[Occurrence]:
        name, params = attributes.get("name"), attributes.get("params")
        owner = "" if name is None else (name.value or "").removeprefix(PREFIX)
        if name is not None and owner:
            start = name.value_end - len(owner)
            yield Occurrence(NameKind.MACRO, owner, self._file, start, is_definition=True)
        names: set[str] = set()
        for parameter in _parse_parameters((params.value or "") if params else ""):
            bare = parameter.name.lstrip("*")
            start = (params.value_start if params else 0) + parameter.start + len(parameter.name) - len(bare)
            yield Occurrence(NameKind.PARAMETER, bare, self._file, start, is_definition=True, owner=owner)
            names.add(bare)
        if not is_empty:
            self._macros.append((owner, frozenset(names)))

    def _macro_use(self, token: Token) -> Iterator[Occurrence]:
        tag = token.name
        if tag.startswith(PREFIX) and tag not in XACRO:
            name = tag.removeprefix(PREFIX).rpartition(".")[2]
            if name:
                start = token.name_start + len(tag) - len(name)
                yield Occurrence(NameKind.MACRO, name, self._file, start, owner=self._macro)

    def _property(self, attribute: TokenAttribute | None, *, is_definition: bool) -> Iterator[Occurrence]:
        if attribute is not None and attribute.value and "$" not in attribute.value:
            yield self._variable(attribute.value, attribute.value_start, is_definition=is_definition)

    def _variable(self, name: str, start: int, *, is_definition: bool = False) -> Occurrence:
        for owner, parameters in reversed(self._macros):
            if name in parameters:
                return Occurrence(NameKind.PARAMETER, name, self._file, start, owner=owner)
        return Occurrence(NameKind.PROPERTY, name, self._file, start, is_definition, self._macro)

    def _named_occurrences(
        self, kind: NameKind, attribute: TokenAttribute | None, *, is_definition: bool = False
    ) -> Iterator[Occurrence]:
        if attribute is not None and attribute.value:
            yield Occurrence(kind, attribute.value, self._file, attribute.value_start, is_definition, owner=self._macro)

    def _robot_names(self, token: Token, attributes: dict[str, TokenAttribute]) -> Iterator[Occurrence]:
        tag, name = token.name, attributes.get("name")
        if tag in ("link", "joint"):
            kind = NameKind.LINK if tag == "link" else NameKind.JOINT
            uses = self._is_srdf or not _JOINT_USERS.isdisjoint(self._tags)
            yield from self._named_occurrences(kind, name, is_definition=not uses)
        elif tag == "material" and not token.is_empty_element:
            yield from self._named_occurrences(NameKind.MATERIAL, name, is_definition=True)
            return
        for attribute in attributes.values():
            for kind in kinds_of_reference(tag, attribute.name):
                yield from self._named_occurrences(kind, attribute)

    def _character_data(self, token: Token) -> Iterator[Occurrence]:
        yield from self.in_text(token.text, token.start)
        tag = self._tags[-1] if self._tags else ""
        content = token.text.strip()
        if " " not in content:
            for kind in kinds_of_text(tag):
                start = token.start + token.text.index(content)
                yield Occurrence(kind, content, self._file, start, owner=self._macro)

    def in_text(self, text: str, start: int) -> Iterator[Occurrence]:
        """Yield the names in the expressions and substitutions of a text.

        Args:
            text: an attribute's value or character data, as written.
            start: its offset in the file.
        """
        if "$" not in text:
            return
        try:
            parts = tokenize(decode_entities(text))
        except Fault:  # The expression is still being typed.
            return
        for part in parts:
            begin = start + part.start + 2
            if part.kind is TokenKind.SUBSTITUTION:
                yield from self._substitution(part.text, begin)
            elif part.kind is TokenKind.EXPRESSION:
                yield from self._expression(part.text, begin)

    def _substitution(self, inner_text: str, start: int) -> Iterator[Occurrence]:
        if "$" in inner_text:
            yield from self.in_text(inner_text, start)
        command = re.match(r"\s*(\w+)\s+", inner_text)
        if command is None:
            return
        argument = inner_text[command.end() :]
        if command[1] == "arg" and "$" not in argument:
            yield Occurrence(NameKind.ARGUMENT, argument.rstrip(), self._file, start + command.end())
        elif command[1] == "eval":
            yield from self._expression(argument, start + command.end())

    def _expression(self, source: str, start: int) -> Iterator[Occurrence]:
        if "$" in source:
            yield from self.in_text(source, start)
            while _INNERMOST.search(source):
                source = _INNERMOST.sub(lambda match: "_" * len(match[0]), source)
        body = source.replace("\n", " ").replace("\t", " ").rstrip()
        lead = len(body) - len(body.lstrip())
        try:
            tree = ast.parse(body.lstrip(), mode="eval")
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            return
        line = body.lstrip().encode()

        def offset_of(column: int) -> int:
            return start + lead + len(line[:column].decode(errors="replace"))

        bound = {node.arg for node in ast.walk(tree) if isinstance(node, ast.arg)}
        bound |= {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
        for node in ast.walk(tree):
            if isinstance(node, ast.Name) and node.id not in bound:
                yield self._variable(node.id, offset_of(node.col_offset))
            elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                if node.value.id in self._namespaces and node.end_col_offset is not None:
                    yield self._variable(node.attr, offset_of(node.end_col_offset) - len(node.attr))
            elif isinstance(node, ast.Call):
                yield from self._argument(node, offset_of)

    def _argument(self, call: ast.Call, to_offset: Callable[[int], int]) -> Iterator[Occurrence]:
        called = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
        first: Sequence[ast.expr] = call.args[:1]
        for node in first:
            if called == "arg" and isinstance(node, ast.Constant) and isinstance(node.value, str):
                start = to_offset(node.col_offset) + 1
                if self._text[start : start + len(node.value)] == node.value:
                    yield Occurrence(NameKind.ARGUMENT, node.value, self._file, start)


def _parse_parameters(params: str) -> tuple[Parameter, ...]:
    try:
        return parse_parameters(params)
    except Fault:  # These parameters are still being typed.
        return ()
