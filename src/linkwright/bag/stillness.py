"""The content of messages without their stamps, to detect a stream that only repeats itself."""

from __future__ import annotations

import struct
from functools import cache
from typing import NamedTuple

_TRANSFORMS = "tf2_msgs/msg/TFMessage"
_CAPSULE = 4
"""Bytes before the message: its encoding, from whose end places are counted."""
_STAMP = 8
_NUMBERS = 56
_LITTLE = 1


class Content(NamedTuple):
    """The content of a message without its stamps.

    Attributes:
        what: what it is about: the frames of transforms, since many nodes publish on their topic; else empty.
        state: the serialized values without stamps.
    """

    what: str
    state: bytes


def content_of(type_name: str, data: bytes) -> Content | None:
    """The content of a message of a type that begins with a header, or of transforms; None of any other.

    Messages without a stamp report events: two equal ones do not mean that nothing happened.
    """
    if type_name == _TRANSFORMS:
        return _content_of_transforms(data)
    if not _begins_with_header(type_name):
        return None
    return Content("", data[:_CAPSULE] + data[_CAPSULE + _STAMP :])


@cache
def _begins_with_header(type_name: str) -> bool:
    from linkwright.messages import get_message

    fields = get_message(type_name).get_fields_and_field_types()
    return next(iter(fields.values()), "") == "std_msgs/Header"


def _content_of_transforms(data: bytes) -> Content | None:
    """The frames and the poses; None where the bytes are big-endian or end too early."""
    if len(data) < 2 * _CAPSULE or data[1] != _LITTLE:
        return None
    state = bytearray(data[_CAPSULE:])
    children: list[str] = []
    at = 4
    try:
        for _ in range(struct.unpack_from("<I", state)[0]):
            at += -at % 4
            state[at : at + _STAMP] = bytes(_STAMP)
            at += _STAMP
            for _ in range(2):
                at += -at % 4
                (length,) = struct.unpack_from("<I", state, at)
                text = state[at + 4 : at + 4 + length]
                at += 4 + length
            children.append(text.decode(errors="replace"))
            at += -at % 8 + _NUMBERS
    except struct.error:
        return None
    return Content("\n".join(children), bytes(state))
