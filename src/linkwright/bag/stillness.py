"""The content of messages without their stamps, to detect a stream that only repeats itself."""

from __future__ import annotations

import struct
from array import array
from functools import cache
from typing import NamedTuple

_TRANSFORMS = "tf2_msgs/msg/TFMessage"
_CLOCK = "rosgraph_msgs/msg/Clock"
_TOLD = struct.Struct("<iI")
_SECOND = 1_000_000_000
_SAME_PLACE = 1e-9
"""m, and the same for the numbers of a quaternion: a simulated robot at rest moves by 1e-12 in each step."""

_CAPSULE = 4
"""Bytes before the message: its encoding, from whose end places are counted."""
_STAMP = 8
_NUMBERS = 56
_LITTLE = 1


class Content(NamedTuple):
    """The content of a message without its stamps.

    Attributes:
        what: what it is about: the frames of transforms, since many nodes publish on their topic; else empty.
        state: the serialized values without stamps, and of transforms without poses.
        poses: the numbers of the poses, float64: positions in m and quaternions.
        told_ns: the simulated time that a message of a clock tells; None for any other message.
    """

    what: str
    state: bytes
    poses: bytes = b""
    told_ns: int | None = None

    def is_repeated_by(self, newer: Content) -> bool:
        """Whether a newer message says the same; poses may differ by a nanometre."""
        if self.state != newer.state or len(self.poses) != len(newer.poses):
            return False
        if self.poses == newer.poses:
            return True
        return all(
            abs(was - now) <= _SAME_PLACE
            for was, now in zip(array("d", self.poses), array("d", newer.poses), strict=True)
        )


def content_of(type_name: str, data: bytes) -> Content | None:
    """The content of a message of a type that begins with a header, of transforms or a clock; None of any other.

    Messages without a stamp report events: two equal ones do not mean that nothing happened.
    """
    if type_name == _TRANSFORMS:
        return _content_of_transforms(data)
    if type_name == _CLOCK:
        return _content_of_clock(data)
    if not _begins_with_header(type_name):
        return None
    return Content("", data[:_CAPSULE] + data[_CAPSULE + _STAMP :])


def clock_between(earlier: bytes, later: bytes, share: float) -> bytes:
    """A message of a clock between two others, whose times passed evenly: after a share of the way, 0 to 1."""
    (first, last) = (content.told_ns or 0 for content in map(_content_of_clock, (earlier, later)) if content)
    return earlier[:_CAPSULE] + _TOLD.pack(*divmod(first + round(share * (last - first)), _SECOND))


def _content_of_clock(data: bytes) -> Content | None:
    if len(data) < _CAPSULE + _TOLD.size or data[1] != _LITTLE:
        return None
    seconds, nanoseconds = _TOLD.unpack_from(data, _CAPSULE)
    return Content("", b"", told_ns=seconds * _SECOND + nanoseconds)


@cache
def _begins_with_header(type_name: str) -> bool:
    from linkwright.messages import get_message

    fields = get_message(type_name).get_fields_and_field_types()
    return next(iter(fields.values()), "") == "std_msgs/Header"


def _content_of_transforms(data: bytes) -> Content | None:
    """The frames and their poses; None where the bytes are big-endian or end too early."""
    if len(data) < 2 * _CAPSULE or data[1] != _LITTLE:
        return None
    state = bytearray(data[_CAPSULE:])
    children: list[str] = []
    poses = bytearray()
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
            at += -at % 8
            poses += state[at : at + _NUMBERS]
            state[at : at + _NUMBERS] = bytes(_NUMBERS)
            at += _NUMBERS
    except struct.error:
        return None
    if len(poses) != _NUMBERS * len(children):
        return None
    return Content("\n".join(children), bytes(state), bytes(poses))
