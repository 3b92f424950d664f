"""The keys and items of a YAML text, found by the indentation of its lines.

This is not a YAML parser: anchors and tags are parts of the values. The outline also covers incomplete texts, which a
parser would reject.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum

from linkwright.loading.deferred import lazy_pattern

MAX_TEXT_LENGTH = 500_000
"""The maximum length of a text in characters. Longer files are data, not configuration."""
_MAX_FLOW_LINES = 300
_MAX_DASHES = 20
"""The maximum number of list items that begin in one line."""
_MAX_KEY_LENGTH = 500
_KEY = lazy_pattern(r"""("(?:[^"\\\n]|\\.)*"|'[^'\n]*'|(?![\s#\[\]{},"'&!|>@`])[^\n]*?):(?=\s|$)""")
_BLOCK_TEXT = lazy_pattern(r"[|>][+-]?\d?[+-]?\s*$")


class YamlPosition(Enum):
    """The kinds of cursor positions in a YAML text."""

    KEY = "key"
    VALUE = "value"
    NOTHING = "nothing"


@dataclass(slots=True, eq=False)
class YamlEntry:
    """A key with its value, or an item of a list.

    Attributes:
        key: the key without quotes, or empty for an item.
        column: the column of the key or the dash, from 0, or -1 for the whole text.
        start: the offset of the key or the dash.
        value: the text of a value that begins in the same line, without a comment, or empty for a block.
        value_start: the offset of the value, or where it would be.
        line: the line, from 0.
        parent: the entry that contains it, or None for the whole text.
        children: the entries in it.
        end: the offset at which the next entry outside it begins, or the end of the text.
    """

    key: str
    column: int
    start: int
    value: str = ""
    value_start: int = 0
    line: int = 0
    parent: YamlEntry | None = None
    children: list[YamlEntry] = field(default_factory=list)
    end: int = 0

    @property
    def is_item(self) -> bool:
        """Whether the entry is an item of a list."""
        return not self.key and self.parent is not None

    @property
    def path(self) -> tuple[str, ...]:
        """The keys from the root to this entry, without list items."""
        keys: list[str] = []
        entry: YamlEntry | None = self
        while entry is not None:
            if entry.key:
                keys.append(entry.key)
            entry = entry.parent
        return tuple(reversed(keys))

    @property
    def scalar(self) -> str:
        """The value without quotes."""
        return unquoted(self.value)

    def child(self, key: str) -> YamlEntry | None:
        """Return the entry below a key, or None if there is none."""
        return next((child for child in self.children if child.key == key), None)

    def all(self) -> Iterator[YamlEntry]:
        """Yield all descendants of the entry, in text order."""
        pending = list(reversed(self.children))
        while pending:
            entry = pending.pop()
            yield entry
            pending += reversed(entry.children)

    def items(self) -> list[tuple[str, int]]:
        """Return the items of a flow or block list without quotes, each with its offset."""
        if self.value.startswith("["):
            return [*_parse_flow_items(self.value, self.value_start)]
        return [
            (unquoted(child.value), _find_content_start(child))
            for child in self.children
            if child.is_item and child.value
        ]


@dataclass(frozen=True, slots=True)
class YamlCursor:
    """A cursor position in a YAML text.

    Attributes:
        position: the kind of position.
        offset: the character offset.
        parent_entry: the entry that contains the position; for a value, the entry with the value.
        start: the offset at which the key or value at the cursor begins.
        typed: the part of the key or value before the cursor, without an opening quote.
        entry: the entry whose key is at the cursor, or None.
        is_in_list: whether the value is an item of a list.
    """

    position: YamlPosition
    offset: int
    parent_entry: YamlEntry
    start: int
    typed: str = ""
    entry: YamlEntry | None = None
    is_in_list: bool = False


class YamlOutline:
    """The entries of a text.

    Args:
        text: the text, which may be incomplete.

    Attributes:
        root: the whole text.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self.root = YamlEntry("", -1, 0)
        self._last: list[YamlEntry] = []
        """The last entry that begins at or before each line."""
        self._comments: dict[int, int] = {}
        if len(text) <= MAX_TEXT_LENGTH:
            self._read()
        _set_ends(self.root, len(text))

    def cursor(self, offset: int) -> YamlCursor:
        """Return the cursor at an offset."""
        start = self.text.rfind("\n", 0, offset) + 1
        line = self.text.count("\n", 0, start)
        no_position = YamlCursor(YamlPosition.NOTHING, offset, self.root, offset)
        if line >= len(self._last) or offset > self._comments.get(line, len(self.text)):
            return no_position
        last = self._last[line]
        if last.line < line and _is_in_flow(last, offset):
            return _value_cursor(self.text, last, offset)
        prefix = self.text[start:offset]
        on_line = [entry for entry in _lineage(last) if entry.line == line and entry.parent is not None]
        for entry in on_line:
            if entry.key and entry.start <= offset <= entry.start + _written_length(self.text, entry):
                return YamlCursor(
                    YamlPosition.KEY,
                    offset,
                    entry.parent or self.root,
                    entry.start,
                    self.text[entry.start : offset],
                    entry,
                )
            if offset > entry.start and (not entry.key or offset >= entry.value_start) and entry.value_start <= offset:
                return self._cursor_in_value(entry, offset)
        if on_line and on_line[0].key and offset > on_line[0].start:
            return no_position  # The cursor is directly after the colon.
        if on_line and prefix.strip():
            return no_position
        return self._cursor_in_new_line(prefix, last, line, offset)

    def _cursor_in_value(self, entry: YamlEntry, offset: int) -> YamlCursor:
        cursor = _value_cursor(self.text, entry, offset)
        is_word = entry.is_item and not entry.value.startswith(("[", "{", '"', "'"))
        siblings = [child for child in (entry.parent or self.root).children if child is not entry]
        if is_word and any(child.children for child in siblings):
            return YamlCursor(YamlPosition.KEY, offset, entry, cursor.start, cursor.typed)
        return cursor

    def _cursor_in_new_line(self, prefix: str, last: YamlEntry, line: int, offset: int) -> YamlCursor:
        """Return the cursor in a line that has no entry yet."""
        typed = prefix.lstrip(" \t")
        column = len(prefix) - len(typed)
        parent = self._find_entry_before(last, line)
        while parent.parent is not None and (parent.column >= column or (parent.value and not parent.is_item)):
            parent = parent.parent
        start = offset - len(typed)
        is_list = bool(parent.children) and all(child.is_item for child in parent.children) and parent.key != ""
        if is_list and not typed.startswith("-"):
            return YamlCursor(YamlPosition.NOTHING, offset, parent, start)
        if typed.startswith("-"):
            return YamlCursor(YamlPosition.VALUE, offset, parent, offset, "", None, is_in_list=True)
        return YamlCursor(YamlPosition.KEY, offset, parent, start, typed.lstrip("\"'"))

    def _find_entry_before(self, last: YamlEntry, line: int) -> YamlEntry:
        while last.line >= line and last.parent is not None and line > 0:
            line -= 1
            last = self._last[line]
        return last

    # --- reading ------------------------------------------------------------------------------------------------------

    def _read(self) -> None:
        stack = [self.root]
        offset, skip_column, flow_until = 0, None, -1
        for index, line in enumerate(self.text.split("\n")):
            content = line.lstrip(" \t")
            column = len(line) - len(content)
            if skip_column is not None and content.strip() and column <= skip_column:
                skip_column = None
            if offset >= flow_until and skip_column is None and content.strip():
                if content.startswith("#"):
                    self._comments[index] = offset + column
                elif content.startswith("---"):
                    stack = [self.root]
                else:
                    entry = self._read_line(line, column, offset, index, stack)
                    if entry is not None and _BLOCK_TEXT.match(entry.value):
                        skip_column = entry.column
                    elif entry is not None and entry.value.startswith(("[", "{")):
                        flow_until = self._read_flow(entry)
            self._last.append(stack[-1])
            offset += len(line) + 1

    def _read_line(
        self, line: str, column: int, offset: int, line_index: int, stack: list[YamlEntry]
    ) -> YamlEntry | None:
        """Add the entries of a line, and return the last one, or None."""
        added: YamlEntry | None = None
        end = _find_comment_start(line, column)
        if end < len(line):
            self._comments[line_index] = offset + end
        for _ in range(_MAX_DASHES):
            item_text = line[column:end]
            if item_text.startswith("-") and item_text[1:2] in ("", " ", "\t", "\r"):
                _pop_to_column(stack, column, is_item=True)
                width = len(item_text) - len(item_text[1:].lstrip(" \t"))
                value = item_text[width:].rstrip()
                added = YamlEntry("", column, offset + column, value, offset + column + width, line_index, stack[-1])
                stack[-1].children.append(added)
                stack.append(added)
                column += width
                continue
            match = _KEY.match(item_text[:_MAX_KEY_LENGTH])
            if match is None:
                break
            if added is not None:
                added.value = ""
            _pop_to_column(stack, column, is_item=False)
            value = item_text[match.end() :]
            space = len(value) - len(value.lstrip(" \t"))
            begin = offset + column + match.end() + space
            added = YamlEntry(unquoted(match[1]), column, offset + column, value.strip(), begin, line_index, stack[-1])
            stack[-1].children.append(added)
            stack.append(added)
            break
        return added

    def _read_flow(self, entry: YamlEntry) -> int:
        """Extend a value to the end of its flow collection, add its keys, and return its end."""
        end = _find_flow_end(self.text, entry.value_start, entry.column)
        entry.value = self.text[entry.value_start : end].rstrip()
        if entry.value.startswith("{"):
            for text, start in _parse_flow_items(entry.value, entry.value_start):
                match = _KEY.match(text[:_MAX_KEY_LENGTH])
                if match is not None:
                    value = text[match.end() :]
                    begin = start + match.end() + len(value) - len(value.lstrip())
                    key = unquoted(match[1])
                    line = entry.line + self.text.count("\n", entry.value_start, start)
                    child = YamlEntry(key, entry.column + 1, start, value.strip(), begin, line, entry)
                    entry.children.append(child)
        return end


def unquoted(text: str) -> str:
    """Return a text without the quotes around it."""
    text = text.strip()
    return text[1:-1] if len(text) > 1 and text[0] == text[-1] and text[0] in "\"'" else text


def _pop_to_column(stack: list[YamlEntry], column: int, *, is_item: bool) -> None:
    """Pop the entries that a line at a column does not belong to."""
    while stack[-1].column >= column:
        if is_item and stack[-1].column == column and stack[-1].key and not stack[-1].value:
            return  # A list may begin at the column of its key.
        stack.pop()


def _find_comment_start(line: str, column: int) -> int:
    """Return the column of a comment in a line, or the length of the line."""
    quote = ""
    for index in range(column, len(line)):
        character = line[index]
        if quote:
            quote = "" if character == quote else quote
        elif character in "\"'" and (index == column or line[index - 1] in " \t[{,:"):
            quote = character
        elif character == "#" and (index == column or line[index - 1] in " \t"):
            return index
    return len(line.rstrip("\r"))


def _find_flow_end(text: str, start: int, column: int) -> int:
    """Return the offset after a flow collection.

    An unclosed collection ends before the next line at the column of its entry.
    """
    depth, offset = 0, start
    for number in range(_MAX_FLOW_LINES):
        line_end = text.find("\n", offset)
        line = text[offset : line_end if line_end >= 0 else len(text)]
        content = line.lstrip(" \t")
        if number and content.strip() and len(line) - len(content) <= column and content[0] not in "]}":
            break
        quote = ""
        for index, character in enumerate(line[: _find_comment_start(line, 0)]):
            if quote:
                quote = "" if character == quote else quote
            elif character in "\"'":
                quote = character
            elif character in "[{":
                depth += 1
            elif character in "]}":
                depth -= 1
                if depth <= 0:
                    return offset + index + 1
        offset += len(line) + 1
        if line_end < 0:
            break
    return min(offset - 1, len(text))


def _parse_flow_items(value: str, start: int) -> Iterator[tuple[str, int]]:
    """Yield the items of a flow collection without quotes, each with its offset."""
    depth, quote, begin = 0, "", 1
    for index, character in enumerate(value):
        if quote:
            quote = "" if character == quote else quote
        elif character in "\"'":
            quote = character
        elif character in "[{":
            depth += 1
        elif character in "]}":
            depth -= 1
        if not quote and ((character == "," and depth == 1) or (character in "]}" and depth == 0)):
            yield from _parse_flow_item(value, begin, index, start)
            begin = index + 1
    if depth > 0:
        yield from _parse_flow_item(value, begin, len(value), start)


def _parse_flow_item(value: str, begin: int, end: int, start: int) -> Iterator[tuple[str, int]]:
    text = re.sub(r"^(\s*#[^\n]*\n)*\s*", lambda match: " " * len(match[0]), value[begin:end])
    if text.strip():
        inner = text.strip()
        quoted = inner[0] in "\"'"
        yield unquoted(inner), start + begin + len(text) - len(text.lstrip()) + (1 if quoted else 0)


def _find_content_start(entry: YamlEntry) -> int:
    return entry.value_start + (1 if entry.value[:1] in ('"', "'") else 0)


def _set_ends(root: YamlEntry, end: int) -> None:
    """Set the end of each entry to the start of the next entry outside it."""
    pending = [(root, end)]
    while pending:
        entry, limit = pending.pop()
        entry.end = limit
        following = [child.start for child in entry.children[1:]]
        pending += zip(entry.children, [*following, limit], strict=False)


def _lineage(entry: YamlEntry) -> Iterator[YamlEntry]:
    current: YamlEntry | None = entry
    while current is not None:
        yield from (child for child in reversed(current.children) if current.value.startswith("{"))
        yield current
        current = current.parent


def _written_length(text: str, entry: YamlEntry) -> int:
    """Return the length of a key with its quotes."""
    return len(entry.key) + (2 if text[entry.start : entry.start + 1] in ("'", '"') else 0)


def _is_in_flow(entry: YamlEntry, offset: int) -> bool:
    return entry.value.startswith(("[", "{")) and entry.value_start < offset <= entry.value_start + len(entry.value)


def _value_cursor(text: str, entry: YamlEntry, offset: int) -> YamlCursor:
    """Return the cursor in a value, or in an item of a flow collection."""
    start = entry.value_start
    in_list = entry.is_item
    if text[start : start + 1] in ("[", "{") and offset > start:
        prefix = text[start:offset]
        start += max(prefix.rfind(mark) for mark in "[{,") + 1
        in_list = True
        if entry.value.startswith("{"):
            key, colon, _ = text[start:offset].partition(":")
            if not colon:
                start = max(start + len(key) - len(key.lstrip()), text.rfind("\n", 0, offset) + 1)
                return YamlCursor(YamlPosition.KEY, offset, entry, start, key.strip())
    start = max(start, text.rfind("\n", 0, offset) + 1)
    typed = text[start:offset]
    start += len(typed) - len(typed.lstrip())
    if text[start : start + 1] in ('"', "'") and offset > start:
        start += 1
    parent = entry.parent if entry.is_item and entry.parent is not None else entry
    return YamlCursor(YamlPosition.VALUE, offset, parent, min(start, offset), text[start:offset], None, in_list)
