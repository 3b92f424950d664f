"""Sends the poses of frames to pages, at most at the Frame Rate.

Only changes are sent. A change after a quiet period is sent immediately.

`TimeControl` determines the time at which frames are shown, and `FrameView` informs displays about the frames.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Hashable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.arrays import compose
from linkwright.graph import (
    STATIC_TF_SUBSCRIPTION_QOS,
    TF_QOS,
    Clock,
    FrameSnapshot,
    Node,
    TransformBuffer,
    TransformException,
)
from linkwright.messages import TFMessage
from linkwright.page.protocol.configuration import StatusRow
from linkwright.page.protocol.message import FrameTable, pack_transforms
from linkwright.page.protocol.time import SyncMode
from linkwright.rviz.config.schema import FIXED_FRAME
from linkwright.rviz.frames.history import FrameHistory

_MIN_READ_INTERVAL_S = 0.004
"""The minimum time in s between two reads of the buffer, so that frequent equal transforms cost little."""

_MAX_EARLINESS = 0.8
_PERIOD_FACTOR = 0.95
"""Fractions of the time between two updates: how early an update may be, and when the next update is due.

Transforms may arrive exactly at the update rate, but between the due times of updates. With these fractions each of
them waits slightly less than the previous one.
"""

_AGE_PERIOD_S = 0.25
"""Seconds between updates when no transforms arrive, because frames without new transforms must fade."""

_FADE_STEP = 0.02
"""The change of an age, as a fraction of the Frame Timeout, above which ages are sent again."""

_IDENTITY = np.array([[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]])

_DELAY_SMOOTHING = 0.3
"""The fraction by which the delay of Approximate approaches the last delay at each update, as in rviz_common."""


@dataclass(frozen=True, slots=True)
class FrameView:
    """The frames, their parents, and the set of frames with a known pose in the Fixed Frame.

    Attributes:
        fixed_frame: the Fixed Frame, which may be missing in tf.
        names: the frames in tf.
        parents: the index of each frame's parent in `names`, -1 for a root.
        placed: the frames with a transform to the Fixed Frame; the Fixed Frame is always included, as in RViz.
    """

    fixed_frame: str = ""
    names: tuple[str, ...] = ()
    parents: tuple[int, ...] = ()
    placed: frozenset[str] = field(default_factory=frozenset)

    def find_problem(self, frame: str) -> Phrase | None:
        """Return RViz's error text for a frame without a known pose, or None."""
        if frame in self.placed:
            return None
        return phrase("No transform from [{frame}] to [{fixed_frame}]", frame=frame, fixed_frame=self.fixed_frame)


def make_transform_status(frames: FrameView, frame: str) -> StatusRow:
    """Return the status row ``Transform`` of a display, with RViz's text.

    The frame may be ``<Fixed Frame>``.
    """
    if frame == FIXED_FRAME or frame in frames.placed:
        return StatusRow("Transform", "ok", phrase("Transform OK"))
    return StatusRow(
        "Transform",
        "error",
        phrase("Could not transform from [{frame}] to [{fixed_frame}]", frame=frame, fixed_frame=frames.fixed_frame),
    )


class TimeControl:
    """The state of RViz's Time panel: Pause, Synchronization and its Source.

    While time is paused, displays process no messages and frames do not move. Exact shows the frames at the time of the
    source's last message. Approximate uses the current time minus the source's delay.

    Args:
        clock: the viewer's clock.
        on_change: called when one of the attributes has changed.
        on_signal: called when the source has received a message, so that frames must be updated.

    Attributes:
        paused: whether time is paused.
        mode: Off, Exact or Approximate.
        source: the name of the source display.
        sources: the names of the displays that can be the source, in the order of their first messages.
    """

    def __init__(
        self, clock: Clock, on_change: Callable[[], None] = lambda: None, on_signal: Callable[[], None] = lambda: None
    ) -> None:
        self.paused = False
        self.mode: SyncMode = "Off"
        self.source = ""
        self.sources: list[str] = []
        self._clock = clock
        self._on_change = on_change
        self._on_signal = on_signal
        self._exact_ns = 0
        self._delay_ns = self._current_delay_ns = 0
        self._paused_ns = 0

    def set(self, *, paused: bool, mode: SyncMode, source: str) -> None:
        """Pause or resume time, and set the synchronization mode and source."""
        if paused and not self.paused:
            self._paused_ns = self.now_ns()
        if (mode, source) != (self.mode, self.source):
            self._exact_ns = self._delay_ns = self._current_delay_ns = 0
        self.paused, self.mode, self.source = paused, mode, source
        self._on_change()

    def record_stamp(self, display: str, stamp_ns: int) -> None:
        """Record the stamp, in nanoseconds, of a message that a display has received."""
        if display not in self.sources:
            self.sources.append(display)
            self._on_change()
        if display != self.source or self.mode == "Off" or self.paused:
            return
        self._exact_ns = stamp_ns
        self._delay_ns = max(0, self._clock.now_ns() - stamp_ns) if stamp_ns else 0
        self._on_signal()

    def lookup_ns(self) -> int | None:
        """Return the time at which frames are shown, in ns since the epoch, or None for the latest."""
        if self.paused and self.mode != "Off":
            return self._paused_ns
        if self.mode == "Exact":
            return self._exact_ns or None
        if self.mode == "Approximate" and self.source in self.sources:
            self._current_delay_ns += int(_DELAY_SMOOTHING * (self._delay_ns - self._current_delay_ns))
            return self._clock.now_ns() - self._current_delay_ns
        return None

    def now_ns(self) -> int:
        """Return the ROS time that the Time panel shows, in ns since the epoch."""
        if self.paused:
            return self._paused_ns
        if self.mode == "Exact" and self._exact_ns:
            return self._exact_ns
        return self._clock.now_ns() - (self._current_delay_ns if self.mode == "Approximate" else 0)

    def reset(self) -> None:
        """Discard the recorded stamps, because time was reset."""
        self.sources.clear()
        self._exact_ns = self._delay_ns = self._current_delay_ns = 0
        self._paused_ns = self._clock.now_ns()
        self._on_change()


class FramePages(Protocol):
    """The pages that receive frames."""

    def __len__(self) -> int:
        """Return the number of pages.

        Without pages, frames are not updated regularly.
        """

    def publish(self, message: FrameTable, /) -> None:
        """Send a new frame table, before the transforms that refer to it."""

    def send_transforms(self, frame: bytes, /) -> None:
        """Send a binary frame with transforms."""


class FrameStream:
    """Sends changed frame poses to the pages, and keeps the viewer's tf buffer.

    A frame that is not in tf can be the Fixed Frame if a display places it (`FrameHistory.set_placed_frame`).

    A robot with a single link has no transforms, so its frame is not in tf. If this frame is the Fixed Frame, it is
    sent with the identity as its pose, because RViz draws it too.

    Args:
        node: the node that subscribes.
        pages: the pages that receive the transforms.
        time: whether time is paused, and the time at which frames are shown.
        history: the history of transforms, for poses at earlier times.
        on_frames: called with a new `FrameView` when the frames, or the set of frames with a known pose, have changed.
        own_frames: returns the frames of the links of robots, including frames that are not in tf.

    Attributes:
        fixed_frame: the Fixed Frame.
        rate: the maximum update rate, Hz.
        fade_time: the shortest Frame Timeout of the displays, seconds; None if no display shows the ages of frames.
    """

    def __init__(
        self,
        node: Node,
        pages: FramePages,
        time: TimeControl,
        history: FrameHistory,
        *,
        on_frames: Callable[[FrameView], None],
        own_frames: Callable[[], frozenset[str]],
    ) -> None:
        self.fixed_frame = ""
        self.rate = 30.0
        self._node = node
        self._pages = pages
        self._time = time
        self._history = history
        self._on_frames = on_frames
        self.fade_time: float | None = None
        self._own_frames = own_frames
        self._clock = node.get_clock()
        self._buffer = TransformBuffer(node.get_logger().warning)
        self._loop = asyncio.get_running_loop()
        self._read_condition = node.create_guard_condition(self._read_if_scheduled)
        self._is_update_scheduled = False
        self._read_timer: asyncio.TimerHandle | None = None
        self._age_timer: asyncio.Handle | None = None
        self._due_time = self._last_read_time = float("-inf")
        self._stamp_ns = 0
        self._structure: tuple[Any, ...] = ()
        self._table = FrameTable(0, [], [])
        self._poses: NDArray[np.float32] = np.empty((0, 7), dtype=np.float32)
        self._ages: NDArray[np.float64] = np.empty(0)
        self._last_placed = b""
        self._frame = b""
        self._release: Callable[[], None] | None = None
        self._paused_messages: dict[Hashable, tuple[TFMessage, bool]] = {}
        self._paused_ns: int | None = None

    def start(self) -> None:
        """Subscribe to ``/tf`` and ``/tf_static``, and start sending frame poses to pages."""
        for topic, static, qos in (("/tf", False, TF_QOS), ("/tf_static", True, STATIC_TF_SUBSCRIPTION_QOS)):
            self._node.create_subscription(
                TFMessage, topic, partial(self._add_transforms, static=static), qos
            ).deliver_in_batches()
        self._history.on_placed_frame.append(self._schedule_read)
        self._check_ages()

    def close(self) -> None:
        """Stop sending, and cancel scheduled updates."""
        if self._schedule_read in self._history.on_placed_frame:
            self._history.on_placed_frame.remove(self._schedule_read)
        for handle in (self._read_timer, self._age_timer):
            if handle is not None:
                handle.cancel()
        self._read_timer = self._age_timer = None
        self._read_condition.destroy()
        if self._release is not None:
            self._release()
            self._release = None

    def on_time_changed(self) -> None:
        """Update the frames after time was paused or resumed, or its synchronization was changed."""
        if self._time.paused:
            self._paused_ns = self._paused_ns or self._clock.now_ns()
        else:
            self._paused_ns = None
            paused_messages = list(self._paused_messages.values())
            self._paused_messages.clear()
            for message, static in paused_messages:
                self._add_transforms(message, static=static)
        self.refresh()

    def clear(self) -> None:
        """Discard all transforms except static ones, because time was reset."""
        self._paused_messages.clear()
        self._buffer.clear()
        self.refresh()

    def schedule_update(self) -> None:
        """Schedule an update as soon as the rate allows."""
        self._schedule_read()

    def on_robot_changed(self, removed_frames: set[str]) -> None:
        """Remove the frames that only the previous robot had, and schedule an update."""
        known_frames = removed_frames.intersection(self._buffer.frames())
        if known_frames:
            self._buffer.remove(known_frames)
        self._schedule_read()

    def refresh(self) -> None:
        """Update now, even if there are no pages.

        This is necessary when the Fixed Frame or the robot has changed, or when a page opens.
        """
        if self._read_timer is not None:
            self._read_timer.cancel()
        self._update()

    @property
    def current_frames(self) -> tuple[FrameTable, bytes]:
        """The frame table and the last binary frame, for a page that opens.

        Both are empty at first.
        """
        return self._table, self._frame

    def _add_transforms(self, message: TFMessage, *, static: bool) -> None:
        batch = message.batch
        if self._time.paused:
            key = (batch.parents, batch.children, static)
            self._paused_messages.pop(key, None)
            self._paused_messages[key] = (message, static)
            return
        self._buffer.update(TFMessage(batch=batch), static=static, now_ns=self._clock.now_ns())
        self._stamp_ns = max(self._stamp_ns, batch.stamp_ns)
        self._schedule_read()

    def _schedule_read(self) -> None:
        if self._is_update_scheduled or not len(self._pages):
            return
        self._is_update_scheduled = True
        max_earliness = _MAX_EARLINESS / self.rate
        due_time = max(self._due_time - max_earliness, self._last_read_time + _MIN_READ_INTERVAL_S)
        if due_time <= self._loop.time():
            self._read_condition.trigger()
        else:
            self._read_timer = self._loop.call_at(due_time, self._update)

    def _check_ages(self) -> None:
        self._age_timer = self._loop.call_later(_AGE_PERIOD_S, self._check_ages)
        is_quiet = self._loop.time() - self._last_read_time > _AGE_PERIOD_S / 2
        if is_quiet and self.fade_time is not None and self._ages.any():
            self._schedule_read()

    def _read_if_scheduled(self) -> None:
        if self._is_update_scheduled:
            self._update()

    def _update(self) -> None:
        self._is_update_scheduled, self._read_timer = False, None
        self._last_read_time = self._loop.time()
        fixed_frame = self.fixed_frame
        snapshot = self._take_snapshot(fixed_frame, self._paused_ns or self._clock.now_ns())
        poses, ages = self._compute_shown_poses(snapshot, fixed_frame), snapshot.ages
        is_unconnected = fixed_frame not in snapshot.names and self._is_unconnected(fixed_frame)
        if is_unconnected:
            poses, ages = np.concatenate([poses, _IDENTITY]), np.append(ages, 0.0)
        has_new_structure = self._compare_structure(snapshot, fixed_frame if is_unconnected else None)
        rows = poses.astype(np.float32)
        if has_new_structure or self._has_changed(rows, ages):
            self._send(rows, ages)
        self._notify_displays(snapshot, rows, fixed_frame, has_new_structure=has_new_structure)

    def _take_snapshot(self, fixed_frame: str, now_ns: int) -> FrameSnapshot:
        """Return the poses of all frames in the Fixed Frame.

        A display may have placed the Fixed Frame.
        """
        # The buffer is asked first, because the history may not have received the latest transforms yet.
        placed_frame = None if self._buffer.has_frame(fixed_frame) else self._history.placed_frame(fixed_frame)
        if placed_frame is None or placed_frame.parent is None:
            return self._buffer.snapshot(fixed_frame, now_ns)
        snapshot = self._buffer.snapshot(placed_frame.parent, now_ns)
        return replace(snapshot, poses=compose(placed_frame.pose, snapshot.poses))

    def _is_unconnected(self, frame: str) -> bool:
        """Return whether a frame belongs to a robot, or to a display without a connection to tf."""
        placed_frame = self._history.placed_frame(frame)
        return frame in self._own_frames() or (placed_frame is not None and placed_frame.parent is None)

    def _compute_shown_poses(self, snapshot: FrameSnapshot, fixed_frame: str) -> NDArray[np.float64]:
        """Return the poses of frames at the time to be shown.

        If the pose of a frame at that time is unknown, its latest pose is used.
        """
        stamp_ns = self._time.lookup_ns()
        self._update_subscription(needed=stamp_ns is not None)
        if stamp_ns is None:
            return snapshot.poses
        poses: NDArray[np.float64] = snapshot.poses.copy()
        for row, name in enumerate(snapshot.names):
            with suppress(TransformException):
                poses[row] = self._history.pose(fixed_frame, name, stamp_ns)
        return poses

    def _update_subscription(self, *, needed: bool) -> None:
        """Subscribe to the history of transforms while it is needed to show an earlier time."""
        if needed and self._release is None:
            self._release = self._history.add_listener(lambda: None)
        elif not needed and self._release is not None:
            self._release()
            self._release = None

    def _compare_structure(self, snapshot: FrameSnapshot, unconnected_frame: str | None) -> bool:
        structure = (snapshot.revision, unconnected_frame)
        if structure == self._structure:
            return False
        self._structure = structure
        names, parents = list(snapshot.names), list(snapshot.parents)
        if unconnected_frame is not None:
            names.append(unconnected_frame)
            parents.append(-1)
        self._table = FrameTable(self._table.revision + 1, names, parents)
        self._pages.publish(self._table)
        return True

    def _has_changed(self, poses: NDArray[np.float32], ages: NDArray[np.float64]) -> bool:
        if poses.tobytes() != self._poses.tobytes():
            return True
        fade_time = self.fade_time
        if fade_time is None:
            return False
        if ((ages < fade_time) != (self._ages < fade_time)).any():
            return True
        visible_age_changes = np.clip(ages, fade_time / 3, fade_time) - np.clip(self._ages, fade_time / 3, fade_time)
        return bool(np.abs(visible_age_changes).max(initial=0.0) > _FADE_STEP * fade_time)

    def _send(self, poses: NDArray[np.float32], ages: NDArray[np.float64]) -> None:
        self._poses, self._ages = poses, ages
        self._due_time = self._compute_due_time()
        self._frame = pack_transforms(self._table.revision, self._stamp_ns / 1e9, poses, ages)
        self._pages.send_transforms(self._frame)

    def _compute_due_time(self) -> float:
        """Return the earliest time of the next update, on the event loop's clock.

        A slightly late update does not delay the next update, so that transforms that arrive exactly at this rate do
        not wait longer and longer.
        """
        period = _PERIOD_FACTOR / self.rate
        is_on_time = self._last_read_time - self._due_time < period / 2
        return (self._due_time if is_on_time else self._last_read_time) + period

    def _notify_displays(
        self, snapshot: FrameSnapshot, poses: NDArray[np.float32], fixed_frame: str, *, has_new_structure: bool
    ) -> None:
        has_pose = ~np.isnan(poses[:, 0])
        placement = has_pose.tobytes() + fixed_frame.encode()
        if not has_new_structure and placement == self._last_placed:
            return
        self._last_placed = placement
        names = self._table.names
        self._on_frames(
            FrameView(
                fixed_frame=fixed_frame,
                names=snapshot.names,
                parents=snapshot.parents,
                placed=frozenset(names[row] for row in np.flatnonzero(has_pose)) | {fixed_frame},
            )
        )
