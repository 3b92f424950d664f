"""Which fields of a topic's messages can be plotted, for the user to choose from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from linkwright.messages import Message, definition_of, get_message
from linkwright.messages.definition import Container, Field
from linkwright.viewer.features.monitor.field_paths import element_names, is_number
from linkwright.viewer.protocol.plots import PlotField

_MOST_FIELDS = 500
_MOST_ELEMENTS = 64
"""Of an array; others can be named by hand."""


def plot_fields(message_class: type[Message], message: Message | None = None) -> list[PlotField]:
    """The numbers of a type of messages, in the order of its fields.

    Args:
        message_class: the type.
        message: one of it, which tells how many elements its arrays have and what they are called; without one an
            array of any length is offered with its first element.
    """
    found: list[PlotField] = []
    for path, kind in _numbers(message_class, message, "", []):
        found.append(PlotField(path, kind))
        if len(found) == _MOST_FIELDS:
            break
    return found


def _numbers(
    cls: type[Message], message: Message | None, prefix: str, owners: Sequence[Any]
) -> Iterator[tuple[str, str]]:
    for field in definition_of(cls).fields:
        path = f"{prefix}{field.name}"
        value = None if message is None else getattr(message, field.name)
        inner = [*owners, message]
        if field.type.container is Container.ONE:
            yield from _value(field, value, path, inner)
        elif value is None:
            yield from _value(field, None, f"{path}[0]", inner)
        else:
            yield from _elements(field, value, path, inner)


def _elements(field: Field, values: Any, path: str, owners: Sequence[Any]) -> Iterator[tuple[str, str]]:
    if not is_number(field.type) and field.type.primitive is not None:
        return
    names = element_names(owners, values)
    plain = names is None or len(set(names)) < len(names) or any(_is_awkward(name) for name in names)
    for index in range(min(len(values), _MOST_ELEMENTS)):
        key = str(index) if plain or names is None else names[index]
        yield from _value(field, values[index], f"{path}[{key}]", owners)


def _value(field: Field, value: Any, path: str, owners: Sequence[Any]) -> Iterator[tuple[str, str]]:
    if is_number(field.type):
        primitive = field.type.primitive
        yield path, "seconds" if primitive is None else primitive.idl_name
    elif field.type.primitive is None:
        yield from _numbers(get_message(field.type.base), value, f"{path}.", owners)


def _is_awkward(name: str) -> bool:
    """Whether a name cannot be written in brackets."""
    return not name or name.isdecimal() or "[" in name or "]" in name
