"""Extract the content of messages without their stamps, to detect repeating streams."""

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
_TOLERANCE = 1e-9
"""The tolerance in m, and for the elements of a quaternion.

A simulated robot at rest moves by 1e-12 in each step.
"""

_ENCAPSULATION_SIZE = 4
"""The bytes of the encapsulation header before the message. Alignment counts from its end."""
_STAMP_SIZE = 8
_POSE_SIZE = 56
_LITTLE_ENDIAN = 1


class Content(NamedTuple):
    """The content of a message without its stamps.

    Attributes:
        child_frames: the child frames of transforms, because many nodes publish on one topic; empty for other messages.
        state: the serialized values without stamps, and for transforms also without poses.
        poses: the bytes of the poses' numbers, float64: positions in m, and quaternions.
        clock_ns: the simulated time of a clock message; None for any other message.
    """

    child_frames: str
    state: bytes
    poses: bytes = b""
    clock_ns: int | None = None

    def is_repeated_by(self, newer: Content) -> bool:
        """Return whether a newer message has the same content.

        Positions may differ by 1 nm.
        """
        if self.state != newer.state or len(self.poses) != len(newer.poses):
            return False
        if self.poses == newer.poses:
            return True
        with np.errstate(invalid="ignore"):  # infinite values are compared by their bytes above
            differences = np.abs(np.frombuffer(self.poses) - np.frombuffer(newer.poses))
        return bool((differences <= _TOLERANCE).all())


def extract_content(type_name: str, data: bytes) -> Content | None:
    """Return the content of a message that has a header or contains transforms or a clock.

    Return None for other messages.

    A message without a stamp reports an event: two equal messages report two events.
    """
    if type_name == _TRANSFORMS:
        return _extract_transforms_content(data)
    if type_name == _CLOCK:
        return _extract_clock_content(data)
    if not _begins_with_header(type_name):
        return None
    return Content("", data[:_ENCAPSULATION_SIZE] + data[_ENCAPSULATION_SIZE + _STAMP_SIZE :])


def interpolate_clock(earlier: bytes, later: bytes, fraction: float) -> bytes:
    """Return a clock message with a time interpolated linearly between two clock messages.

    Args:
        earlier: the data of the first message.
        later: the data of the second message.
        fraction: the position between the messages, from 0 for the first to 1 for the second.
    """
    (first_ns, last_ns) = (
        content.clock_ns or 0 for content in map(_extract_clock_content, (earlier, later)) if content
    )
    return earlier[:_ENCAPSULATION_SIZE] + _TIME.pack(
        *divmod(first_ns + round(fraction * (last_ns - first_ns)), NANOSECONDS_PER_SECOND)
    )


def _extract_clock_content(data: bytes) -> Content | None:
    if len(data) < _ENCAPSULATION_SIZE + _TIME.size or data[1] != _LITTLE_ENDIAN:
        return None
    seconds, nanoseconds = _TIME.unpack_from(data, _ENCAPSULATION_SIZE)
    return Content("", b"", clock_ns=seconds * NANOSECONDS_PER_SECOND + nanoseconds)


@cache
def _begins_with_header(type_name: str) -> bool:
    from linkwright.messages import get_message

    fields = get_message(type_name).get_fields_and_field_types()
    return next(iter(fields.values()), "") == "std_msgs/Header"


class _Layout(NamedTuple):
    """The offsets of stamps and poses, which are the same in all messages with the same frames.

    Attributes:
        child_frames: the child frames, one per line.
        state: the bytes after the encapsulation header, with zeros for stamps and poses.
        numbers: the offsets of the bytes that belong to poses.
        blank: the offsets of the bytes that belong to stamps or poses.
    """

    child_frames: str
    state: bytes
    numbers: NDArray[np.intp]
    blank: NDArray[np.intp]


_MAX_LAYOUTS = 64
_layouts: dict[int, _Layout] = {}
"""The last layout for each message size.

Parsing the names of 500 frames takes longer than all other work.
"""


def _extract_transforms_content(data: bytes) -> Content | None:
    """Return the content of transforms, or None if the data is big-endian or truncated."""
    if len(data) < 2 * _ENCAPSULATION_SIZE or data[1] != _LITTLE_ENDIAN:
        return None
    layout = _layouts.get(len(data))
    state = np.frombuffer(data, np.uint8, offset=_ENCAPSULATION_SIZE).copy()
    if layout is not None:
        poses = state[layout.numbers].tobytes()
        state[layout.blank] = 0
        if state.tobytes() == layout.state:
            return Content(layout.child_frames, layout.state, poses)
    layout = _parse_layout(data)
    if layout is None:
        return None
    if len(_layouts) >= _MAX_LAYOUTS:
        _layouts.clear()
    _layouts[len(data)] = layout
    numbers = np.frombuffer(data, np.uint8, offset=_ENCAPSULATION_SIZE)[layout.numbers]
    return Content(layout.child_frames, layout.state, numbers.tobytes())


def _parse_layout(data: bytes) -> _Layout | None:
    state = bytearray(data[_ENCAPSULATION_SIZE:])
    children: list[str] = []
    stamps: list[int] = []
    poses: list[int] = []
    offset = 4
    try:
        for _ in range(struct.unpack_from("<I", state)[0]):
            offset += -offset % 4
            stamps.append(offset)
            offset += _STAMP_SIZE
            for _ in range(2):
                offset += -offset % 4
                (length,) = struct.unpack_from("<I", state, offset)
                text = state[offset + 4 : offset + 4 + length]
                offset += 4 + length
            children.append(text.decode(errors="replace"))
            offset += -offset % 8
            poses.append(offset)
            offset += _POSE_SIZE
    except struct.error:
        return None
    if offset > len(state):
        return None
    numbers = (np.array(poses, np.intp)[:, None] + np.arange(_POSE_SIZE)).ravel()
    blank = np.concatenate(((np.array(stamps, np.intp)[:, None] + np.arange(_STAMP_SIZE)).ravel(), numbers))
    masked = np.frombuffer(bytes(state), np.uint8).copy()
    masked[blank] = 0
    return _Layout("\n".join(children), masked.tobytes(), numbers, blank)
