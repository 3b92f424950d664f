"""The fields and constants of types, as rosapi's messages ``TypeDef``."""

from __future__ import annotations

from typing import Any

from linkwright.messages import definition_of, get_message
from linkwright.messages.definitions.interfaces import Container, FieldType


def list_type_definitions(message_class: type[Any]) -> list[Any]:
    """Return the definition of a type, followed by those of the messages in it."""
    definitions = [_define(message_class)]
    seen = {message_class.TYPE_NAME}
    pending = list(definition_of(message_class).references)
    while pending:
        name = pending.pop(0)
        if name not in seen:
            seen.add(name)
            nested_class = get_message(name)
            definitions.append(_define(nested_class))
            pending += definition_of(nested_class).references
    return definitions


def _define(message_class: type[Any]) -> Any:
    definition = definition_of(message_class)
    message = message_class()
    fields = definition.fields
    return get_message("rosapi_msgs/msg/TypeDef")(
        type=_shorten(message_class.TYPE_NAME),
        fieldnames=[field.name for field in fields],
        fieldtypes=[_name_type(field.type) for field in fields],
        fieldarraylen=[_measure(field.type) for field in fields],
        examples=[_describe_default(field.type, getattr(message, field.name)) for field in fields],
        constnames=[constant.name for constant in definition.constants],
        constvalues=[str(constant.value) for constant in definition.constants],
    )


def _shorten(type_name: str) -> str:
    """Return a name as rosbridge writes it, such as ``std_msgs/Header``."""
    package, _, rest = type_name.partition("/")
    return f"{package}/{rest.rpartition('/')[2]}"


def _name_type(kind: FieldType) -> str:
    return _shorten(kind.base) if kind.primitive is None else kind.primitive.idl_name


def _measure(kind: FieldType) -> int:
    if kind.container is Container.ARRAY:
        return kind.size or 0
    return -1 if kind.container is Container.ONE else 0


def _describe_default(kind: FieldType, value: Any) -> str:
    if kind.container is not Container.ONE:
        return "[]"
    return "{}" if kind.primitive is None else str(value)
