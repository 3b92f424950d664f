"""Paths to numbers in a message: ``position[2]``, ``position[elbow]``, ``linear.x``.

Names select fields of nested messages. Brackets select an element of an array by its index or name. The names of
elements are the items of a list of names in the same or an enclosing message (``name`` of a JointState,
``joint_names`` of a JointTrajectory and its points). If the elements are messages, their names are in a field (``name``
of a DiagnosticStatus, ``child_frame_id`` of a TransformStamped). Booleans count as 0 and 1. Times and durations are in
seconds.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from linkwright.diagnostics import did_you_mean, phrase
from linkwright.messages import Message, definition_of, get_message
from linkwright.messages.definitions.interfaces import Container, Field, FieldType
from linkwright.page.protocol.monitor import PlotField
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

NAME_LISTS = ("name", "names", "joint_names")
"""Fields with the names of the elements of arrays in the same message or in nested messages."""

NAME_FIELDS = ("name", "child_frame_id")
"""Fields that contain the name of an array element, which is a message."""

SECONDS = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")
"""Messages that represent a number of seconds."""

_STEP_PATTERN = re.compile(r"([A-Za-z_]\w*)((?:\[[^\[\]]+\])*)")


class FieldPathError(ValueError):
    """Raised when a path is not valid or does not lead to a number.

    The message gives the reason.
    """


@dataclass(frozen=True, slots=True)
class _Step:
    name: str
    keys: tuple[int | str, ...]


class FieldPath:
    """A path to a number in a message.

    Args:
        text: the path, in the notation of this module.

    Raises:
        FieldPathError: the text is not a valid path.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self._steps: list[_Step] = []
        offset = 0
        while True:
            match = _STEP_PATTERN.match(text, offset)
            if match is None:
                raise FieldPathError(f"'{text}' is not a field; write a path such as 'position[0]' or 'twist.linear.x'")
            keys = re.findall(r"\[([^\]]+)\]", match[2])
            self._steps.append(_Step(match[1], tuple(int(key) if key.isdecimal() else key for key in keys)))
            offset = match.end()
            if offset == len(text):
                return
            if text[offset] != ".":
                raise FieldPathError(f"'{text}' is not a field; there must be a dot before '{text[offset:]}'")
            offset += 1

    def check(self, message_class: type[Message]) -> None:
        """Raise if the path does not lead to a number in messages of a class.

        Raises:
            FieldPathError: the path does not lead to a number.
        """
        cls: type[Message] | None = message_class
        field_type: FieldType | None = None
        for position, step in enumerate(self._steps):
            if cls is None:
                raise FieldPathError(f"'{self._steps[position - 1].name}' has no fields")
            kinds = {field.name: field.type for field in definition_of(cls).fields}
            field_type = kinds.get(step.name)
            if field_type is None:
                suggestion = did_you_mean(step.name, kinds) or phrase(
                    "its fields are {fields}", fields=", ".join(kinds)
                )
                raise FieldPathError(f"{cls.TYPE_NAME} has no field '{step.name}'; {suggestion}")
            self._check_keys(step, field_type)
            cls = None if field_type.primitive is not None else get_message(field_type.base)
        assert field_type is not None
        if not is_number(field_type):
            raise FieldPathError(f"'{self.text}' is not a number but a {field_type.base}")

    def value(self, message: Any) -> float | None:
        """Return the number in a message, or None if the message has no such element."""
        owners = []
        element = message
        for step in self._steps:
            owners.append(element)
            element = getattr(element, step.name)
            for key in step.keys:
                index = key if isinstance(key, int) else _find_index(key, element, owners)
                if index is None or index >= len(element):
                    return None
                element = element[index]
        return _to_number(element)

    @staticmethod
    def _check_keys(step: _Step, kind: FieldType) -> None:
        is_array = kind.container is not Container.ONE
        if is_array and len(step.keys) != 1:
            raise FieldPathError(f"'{step.name}' is an array; select an element, such as '{step.name}[0]'")
        if not is_array and step.keys:
            raise FieldPathError(f"'{step.name}' is not an array")
        if kind.container is Container.ARRAY and isinstance(step.keys[0], int) and step.keys[0] >= (kind.size or 0):
            raise FieldPathError(f"'{step.name}' has {kind.size} elements")


def is_number(kind: FieldType) -> bool:
    """Return whether a field's value, or an element of its array, is a number."""
    primitive = kind.primitive
    return kind.base in SECONDS if primitive is None else primitive.python is not str


def find_element_names(owners: Sequence[Any], values: Any) -> Sequence[str] | None:
    """Return the names of an array's elements in order, or None if they have no names.

    Args:
        owners: the nested messages, from the outermost message to the message that contains the array.
        values: the array.
    """
    if len(values) and isinstance(values[0], Message):
        for field in NAME_FIELDS:
            if isinstance(getattr(values[0], field, None), str):
                return [getattr(value, field) for value in values]
        return None
    for owner in reversed(owners):
        for field in NAME_LISTS:
            names = getattr(owner, field, None)
            if isinstance(names, list) and len(names) == len(values) and names is not values:
                return names
    return None


def _find_index(name: str, values: Any, owners: Sequence[Any]) -> int | None:
    names = find_element_names(owners, values)
    return list(names).index(name) if names is not None and name in names else None


def _to_number(value: Any) -> float:
    if isinstance(value, Message):
        return float(value.nanoseconds) / NANOSECONDS_PER_SECOND  # type: ignore[attr-defined]  # a Time or a Duration
    return float(value[0]) if isinstance(value, bytes) else float(value)


_MAX_FIELDS = 500
_MAX_ELEMENTS = 64
"""The number of elements of an array that are offered. Users can enter the index of any other element."""


def find_plot_fields(message_class: type[Message], message: Message | None = None) -> list[PlotField]:
    """Return the paths of the numbers in a message type, in the order of its fields.

    Args:
        message_class: the type.
        message: an example with the lengths and element names of arrays; None to offer only the first element of each
            array.
    """
    fields: list[PlotField] = []
    for path, type_name in _iterate_number_fields(message_class, message, "", []):
        fields.append(PlotField(path, type_name))
        if len(fields) == _MAX_FIELDS:
            break
    return fields


def _iterate_number_fields(
    cls: type[Message], message: Message | None, prefix: str, owners: Sequence[Any]
) -> Iterator[tuple[str, str]]:
    for field in definition_of(cls).fields:
        path = f"{prefix}{field.name}"
        value = None if message is None else getattr(message, field.name)
        nested_owners = [*owners, message]
        if field.type.container is Container.ONE:
            yield from _iterate_value_fields(field, value, path, nested_owners)
        elif value is None:
            yield from _iterate_value_fields(field, None, f"{path}[0]", nested_owners)
        else:
            yield from _iterate_element_fields(field, value, path, nested_owners)


def _iterate_element_fields(field: Field, values: Any, path: str, owners: Sequence[Any]) -> Iterator[tuple[str, str]]:
    if not is_number(field.type) and field.type.primitive is not None:
        return
    names = find_element_names(owners, values)
    uses_indices = names is None or len(set(names)) < len(names) or any(_is_ambiguous(name) for name in names)
    for index in range(min(len(values), _MAX_ELEMENTS)):
        key = str(index) if uses_indices or names is None else names[index]
        yield from _iterate_value_fields(field, values[index], f"{path}[{key}]", owners)


def _iterate_value_fields(field: Field, value: Any, path: str, owners: Sequence[Any]) -> Iterator[tuple[str, str]]:
    if is_number(field.type):
        primitive = field.type.primitive
        yield path, "seconds" if primitive is None else primitive.idl_name
    elif field.type.primitive is None:
        yield from _iterate_number_fields(get_message(field.type.base), value, f"{path}.", owners)


def _is_ambiguous(name: str) -> bool:
    """Return whether a name would be ambiguous in brackets, so that the index is used instead."""
    return not name or name.isdecimal() or "[" in name or "]" in name
