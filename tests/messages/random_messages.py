"""Messages of any class with random values, and equal objects of rosbags.

The bytes of both must be equal.
"""

from __future__ import annotations

import random
import sys
from functools import cache
from typing import Any

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.messages.definitions.interfaces import Container, FieldType, Primitive

TEXTS = ("", "a", "base_link", "é漢", "two words", "x" * 300, "multi\nline\n", "yes", "1.5", "- a: b", "'", "\t")


def random_message(cls: type[Any], seed: int) -> Any:
    """Return a message of a class; equal seeds give equal messages."""
    return _message(cls, random.Random(seed))


def _message(cls: type[Any], draw: random.Random) -> Any:
    message = cls()
    for field in cls._definition.fields:
        setattr(message, field.name, _value(field.type, draw))
    return message


def _value(kind: FieldType, draw: random.Random) -> Any:
    if kind.container is not Container.ONE:
        max_length = min(kind.size or 3, 3)
        count = kind.size if kind.container is Container.ARRAY else draw.randint(0, max_length)
        element_type = FieldType(kind.base, kind.string_bound)
        return [_value(element_type, draw) for _ in range(count or 0)]
    if kind.primitive is None:
        return _message(get_message(kind.base), draw)
    return _primitive(kind, kind.primitive, draw)


def _primitive(kind: FieldType, primitive: Primitive, draw: random.Random) -> Any:
    if primitive.python is str:
        return draw.choice(TEXTS)[: kind.string_bound or sys.maxsize]
    if primitive.python is bool:
        return draw.random() < 0.5
    if primitive.python is bytes:
        return bytes([draw.randrange(128)])  # rosbags cannot write larger values
    if primitive.python is int:
        return draw.choice((primitive.low, primitive.high, draw.randint(int(primitive.low), int(primitive.high))))
    return float(np.float32(draw.uniform(-1e3, 1e3)))


@cache
def rosbags_store() -> Any:
    """Return the messages of Humble in rosbags; skip the test without rosbags."""
    typesys = pytest.importorskip("rosbags.typesys")
    return typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)


def rosbags_object(message: Any) -> Any:
    """Return the same message as an object of rosbags."""
    values = {
        field.name: _rosbags_value(field.type, getattr(message, field.name)) for field in message._definition.fields
    }
    return rosbags_store().types[message.TYPE_NAME](**values or {"structure_needs_at_least_one_member": 0})


def _rosbags_value(kind: FieldType, value: Any) -> Any:
    primitive = kind.primitive
    if primitive is None:
        return (
            rosbags_object(value) if kind.container is Container.ONE else [rosbags_object(element) for element in value]
        )
    if kind.container is Container.ONE:
        return value[0] if primitive.python is bytes else value
    if primitive.python is str:
        return list(value)
    if primitive.python is bytes:
        return np.array([byte[0] for byte in value], np.uint8)
    return np.array(value, bool if primitive.python is bool else primitive.dtype)
