"""Base classes of builtin_interfaces' Time and Duration, which count in nanoseconds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.messages.message import Message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_Self = TypeVar("_Self", bound="_Nanoseconds")


class _Nanoseconds(Message):
    __slots__ = ()

    sec: Any
    nanosec: Any

    if TYPE_CHECKING:  # it is generated

        def __init__(self, sec: int = 0, nanosec: int = 0) -> None: ...

    @classmethod
    def from_nanoseconds(cls: type[_Self], nanoseconds: int) -> _Self:  # noqa: PYI019 - Python 3.10 has no Self
        """The message for a count of nanoseconds.

        Raises:
            AssertionError: the seconds are more than 32 bits can hold.
        """
        return cls(*divmod(nanoseconds, NANOSECONDS_PER_SECOND))

    @property
    def nanoseconds(self) -> int:
        """The time in nanoseconds."""
        count: int = self.sec * NANOSECONDS_PER_SECOND + self.nanosec
        return count


class TimeValue(_Nanoseconds):
    """A point in time: seconds since the epoch and nanoseconds on top of them, from 0 to 999 999 999."""

    __slots__ = ()


class DurationValue(_Nanoseconds):
    """A span of time: seconds, negative ones too, and nanoseconds on top of them, from 0 to 999 999 999."""

    __slots__ = ()
