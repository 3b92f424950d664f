"""Compute the type hashes (RIHS01) that ROS 2 Iron and newer announce with endpoints.

Such a hash is the SHA-256 of a type description, as in type_description_interfaces (REP 2011, REP 2016). It contains
the names and types of the fields of a structure and of all nested structures, without defaults and constants. rosidl
hashes the description as JSON, with the separators and the order of keys that this module uses.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from linkwright.messages.definitions.interfaces import (
    Action,
    Container,
    Definition,
    Field,
    FieldType,
    Service,
    Structure,
    make_event_structure,
    make_feedback_structure,
    make_get_result_service,
    make_send_goal_service,
)
from linkwright.messages.definitions.library import LIBRARY

_NESTED_TYPE_ID = 1
_BOUNDED_TEXT_OFFSET = 4
"""The difference between the type ids of a bounded and an unbounded string.

The ids are 21 and 17 for strings, and 22 and 18 for wide strings.
"""

_CONTAINER_OFFSETS = {Container.ONE: 0, Container.ARRAY: 48, Container.SEQUENCE: 144}
_BOUNDED_SEQUENCE_OFFSET = 96


def type_hash(interface: Any) -> str:
    """Return the hash of a message, service or action: ``RIHS01_`` and 64 hexadecimal digits.

    Args:
        interface: the class, or its type name.

    Raises:
        InterfaceNotFoundError: there is no interface with this name.
    """
    name = interface if isinstance(interface, str) else interface.TYPE_NAME
    return _hash_by_name(LIBRARY.definition(name).type_name)


@cache
def _hash_by_name(type_name: str) -> str:
    return compute_hash(make_type_description(LIBRARY.definition(type_name)))


def compute_hash(description: dict[str, Any]) -> str:
    """Return the RIHS01 hash of a type description."""
    import hashlib  # imported here because a process without network peers does not need hashes
    import json

    return "RIHS01_" + hashlib.sha256(json.dumps(description, separators=(", ", ": ")).encode()).hexdigest()


def make_type_description(definition: Definition) -> dict[str, Any]:
    """Return the description of a type and of all nested types.

    It has the fields of a type_description_interfaces/msg/TypeDescription, without default values.
    """
    description = _describe_definition(definition)
    nested_descriptions: dict[str, dict[str, Any]] = {}
    pending = _find_nested_names(description)
    while pending:
        name = pending.pop()
        if name not in nested_descriptions:
            nested_descriptions[name] = _describe_definition(LIBRARY.definition(name))
            pending += _find_nested_names(nested_descriptions[name])
    return {
        "type_description": description,
        "referenced_type_descriptions": [nested_descriptions[name] for name in sorted(nested_descriptions)],
    }


def _find_nested_names(description: dict[str, Any]) -> list[str]:
    return [name for field in description["fields"] if (name := field["type"]["nested_type_name"])]


def _describe_definition(definition: Definition) -> dict[str, Any]:
    return {"type_name": definition.type_name, "fields": [_describe_field(field) for field in _get_fields(definition)]}


def _get_fields(definition: Definition) -> tuple[Field, ...]:
    """Return the fields of a definition.

    For a service or action, there is a field for each of its parts.
    """
    if isinstance(definition, Structure):
        return definition.wire_fields
    if isinstance(definition, Service):
        parts: dict[str, Definition] = {
            "request_message": definition.request,
            "response_message": definition.response,
            "event_message": make_event_structure(definition),
        }
    else:
        assert isinstance(definition, Action)
        parts = {
            "goal": definition.goal,
            "result": definition.result,
            "feedback": definition.feedback,
            "send_goal_service": make_send_goal_service(definition),
            "get_result_service": make_get_result_service(definition),
            "feedback_message": make_feedback_structure(definition),
        }
    return tuple(Field(name, FieldType(part.type_name)) for name, part in parts.items())


def _describe_field(field: Field) -> dict[str, Any]:
    kind, primitive = field.type, field.type.primitive
    type_id = _NESTED_TYPE_ID if primitive is None else primitive.type_id
    if kind.string_bound is not None:
        type_id += _BOUNDED_TEXT_OFFSET
    is_bounded = kind.container is Container.SEQUENCE and kind.size is not None
    return {
        "name": field.name,
        "type": {
            "type_id": type_id + (_BOUNDED_SEQUENCE_OFFSET if is_bounded else _CONTAINER_OFFSETS[kind.container]),
            "capacity": kind.size or 0,
            "string_capacity": kind.string_bound or 0,
            "nested_type_name": kind.base if primitive is None else "",
        },
    }
