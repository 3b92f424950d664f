"""builtin_interfaces: points in time and spans of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

NANOSECONDS_PER_SECOND = 1_000_000_000


@dataclass(slots=True)
class Time:
    """A point in time: seconds since the epoch and nanoseconds on top of them, from 0 to 999 999 999."""

    TYPE_NAME: ClassVar[str] = "builtin_interfaces/msg/Time"

    sec: int = 0
    nanosec: int = 0

    @classmethod
    def from_nanoseconds(cls, nanoseconds: int) -> Time:
        """The message for a count of nanoseconds since the epoch."""
        return cls(*divmod(nanoseconds, NANOSECONDS_PER_SECOND))

    @property
    def nanoseconds(self) -> int:
        """Nanoseconds since the epoch."""
        return self.sec * NANOSECONDS_PER_SECOND + self.nanosec


@dataclass(slots=True)
class Duration:
    """A span of time: seconds, negative ones too, and nanoseconds on top of them, from 0 to 999 999 999."""

    TYPE_NAME: ClassVar[str] = "builtin_interfaces/msg/Duration"

    sec: int = 0
    nanosec: int = 0

    @classmethod
    def from_nanoseconds(cls, nanoseconds: int) -> Duration:
        """The message for a count of nanoseconds."""
        return cls(*divmod(nanoseconds, NANOSECONDS_PER_SECOND))

    @property
    def nanoseconds(self) -> int:
        """The span in nanoseconds."""
        return self.sec * NANOSECONDS_PER_SECOND + self.nanosec
