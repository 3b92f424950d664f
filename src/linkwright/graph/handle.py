"""What stands for the C object behind something of rclpy: entered while that is used."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING

from linkwright.graph.faults import InvalidHandleError

if TYPE_CHECKING:
    from typing_extensions import Self


class Handle:
    """Entered while what it belongs to is used (rclpy ``handle``).

    Args:
        is_destroyed: whether that was destroyed.
    """

    def __init__(self, is_destroyed: Callable[[], bool]) -> None:
        self._is_destroyed = is_destroyed
        self._users = 0

    @property
    def pointer(self) -> int:
        """A number that tells it from others."""
        return id(self)

    def __enter__(self) -> Self:
        if not self._users and self._is_destroyed():
            raise InvalidHandleError
        self._users += 1
        return self

    def __exit__(self, *_: object) -> None:
        self._users -= 1


class Handled:
    """Something with a `handle`, and with an attribute ``destroyed``."""

    __slots__ = ()

    destroyed: bool

    @property
    def handle(self) -> Handle:
        """To be entered while this is used; raises InvalidHandleError then, if it was destroyed."""
        found = _handles.get(self)
        if found is None:
            owner = weakref.ref(self)
            found = _handles[self] = Handle(lambda: getattr(owner(), "destroyed", True))
        return found


_handles: weakref.WeakKeyDictionary[Handled, Handle] = weakref.WeakKeyDictionary()
