"""Images paired with the ``camera_info`` of the same time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

_MAX_PENDING = 10
"""The number of images and of camera_infos that wait for their counterpart."""


class CameraPairs:
    """A function that is called with each image and its ``camera_info``, whichever arrives first.

    Args:
        receive: called with the message of the image and that of the camera_info.
    """

    def __init__(self, receive: Callable[[Any, Any], object]) -> None:
        self._receive = receive
        self._pending: dict[tuple[int, int], dict[str, Any]] = {}

    def add_image(self, message: Any) -> None:
        """Add an image."""
        self._add("image", message)

    def add_info(self, message: Any) -> None:
        """Add a camera_info."""
        self._add("info", message)

    def _add(self, kind: str, message: Any) -> None:
        stamp = message.header.stamp
        parts = self._pending.setdefault((stamp.sec, stamp.nanosec), {})
        parts[kind] = message
        if len(parts) == 2:
            del self._pending[stamp.sec, stamp.nanosec]
            self._receive(parts["image"], parts["info"])
        while len(self._pending) > _MAX_PENDING:
            del self._pending[next(iter(self._pending))]
