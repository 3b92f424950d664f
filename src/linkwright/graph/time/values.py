"""Points in time and durations, with the names and arithmetic of rclpy."""

from __future__ import annotations

from datetime import datetime
from enum import IntEnum
from math import isfinite
from typing import TYPE_CHECKING, Any, overload

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from linkwright import messages

_NANOSECONDS_LIMIT = 2**63


class ClockType(IntEnum):
    """The types of clocks, with the numbers of rcl."""

    UNINITIALIZED = 0
    ROS_TIME = 1
    SYSTEM_TIME = 2
    STEADY_TIME = 3


class Duration:
    """A duration in nanoseconds, as a 64-bit integer (rclpy ``Duration``).

    Args:
        seconds: the seconds, possibly fractional.
        nanoseconds: the nanoseconds to add; a fraction is dropped.

    Raises:
        OverflowError: the duration does not fit into 64 bits.
    """

    __slots__ = ("nanoseconds",)

    def __init__(self, *, seconds: float = 0, nanoseconds: float = 0) -> None:
        total = int(seconds * NANOSECONDS_PER_SECOND) + int(nanoseconds)
        if not -_NANOSECONDS_LIMIT <= total < _NANOSECONDS_LIMIT:
            raise OverflowError("Total nanoseconds value is too large to store in C duration.")
        self.nanoseconds: int = total

    def __repr__(self) -> str:
        return f"Duration(nanoseconds={self.nanoseconds})"

    def __str__(self) -> str:
        return "Infinite" if self == INFINITE else f"{self.nanoseconds} nanoseconds"

    def __hash__(self) -> int:
        return hash(self.nanoseconds)

    def __eq__(self, other: object) -> bool:
        return (
            self.nanoseconds == other.nanoseconds
            if isinstance(other, Duration)
            else _compare_other_type("duration", other)
        )

    def __lt__(self, other: object) -> bool:
        return self.nanoseconds < other.nanoseconds if isinstance(other, Duration) else NotImplemented

    def __le__(self, other: object) -> bool:
        return self.nanoseconds <= other.nanoseconds if isinstance(other, Duration) else NotImplemented

    def __gt__(self, other: object) -> bool:
        return self.nanoseconds > other.nanoseconds if isinstance(other, Duration) else NotImplemented

    def __ge__(self, other: object) -> bool:
        return self.nanoseconds >= other.nanoseconds if isinstance(other, Duration) else NotImplemented

    def __add__(self, other: Duration) -> Duration:
        if not isinstance(other, Duration):
            return NotImplemented
        return Duration(nanoseconds=self.nanoseconds + other.nanoseconds)

    def __sub__(self, other: Duration) -> Duration:
        if not isinstance(other, Duration):
            return NotImplemented
        return Duration(nanoseconds=self.nanoseconds - other.nanoseconds)

    def __mul__(self, factor: float) -> Duration:
        if isinstance(factor, int):
            return Duration(nanoseconds=self.nanoseconds * factor)
        if not isinstance(factor, float):
            return NotImplemented
        if isfinite(factor):
            return Duration(nanoseconds=int(self.nanoseconds * factor))
        if factor == float("inf"):
            return INFINITE
        raise ValueError("Can't multiply duration with nan")

    def to_msg(self) -> messages.Duration:
        """Convert the duration to a builtin_interfaces/msg/Duration."""
        from linkwright import messages

        seconds, nanoseconds = divmod(self.nanoseconds, NANOSECONDS_PER_SECOND)
        return messages.Duration(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: messages.Duration) -> Duration:
        """Convert a builtin_interfaces/msg/Duration to a duration.

        Raises:
            TypeError: `msg` is not a ``builtin_interfaces/msg/Duration``.
        """
        if getattr(msg, "TYPE_NAME", None) != "builtin_interfaces/msg/Duration":
            raise TypeError("Must pass a builtin_interfaces.msg.Duration object")
        return cls(nanoseconds=msg.sec * NANOSECONDS_PER_SECOND + msg.nanosec)


INFINITE = Duration(nanoseconds=_NANOSECONDS_LIMIT - 1)
"""The longest duration, which means no limit in a QoS profile."""


class Time:
    """A time on a ROS, system or steady clock, in nanoseconds since its epoch (rclpy ``Time``).

    Times on different types of clocks cannot be compared or subtracted.

    Args:
        seconds: the seconds since the epoch, possibly fractional.
        nanoseconds: the nanoseconds to add; a fraction is dropped.
        clock_type: the type of clock.

    Raises:
        TypeError: `clock_type` is not a ClockType.
        ValueError: the time is before the epoch.
        OverflowError: the time does not fit into 64 bits.
    """

    __slots__ = ("clock_type", "nanoseconds")

    def __init__(
        self, *, seconds: float = 0, nanoseconds: float = 0, clock_type: ClockType = ClockType.SYSTEM_TIME
    ) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        if seconds < 0:
            raise ValueError("Seconds value must not be negative")
        if nanoseconds < 0:
            raise ValueError("Nanoseconds value must not be negative")
        total = int(seconds * NANOSECONDS_PER_SECOND) + int(nanoseconds)
        if total >= _NANOSECONDS_LIMIT:
            raise OverflowError("Total nanoseconds value is too large to store in C time point.")
        self.nanoseconds: int = total
        self.clock_type = clock_type

    def seconds_nanoseconds(self) -> tuple[int, int]:
        """Return the seconds as an integer, and the remaining nanoseconds."""
        return divmod(self.nanoseconds, NANOSECONDS_PER_SECOND)

    def __repr__(self) -> str:
        return f"Time(nanoseconds={self.nanoseconds}, clock_type={self.clock_type.name})"

    def __hash__(self) -> int:
        return hash((self.nanoseconds, self.clock_type))

    def __add__(self, other: Duration) -> Time:
        if not isinstance(other, Duration):
            return NotImplemented
        try:
            return Time(nanoseconds=self.nanoseconds + other.nanoseconds, clock_type=self.clock_type)
        except OverflowError as error:
            raise OverflowError("Addition leads to overflow in C storage.") from error

    __radd__ = __add__

    @overload
    def __sub__(self, other: Time) -> Duration: ...

    @overload
    def __sub__(self, other: Duration) -> Time: ...

    def __sub__(self, other: Time | Duration) -> Time | Duration:
        if isinstance(other, Time):
            if self.clock_type != other.clock_type:
                raise TypeError("Can't subtract times with different clock types")
            return Duration(nanoseconds=self.nanoseconds - other.nanoseconds)
        if not isinstance(other, Duration):
            return NotImplemented
        try:
            return Time(nanoseconds=self.nanoseconds - other.nanoseconds, clock_type=self.clock_type)
        except ValueError as error:
            raise ValueError("Subtraction leads to negative time.") from error

    def __eq__(self, other: object) -> bool:
        return (
            self.nanoseconds == other._comparable_nanoseconds(self)
            if isinstance(other, Time)
            else _compare_other_type("time", other)
        )

    def __lt__(self, other: object) -> bool:
        return self.nanoseconds < other._comparable_nanoseconds(self) if isinstance(other, Time) else NotImplemented

    def __le__(self, other: object) -> bool:
        return self.nanoseconds <= other._comparable_nanoseconds(self) if isinstance(other, Time) else NotImplemented

    def __gt__(self, other: object) -> bool:
        return self.nanoseconds > other._comparable_nanoseconds(self) if isinstance(other, Time) else NotImplemented

    def __ge__(self, other: object) -> bool:
        return self.nanoseconds >= other._comparable_nanoseconds(self) if isinstance(other, Time) else NotImplemented

    def to_msg(self) -> messages.Time:
        """Convert the point in time to a builtin_interfaces/msg/Time."""
        from linkwright import messages

        seconds, nanoseconds = divmod(self.nanoseconds, NANOSECONDS_PER_SECOND)
        return messages.Time(sec=seconds, nanosec=nanoseconds)

    def to_datetime(self) -> datetime:
        """Convert the point in time to a date and time in the local time zone.

        Raises:
            TypeError: the clock type has no calendar date.
        """
        if self.clock_type not in (ClockType.ROS_TIME, ClockType.SYSTEM_TIME):
            raise TypeError("Time object's clock type should be either ROS_TIME or SYSTEM_TIME")
        return datetime.fromtimestamp(self.nanoseconds / NANOSECONDS_PER_SECOND)  # noqa: DTZ006  # local, as rclpy's

    @classmethod
    def from_msg(cls, msg: Any, clock_type: ClockType = ClockType.ROS_TIME) -> Time:
        """Convert a builtin_interfaces/msg/Time to a point in time.

        Raises:
            TypeError: `msg` is not a ``builtin_interfaces/msg/Time``.
        """
        if getattr(msg, "TYPE_NAME", None) != "builtin_interfaces/msg/Time":
            raise TypeError("Must pass a builtin_interfaces.msg.Time object")
        return cls(nanoseconds=msg.sec * NANOSECONDS_PER_SECOND + msg.nanosec, clock_type=clock_type)

    def _comparable_nanoseconds(self, other: Time) -> int:
        if self.clock_type != other.clock_type:
            raise TypeError("Can't compare times with different clock types")
        return self.nanoseconds


def _compare_other_type(kind: str, other: object) -> bool:
    """Return NotImplemented for a comparison with an object of another type.

    ROS 2 distributions before Iron raise an error instead.

    The error reveals mistakes such as ``duration == 5``.

    Raises:
        TypeError: ``ROS_DISTRO`` is Humble or an earlier distribution.
    """
    from linkwright.messages.distribution import is_before_iron

    if is_before_iron():
        raise TypeError(f"Can't compare {kind} with object of type: {type(other)}")
    return NotImplemented  # type: ignore[no-any-return]  # the return value of operators
