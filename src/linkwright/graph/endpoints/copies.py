"""Copies of messages, for programs that change what they have sent or received.

Within a process messages are handed over as they are. Programs written for rclpy need not know of that: there each
message is written at once and read by everyone who gets it, and they fill the same message again and again.
"""

from __future__ import annotations

from typing import Any, TypeVar

from linkwright.messages import deserialize, serialize

M = TypeVar("M")


def copy_of(message: M) -> M:
    """An equal message that shares nothing with a message.

    Raises:
        MessageDataError: what is in the message is not what its type says.
    """
    copied: Any = message
    return deserialize(serialize(copied), type(copied))  # type: ignore[no-any-return]  # the same type
