"""Serialization and deserialization of messages (rclpy ``serialization``)."""

from __future__ import annotations

from typing import Any, TypeVar

from linkwright.messages import deserialize, serialize

M = TypeVar("M")


def serialize_message(message: Any) -> bytes:
    """Serialize a message to CDR, including the encapsulation header.

    Raises:
        TypeError: `message` is not a message.
    """
    if not hasattr(message, "TYPE_NAME"):
        raise TypeError(f"{type(message)} is not the class of a message")
    return serialize(message)


def deserialize_message(serialized_message: bytes, message_type: type[M]) -> M:
    """Deserialize a message from CDR.

    Raises:
        TypeError: `message_type` is not a message class.
        LinkwrightError: the bytes are not a message of this type.
    """
    if not hasattr(message_type, "TYPE_NAME"):
        raise TypeError(f"{message_type} is not the class of a message")
    message: M = deserialize(serialized_message, message_type)
    return message
