"""The stored transforms of one frame in the tf buffer: a history, or a static transform."""

from __future__ import annotations

from abc import ABC, abstractmethod
from bisect import bisect_right
from typing import TYPE_CHECKING, NamedTuple, cast

from linkwright.diagnostics import phrase
from linkwright.geometry.single import Transform, interpolate
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

_MAX_EXPIRED = 256
"""The maximum number of expired transforms in the list.

They are deleted together, because a deletion moves all remaining entries.
"""


class Sample(NamedTuple):
    """A transform of a frame: the number of its parent, and its pose.

    Attributes:
        parent: the number of the parent frame.
        poses: an array of poses, or the pose itself.
        row: the row of the pose in the array; -1 if `poses` is the pose itself.
    """

    parent: int
    poses: NDArray | Transform  # type: ignore[type-arg]  # rows of floats
    row: int = -1

    def pose(self) -> Transform:
        """Return the pose of the frame in its parent."""
        if self.row < 0:
            return cast("Transform", self.poses)
        return cast("Transform", tuple(cast("NDArray", self.poses)[self.row].tolist()))  # type: ignore[type-arg]  # rows of floats


class NoDataError(Exception):
    """Raised when there is no transform for a time.

    The message names the available times, in tf2's wording; it is empty if there are none.
    """


def format_time(stamp_ns: int) -> str:
    """Format a time, given in nanoseconds, as tf2 does: in seconds with six decimal places."""
    return f"{stamp_ns / NANOSECONDS_PER_SECOND:.6f}"


class FrameCache(ABC):
    """The transforms of one frame."""

    @abstractmethod
    def add(self, stamp_ns: int, sample: Sample) -> bool:
        """Store a transform.

        Return False if it is too old to be stored.
        """

    @abstractmethod
    def at(self, time_ns: int) -> tuple[int, Transform]:
        """Return the number of the parent and the pose at a time.

        Args:
            time_ns: the time in nanoseconds; 0 for the latest transform.

        Raises:
            NoDataError: there is no transform for that time.
        """

    @abstractmethod
    def parent_at(self, time_ns: int) -> int:
        """Return the number of the parent at a time.

        Args:
            time_ns: the time in nanoseconds; 0 for the latest transform.

        Raises:
            NoDataError: there is no transform for that time.
        """

    @abstractmethod
    def latest(self) -> tuple[int, int] | None:
        """Return the stamp of the latest transform, in nanoseconds, and the number of its parent.

        The stamp of a static transform is 0.

        Returns None if there is no transform.
        """

    @abstractmethod
    def oldest_ns(self) -> int:
        """Return the stamp of the oldest transform, in nanoseconds.

        Returns 0 if the transform is static, or if there is none.
        """

    @abstractmethod
    def __len__(self) -> int: ...

    @abstractmethod
    def clear(self) -> None:
        """Remove all transforms."""


class StaticCache(FrameCache):
    """The single transform of a frame that does not move."""

    __slots__ = ("_sample",)

    def __init__(self) -> None:
        self._sample: Sample | None = None

    def add(self, stamp_ns: int, sample: Sample) -> bool:
        """Store a transform in place of the previous one."""
        self._sample = sample
        return True

    def at(self, time_ns: int) -> tuple[int, Transform]:
        """Return the number of the parent and the pose.

        Both are the same at all times.
        """
        return self.parent_at(time_ns), cast("Sample", self._sample).pose()

    def parent_at(self, time_ns: int) -> int:
        """Return the number of the parent, which is the same at all times."""
        if self._sample is None:
            raise NoDataError
        return self._sample.parent

    def latest(self) -> tuple[int, int] | None:
        """Return the stamp 0 and the number of the parent, or None if there is no transform."""
        return None if self._sample is None else (0, self._sample.parent)

    def oldest_ns(self) -> int:
        """Return 0, because a static transform has no stamp."""
        return 0

    def __len__(self) -> int:
        return 1

    def clear(self) -> None:
        """Do nothing. As in tf2, static transforms are kept."""


class MovingCache(FrameCache):
    """The transforms of a frame over time.

    Args:
        span_ns: how long transforms are stored, counted back from the stamp of the latest one, in nanoseconds.
    """

    __slots__ = ("_first", "_samples", "_span_ns", "_stamps")

    def __init__(self, span_ns: int) -> None:
        self._span_ns = span_ns
        self._stamps: list[int] = []
        self._samples: list[Sample] = []
        self._first = 0

    def add(self, stamp_ns: int, sample: Sample) -> bool:
        """Insert a transform by its stamp.

        Return False if it is too old. A transform that equals a stored one with the same stamp is not stored again.
        """
        stamps = self._stamps
        if len(stamps) == self._first:
            stamps.append(stamp_ns)
            self._samples.append(sample)
            return True
        latest = stamps[-1]
        self._prune(latest)
        if stamp_ns > latest:
            stamps.append(stamp_ns)
            self._samples.append(sample)
            return True
        if stamp_ns < latest - self._span_ns:
            return False
        index = bisect_right(stamps, stamp_ns, self._first)
        previous_index = index - 1
        while previous_index >= self._first and stamps[previous_index] == stamp_ns:
            stored_sample = self._samples[previous_index]
            if stored_sample.parent == sample.parent and stored_sample.pose() == sample.pose():
                return True
            previous_index -= 1
        stamps.insert(index, stamp_ns)
        self._samples.insert(index, sample)
        return True

    def at(self, time_ns: int) -> tuple[int, Transform]:
        """Return the number of the parent and the pose at a time.

        The pose is interpolated between the neighboring transforms.
        """
        index = self._index_at(time_ns)
        sample = self._samples[index]
        if time_ns in (0, self._stamps[index]):
            return sample.parent, sample.pose()
        next_sample = self._samples[index + 1]
        if next_sample.parent != sample.parent:
            return sample.parent, sample.pose()
        start_ns, end_ns = self._stamps[index], self._stamps[index + 1]
        return sample.parent, interpolate(sample.pose(), next_sample.pose(), (time_ns - start_ns) / (end_ns - start_ns))

    def parent_at(self, time_ns: int) -> int:
        """Return the number of the parent at a time."""
        return self._samples[self._index_at(time_ns)].parent

    def latest(self) -> tuple[int, int] | None:
        """Return the stamp of the latest transform, in nanoseconds, and the parent's number.

        Return None if there is no transform.
        """
        if len(self._stamps) == self._first:
            return None
        return self._stamps[-1], self._samples[-1].parent

    def oldest_ns(self) -> int:
        """Return the stamp of the oldest transform in nanoseconds, or 0 if there is none."""
        return self._stamps[self._first] if len(self) else 0

    def __len__(self) -> int:
        return len(self._stamps) - self._first

    def clear(self) -> None:
        """Remove all transforms."""
        self._stamps, self._samples, self._first = [], [], 0

    def _index_at(self, time_ns: int) -> int:
        """Return the index of the last transform at or before a time.

        For the time 0, return the index of the latest transform.

        Raises:
            NoDataError: the time is outside the stored range.
        """
        stamps: Sequence[int] = self._stamps
        if len(stamps) == self._first:
            raise NoDataError
        latest, oldest = stamps[-1], stamps[self._first]
        if time_ns in (0, latest):
            return len(stamps) - 1
        if len(self) == 1:
            raise NoDataError(
                phrase(
                    "Lookup would require extrapolation at time {shown_time}, but only time"
                    " {other_shown_time} is in the buffer",
                    shown_time=format_time(time_ns),
                    other_shown_time=format_time(latest),
                )
            )
        if time_ns > latest:
            raise NoDataError(
                phrase(
                    "Lookup would require extrapolation into the future.  Requested time {shown_time} but"
                    " the latest data is at time {other_shown_time}",
                    shown_time=format_time(time_ns),
                    other_shown_time=format_time(latest),
                )
            )
        if time_ns < oldest:
            raise NoDataError(
                phrase(
                    "Lookup would require extrapolation into the past.  Requested time {shown_time} but the"
                    " earliest data is at time {other_shown_time}",
                    shown_time=format_time(time_ns),
                    other_shown_time=format_time(oldest),
                )
            )
        return bisect_right(stamps, time_ns, self._first) - 1

    def _prune(self, latest: int) -> None:
        stamps, first_index = self._stamps, self._first
        while stamps[first_index] + self._span_ns < latest:
            first_index += 1
        if first_index > _MAX_EXPIRED and first_index * 2 > len(stamps):
            del stamps[:first_index], self._samples[:first_index]
            first_index = 0
        self._first = first_index
