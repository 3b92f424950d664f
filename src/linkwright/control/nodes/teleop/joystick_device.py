"""Joysticks on Linux, read from the kernel's joystick interface (/dev/input/js*).

Source of the format: the kernel's documentation of the joystick API (``linux/joystick.h``).
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import struct
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

DEVICE_FOLDER = Path("/dev/input")
MAX_VALUE = 32767
"""The value of an axis at one end of its travel. The value at the other end is the negative."""

_EVENT_FORMAT = struct.Struct("=IhBB")
_BUTTON_FLAG, _AXIS_FLAG, _INITIAL_FLAG = 0x01, 0x02, 0x80
_MAX_EVENTS_PER_READ = 64
_NAME_BYTES = 128
_GET_NAME_REQUEST = 0x80006A13 | _NAME_BYTES << 16


class JoystickEvent(NamedTuple):
    """A change of an axis or a button.

    Attributes:
        is_axis: whether an axis has changed; otherwise a button has changed.
        number: the number of the axis or button, from 0.
        value: for an axis -32767 to 32767, positive to the right and backwards; for a button 1 while it is pressed.
        is_initial: whether the event reports the state when the device was opened.
    """

    is_axis: bool
    number: int
    value: int
    is_initial: bool = False


class JoystickDevice:
    """An open joystick.

    Args:
        path: the path of the device.
        on_events: called with each list of events.
        on_end: called once when the device is unplugged.

    Raises:
        OSError: the device cannot be opened.
    """

    def __init__(
        self, path: Path, on_events: Callable[[list[JoystickEvent]], None], on_end: Callable[[], None]
    ) -> None:
        self._on_events, self._on_end = on_events, on_end
        self._incomplete_event = b""
        self._descriptor: int | None = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
        self.name = _read_device_name(self._descriptor)
        try:
            asyncio.get_running_loop().add_reader(self._descriptor, self._read)
        except OSError:  # The event loop cannot watch a folder or a file.
            os.close(self._descriptor)
            raise

    def close(self) -> None:
        """Close the device.

        Further calls do nothing.
        """
        descriptor, self._descriptor = self._descriptor, None
        if descriptor is not None:
            asyncio.get_running_loop().remove_reader(descriptor)
            os.close(descriptor)

    def _read(self) -> None:
        assert self._descriptor is not None
        try:
            data = os.read(self._descriptor, _EVENT_FORMAT.size * _MAX_EVENTS_PER_READ)
        except BlockingIOError:
            return
        except OSError:  # The joystick was unplugged.
            data = b""
        if not data:
            self.close()
            self._on_end()
            return
        data = self._incomplete_event + data
        complete_bytes = len(data) - len(data) % _EVENT_FORMAT.size
        self._incomplete_event = data[complete_bytes:]
        self._on_events(list(_parse_events(data[:complete_bytes])))


def find_device(number: int, name: str = "") -> Path | None:
    """Return the path of the joystick with a number or a name, or None if it is not connected.

    Args:
        number: the number in ``/dev/input/jsNUMBER``.
        name: a part of the name; empty to use the number.
    """
    if not name:
        path = DEVICE_FOLDER / f"js{number}"
        return path if path.exists() else None
    for path in sorted(DEVICE_FOLDER.glob("js*")):
        with contextlib.suppress(OSError):
            descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
            try:
                if name in _read_device_name(descriptor):
                    return path
            finally:
                os.close(descriptor)
    return None


def _parse_events(data: bytes) -> Iterator[JoystickEvent]:
    for _, value, kind, number in _EVENT_FORMAT.iter_unpack(data):
        if kind & ~_INITIAL_FLAG in (_BUTTON_FLAG, _AXIS_FLAG):
            yield JoystickEvent(bool(kind & _AXIS_FLAG), number, value, bool(kind & _INITIAL_FLAG))


def _read_device_name(descriptor: int) -> str:
    if sys.platform == "win32":
        return ""
    import fcntl

    buffer = bytearray(_NAME_BYTES)
    try:
        fcntl.ioctl(descriptor, _GET_NAME_REQUEST, buffer)
    except OSError:  # The file is not a joystick.
        return ""
    return buffer.split(b"\0", 1)[0].decode("utf-8", "replace")
