"""A message as a tree of texts, with long arrays and long texts cut short."""

from __future__ import annotations

from typing import Any

from linkwright.messages import Message, definition_of
from linkwright.messages.definition import Container, Field
from linkwright.viewer.protocol.topics import MessageField

_MOST_ROWS = 1500
"""In one message; what is beyond is left out."""
_MOST_ELEMENTS = 64
_SHOWN_ELEMENTS = 8
"""Of an array, in the row of the array itself."""
_LONGEST_TEXT = 400


def message_tree(message: Message) -> list[MessageField]:
    """The fields of a message, in their order."""
    return _Tree().fields(message)


class _Tree:
    def __init__(self) -> None:
        self._left = _MOST_ROWS

    def fields(self, message: Message) -> list[MessageField]:
        rows = []
        for field in definition_of(type(message)).fields:
            if self._left <= 0:
                break
            value = getattr(message, field.name)
            if field.type.container is Container.ONE:
                rows.append(self._one(field.name, field, value))
            else:
                rows.append(self._several(field, value))
        return rows

    def _one(self, name: str, field: Field, value: Any) -> MessageField:
        self._left -= 1
        kind = field.type._replace(container=Container.ONE, size=None).described()
        if isinstance(value, Message):
            return MessageField(name, kind, "", self.fields(value))
        return MessageField(name, kind, _text(value))

    def _several(self, field: Field, values: Any) -> MessageField:
        self._left -= 1
        kind = field.type.described()
        count = len(values)
        if field.type.primitive is None:
            row = MessageField(field.name, kind, "")
        else:
            shown = ", ".join(_text(each) for each in values[:_SHOWN_ELEMENTS])
            row = MessageField(field.name, kind, f"[{shown}{', ...' if count > _SHOWN_ELEMENTS else ''}]")
        for index in range(min(count, _MOST_ELEMENTS)):
            if self._left <= 0:
                break
            row.children.append(self._one(f"[{index}]", field, values[index]))
        row.omitted = count - len(row.children)
        return row


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, bytes):
        return f"0x{value.hex()}"
    if isinstance(value, str):
        return value if len(value) <= _LONGEST_TEXT else f"{value[:_LONGEST_TEXT]}..."
    return str(value)
