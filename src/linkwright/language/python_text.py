"""The calls and strings of a Python text, which may be incomplete.

The text is not run.
Unclosed brackets end at the next statement.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Union

from linkwright.loading.deferred import lazy_pattern

_TOKEN = lazy_pattern(
    r"""
    (?P<comment>\#[^\n]*)
    | (?P<string>(?P<prefix>\b[rbufRBUF]{1,2})?(?:
        (?P<triple>\"{3}|'{3})(?P<long>(?:\\.|(?!(?P=triple)).)*)(?:(?P=triple)|\Z)
        | (?P<quote>["'])(?P<short>(?:\\.|(?!(?P=quote))[^\n\\])*)(?P=quote)?))
    | (?P<name>[^\W\d]\w*(?:\s*\.\s*[^\W\d]\w*)*)
    | (?P<open>[(\[{])
    | (?P<close>[)\]}])
    | (?P<newline>\n)
    | (?P<continued>\\\r?\n)
    | (?P<space>[ \t\r\f]+)
    | (?P<operator>==|!=|<=|>=|:=|->|\*\*|//|[-+*/%=,.:;<>@&|^~!?$`\\]|[\d][\w.]*|.)
    """,
    re.VERBOSE | re.DOTALL,
)
_STATEMENT_KEYWORDS = frozenset({"def", "class", "return", "import", "from", "with", "try", "while", "raise", "del"})
"""The words that begin a statement. A line that begins with one ends all open brackets."""
_CLOSING_BRACKETS = {"(": ")", "[": "]", "{": "}", "": ""}
_MAX_TEXT_LENGTH = 300_000
"""The maximum length in characters. Longer files are not launch files."""


@dataclass(frozen=True, slots=True)
class Text:
    """A string literal, which may be incomplete.

    Attributes:
        value: the characters between the quotes, as written.
        start: the offset of the first character between the quotes.
        is_format: whether it is an f-string.
    """

    value: str
    start: int
    is_format: bool = False

    @property
    def end(self) -> int:
        """The offset after the last character between the quotes."""
        return self.start + len(self.value)


@dataclass(frozen=True, slots=True)
class Name:
    """A name, possibly with dots."""

    value: str
    start: int

    @property
    def end(self) -> int:
        """The offset after the name."""
        return self.start + len(self.value)


@dataclass(frozen=True, slots=True)
class Operator:
    """An operator, a number or a punctuation mark."""

    value: str


@dataclass(slots=True, eq=False)
class Item:
    """A comma-separated part of a group, or a statement.

    Attributes:
        group: the brackets that contain it.
        start: the offset after the bracket, comma or line before it.
        keyword: the name before ``=``, or empty.
        parts: its strings, names, operators and groups.
    """

    group: Group
    start: int
    keyword: str = ""
    parts: list[Part] = field(default_factory=list)

    @property
    def after_colon(self) -> list[Part]:
        """The parts after the first colon, such as a dictionary value, or all without a colon."""
        for index, part in enumerate(self.parts):
            if isinstance(part, Operator) and part.value == ":":
                return self.parts[index + 1 :]
        return self.parts


@dataclass(slots=True, eq=False)
class Group:
    """A pair of brackets with its content, or the whole text.

    Attributes:
        opening: the opening bracket, or empty for the whole text.
        callee: the name before the bracket of a call, or empty.
        start: the offset of the opening bracket.
        end: the offset after the closing bracket, or where unclosed brackets end.
        is_closed: whether there is a closing bracket.
        items: the parts between commas.
        parent: the item that contains the brackets, or None for the whole text.
    """

    opening: str
    callee: str
    start: int
    end: int = 0
    items: list[Item] = field(default_factory=list)
    parent: Item | None = None
    is_closed: bool = False

    @property
    def function(self) -> str:
        """The last part of the name of the called function."""
        return self.callee.rpartition(".")[2].strip()

    def argument(self, name: str, index: int | None = None) -> Item | None:
        """Return the argument of a call by keyword, or else by position, or None."""
        for item in self.items:
            if item.keyword == name:
                return item
        if index is not None and index < len(self.items) and not self.items[index].keyword:
            return self.items[index]
        return None


Part = Union[Text, Name, Operator, Group]  # noqa: UP007 - it is used before `Group` is defined


class PythonText:
    """A Python text as a tree of brackets.

    Args:
        text: the source text.

    Attributes:
        root: the whole text, whose items are the statements.
        calls: all calls in text order.
        strings: all strings with the items that contain them.
        bindings: the statement that assigns each name, or None if several do.
    """

    def __init__(self, text: str) -> None:
        self.root = Group("", "", 0, len(text))
        self.calls: list[Group] = []
        self.strings: list[tuple[Text, Item]] = []
        self.bindings: dict[str, Item | None] = {}
        self._group = self.root
        self._item = self._new_item(0)
        if len(text) <= _MAX_TEXT_LENGTH:
            self._read(text)

    def calls_of(self, *functions: str) -> Iterator[Group]:
        """Yield the calls of functions that have one of some names after the last dot."""
        return (call for call in self.calls if call.function in functions)

    def string_at(self, offset: int) -> tuple[Text, Item] | None:
        """Return the string around an offset with its item, or None if there is none."""
        return next((string for string in self.strings if string[0].start <= offset <= string[0].end), None)

    def call_at(self, offset: int) -> Group | None:
        """Return the innermost call whose brackets contain an offset, or None if there is none."""
        innermost = None
        for call in self.calls:
            if call.start >= offset:
                break
            if offset < call.end or (offset == call.end and not call.is_closed):
                innermost = call
        return innermost

    def _read(self, text: str) -> None:
        line_begins = True
        for token in _TOKEN.finditer(text):
            kind = token.lastgroup
            if kind == "newline":
                line_begins = True
                if self._group is self.root and (self._item.parts or self._item.keyword):
                    self._new_item(token.end())
                continue
            if kind in ("space", "comment", "continued"):
                continue
            if kind == "name" and line_begins and token[0] in _STATEMENT_KEYWORDS:
                self._close_all(token.start())
            line_begins = False
            if kind == "string":
                self._add_string(token)
            elif kind == "name":
                self._item.parts.append(Name(token[0], token.start()))
            elif kind == "open":
                self._open(token[0], token.start())
            elif kind == "close":
                self._close(token[0], token.end())
            else:
                self._add_operator(token[0], token.end())
        self._close_all(len(text))

    def _new_item(self, start: int) -> Item:
        self._item = Item(self._group, start)
        self._group.items.append(self._item)
        return self._item

    def _add_string(self, token: re.Match[str]) -> None:
        group = "long" if token["triple"] else "short"
        literal = Text(token[group], token.start(group), "f" in (token["prefix"] or "").lower())
        self._item.parts.append(literal)
        self.strings.append((literal, self._item))

    def _add_operator(self, mark: str, end: int) -> None:
        parts = self._item.parts
        if mark == "," and self._group is not self.root:
            self._new_item(end)
        elif mark == "=" and len(parts) == 1 and isinstance(parts[0], Name) and not self._item.keyword:
            name = self._item.keyword = parts[0].value
            parts.clear()
            if self._group is self.root:
                self.bindings[name] = None if name in self.bindings else self._item
        else:
            parts.append(Operator(mark))

    def _open(self, bracket: str, start: int) -> None:
        last = self._item.parts[-1] if self._item.parts else None
        callee = self._item.parts.pop() if bracket == "(" and isinstance(last, Name) else None
        group = Group(bracket, callee.value if isinstance(callee, Name) else "", start, start, parent=self._item)
        self._item.parts.append(group)
        if group.callee:
            self.calls.append(group)
        self._group = group
        self._new_item(start + 1)

    def _close(self, bracket: str, end: int) -> None:
        group = self._group
        while group.parent is not None and _CLOSING_BRACKETS[group.opening] != bracket:
            group = group.parent.group
        if group.parent is None:
            return
        while self._group is not group:
            self._close_group(end)
        group.is_closed = True
        self._close_group(end)

    def _close_group(self, end: int) -> None:
        parent = self._group.parent
        if parent is not None:
            self._group.end = end
            if len(self._group.items) > 1 and not (self._group.items[-1].parts or self._group.items[-1].keyword):
                self._group.items.pop()
            self._group, self._item = parent.group, parent

    def _close_all(self, end: int) -> None:
        while self._group is not self.root:
            self._close_group(end)


@lru_cache(maxsize=16)
def python_text(text: str) -> PythonText:
    """Return the cached tree of a text, which callers must not change."""
    return PythonText(text)
