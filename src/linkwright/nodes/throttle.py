"""robot_state_publisher's limit on how often the transforms of a joint are published."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from linkwright.messages import FloatSequence


class JointGroup:
    """The joints of a message, as a throttle knows them; one object for each list of names."""

    __slots__ = ("positions", "rows")

    def __init__(self, rows: NDArray[np.intp]) -> None:
        self.rows = rows
        self.positions: NDArray[np.float64] | None = None
        """A copy of those published last: a publisher may use its message again."""


class Throttle:
    """Remembers when the transforms of each joint were published. Times are nanoseconds; 0 is never.

    A message is published when its stamp is an interval or more after that of its joints was published that has waited
    longest. Messages that repeat the positions of the one before, such as the steady beat of joint_state_publisher,
    must keep that distance from all messages; those with new positions only from other new ones. So a beat does not
    hold up the move that comes after it.

    Args:
        interval_ns: the least time between two messages about the same joints.
    """

    def __init__(self, interval_ns: int) -> None:
        self.interval_ns = interval_ns
        self._places: dict[str, int] = {}
        self._groups: dict[tuple[str, ...], JointGroup] = {}
        self._sent_ns: NDArray[np.int64] = np.zeros(0, dtype=np.int64)
        self._moved_ns: NDArray[np.int64] = np.zeros(0, dtype=np.int64)
        self._stamp_ns: NDArray[np.int64] = np.zeros(0, dtype=np.int64)

    def group(self, names: Sequence[str]) -> JointGroup:
        """The group of these joints, at least one."""
        key = tuple(names)
        group = self._groups.get(key)
        if group is None:
            rows = [self._places.setdefault(name, len(self._places)) for name in key]
            new = np.zeros(len(self._places) - len(self._sent_ns), dtype=np.int64)
            self._sent_ns = np.append(self._sent_ns, new)
            self._moved_ns = np.append(self._moved_ns, new)
            self._stamp_ns = np.append(self._stamp_ns, new)
            group = self._groups[key] = JointGroup(np.array(rows, dtype=np.intp))
        return group

    def is_move(self, group: JointGroup, positions: FloatSequence) -> bool:
        """Whether these positions are others than those published last."""
        return group.positions is None or not np.array_equal(group.positions, positions)

    def opens_ns(self, group: JointGroup, now_ns: int, *, move: bool) -> int:
        """The stamp from which on a message is published."""
        before = self._moved_ns if move else self._sent_ns
        return min(int(before[group.rows].min()), now_ns) + self.interval_ns

    def is_in_order(self, group: JointGroup, stamp_ns: int) -> bool:
        """Whether all the joints were published before, and none with a later stamp."""
        stamps = self._stamp_ns[group.rows]
        return bool(stamps.all() and (stamps <= stamp_ns).all())

    def published(self, group: JointGroup, positions: FloatSequence, stamp_ns: int, at_ns: int) -> None:
        """Take note that a message with a stamp was published at a time."""
        if self.is_move(group, positions):
            self._moved_ns[group.rows] = at_ns
        self._sent_ns[group.rows] = at_ns
        self._stamp_ns[group.rows] = stamp_ns
        group.positions = np.array(positions, dtype=np.float64)

    def clear(self) -> None:
        """Forget what was published."""
        for times in (self._sent_ns, self._moved_ns, self._stamp_ns):
            times[:] = 0
