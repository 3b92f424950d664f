"""Extracts the content of messages without their stamps, to detect streams that repeat themselves."""

from __future__ import annotations

import struct
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_TRANSFORMS = "tf2_msgs/msg/TFMessage"
_CLOCK = "rosgraph_msgs/msg/Clock"
_TIME = struct.Struct("<iI")
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
        what: the child frames of transforms, because many nodes publish on the same topic; empty for other messages.
        state: the serialized values without stamps, and for transforms also without poses.
        poses: the numbers of the poses, float64: positions in m and quaternions.
        clock_ns: the simulated time of a clock message; None for any other message.
    """

    what: str
    state: bytes
    poses: bytes = b""
    clock_ns: int | None = None

    def is_repeated_by(self, newer: Content) -> bool:
        """Return whether a newer message has the same content, with a tolerance of 1 nm for positions."""
        if self.state != newer.state or len(self.poses) != len(newer.poses):
            return False
        if self.poses == newer.poses:
            return True
        with np.errstate(invalid="ignore"):  # infinite values are compared by their bits
            moved = np.abs(np.frombuffer(self.poses) - np.frombuffer(newer.poses))
        return bool((moved <= _SAME_PLACE).all())


def content_of(type_name: str, data: bytes) -> Content | None:
    """Return the content of a message with a header, of transforms or of a clock; otherwise None.

    A message without a stamp reports an event, so two equal messages still report two events.
    """
    if type_name == _TRANSFORMS:
        return _content_of_transforms(data)
    if type_name == _CLOCK:
        return _content_of_clock(data)
    if not _begins_with_header(type_name):
        return None
    return Content("", data[:_CAPSULE] + data[_CAPSULE + _STAMP :])


def clock_between(earlier: bytes, later: bytes, share: float) -> bytes:
    """Return a clock message between two others, with a linearly interpolated time.

    Args:
        earlier: the first message.
        later: the second message.
        share: the position between the two messages, from 0 to 1.
    """
    (first, last) = (content.clock_ns or 0 for content in map(_content_of_clock, (earlier, later)) if content)
    return earlier[:_CAPSULE] + _TIME.pack(*divmod(first + round(share * (last - first)), NANOSECONDS_PER_SECOND))


def _content_of_clock(data: bytes) -> Content | None:
    if len(data) < _CAPSULE + _TIME.size or data[1] != _LITTLE:
        return None
    seconds, nanoseconds = _TIME.unpack_from(data, _CAPSULE)
    return Content("", b"", clock_ns=seconds * NANOSECONDS_PER_SECOND + nanoseconds)


@cache
def _begins_with_header(type_name: str) -> bool:
    from linkwright.messages import get_message

    fields = get_message(type_name).get_fields_and_field_types()
    return next(iter(fields.values()), "") == "std_msgs/Header"


class _Layout(NamedTuple):
    """The offsets of stamps and poses, which are equal in all messages with the same frames.

    Attributes:
        what: the frames.
        state: the bytes behind the encapsulation header, without stamps and poses.
        numbers: the offsets of the bytes of poses.
        blank: the offsets of the bytes of stamps and poses.
    """

    what: str
    state: bytes
    numbers: NDArray[np.intp]
    blank: NDArray[np.intp]


_MOST_LAYOUTS = 64
_layouts: dict[int, _Layout] = {}
"""The last layout of messages of a size: following the names of 500 frames takes longer than all the rest."""


def _content_of_transforms(data: bytes) -> Content | None:
    """Return the content of transforms, or None if the bytes are big-endian or truncated."""
    if len(data) < 2 * _CAPSULE or data[1] != _LITTLE:
        return None
    layout = _layouts.get(len(data))
    state = np.frombuffer(data, np.uint8, offset=_CAPSULE).copy()
    if layout is not None:
        poses = state[layout.numbers].tobytes()
        state[layout.blank] = 0
        if state.tobytes() == layout.state:
            return Content(layout.what, layout.state, poses)
    layout = _layout_of(data)
    if layout is None:
        return None
    if len(_layouts) >= _MOST_LAYOUTS:
        _layouts.clear()
    _layouts[len(data)] = layout
    numbers = np.frombuffer(data, np.uint8, offset=_CAPSULE)[layout.numbers]
    return Content(layout.what, layout.state, numbers.tobytes())


def _layout_of(data: bytes) -> _Layout | None:
    state = bytearray(data[_CAPSULE:])
    children: list[str] = []
    stamps: list[int] = []
    poses: list[int] = []
    at = 4
    try:
        for _ in range(struct.unpack_from("<I", state)[0]):
            at += -at % 4
            stamps.append(at)
            at += _STAMP
            for _ in range(2):
                at += -at % 4
                (length,) = struct.unpack_from("<I", state, at)
                text = state[at + 4 : at + 4 + length]
                at += 4 + length
            children.append(text.decode(errors="replace"))
            at += -at % 8
            poses.append(at)
            at += _NUMBERS
    except struct.error:
        return None
    if at > len(state):
        return None
    numbers = (np.array(poses, np.intp)[:, None] + np.arange(_NUMBERS)).ravel()
    blank = np.concatenate(((np.array(stamps, np.intp)[:, None] + np.arange(_STAMP)).ravel(), numbers))
    bare = np.frombuffer(bytes(state), np.uint8).copy()
    bare[blank] = 0
    return _Layout("\n".join(children), bare.tobytes(), numbers, blank)
