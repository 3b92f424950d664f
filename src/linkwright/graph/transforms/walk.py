"""Paths through the tree of frames at a given time, by tf2's rules.

A search climbs from the source to the root, then from the target until it meets the first path.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.geometry.single import IDENTITY, Transform, compose, invert
from linkwright.graph.transforms.cache import FrameCache, NoDataError
from linkwright.graph.transforms.errors import (
    ExtrapolationException,
    LookupException,
    frame_loop_error,
    not_connected_error,
)

MAX_DEPTH = 1000
"""The maximum number of frames in a path. A longer path counts as a loop (tf2 ``MAX_GRAPH_DEPTH``)."""


@dataclass(slots=True)
class FramePath:
    """A path from a source frame to a target frame.

    Attributes:
        time_ns: the time of the path's transforms, in nanoseconds.
        up: the numbers of the frames from the source upwards, without the top frame.
        down: the numbers of the frames from the target upwards, without the top frame.
        top: the number of the top frame, in which both halves meet.
        source_pose: the pose of the source in the top frame.
        target_pose: the pose of the target in the top frame.
    """

    time_ns: int
    top: int = 0
    up: list[int] = field(default_factory=list)
    down: list[int] = field(default_factory=list)
    source_pose: Transform = IDENTITY
    target_pose: Transform = IDENTITY

    def pose(self) -> Transform:
        """Return the pose of the source frame in the target frame."""
        if not self.down:
            return self.source_pose
        inverse = invert(self.target_pose)
        return compose(inverse, self.source_pose) if self.up else inverse

    def chain(self) -> list[int]:
        """Return the numbers of the frames from the source to the target, including both."""
        up, down = list(self.up), list(self.down)
        top = self.top
        # Both halves may have continued beyond the frame in which they meet.
        while up and down and up[-1] == down[-1]:
            top = up.pop()
            down.pop()
        return [*up, top, *reversed(down)]


class Walker:
    """A search for paths between frames in the tree of transforms.

    Args:
        caches: the transforms of each frame, by number; None for frames without a parent. The list may grow.
        names: the names of the frames, by number.
        describe_frames: returns a text that lists all frames, for error messages.
    """

    def __init__(self, caches: list[FrameCache | None], names: list[str], describe_frames: Callable[[], str]) -> None:
        self._caches = caches
        self._names = names
        self._describe_frames = describe_frames

    def find_path(self, target: int, source: int, time_ns: int, *, poses: bool = True) -> FramePath:
        """Find the path from a source frame to a target frame.

        Args:
            target: the number of the target frame.
            source: the number of the source frame, which must differ from the target.
            time_ns: the time in nanoseconds, or 0 for the latest time for which all frames on the path have transforms.
            poses: whether to compute the poses.

        Raises:
            ConnectivityException: there is no path.
            ExtrapolationException: there is no path at that time.
            LookupException: the frames' parents form a loop.
        """
        if time_ns == 0:
            time_ns = self.find_latest_common_time(target, source)
        path = FramePath(time_ns)
        reason = self._climb_from_source(path, source, target, poses)
        if path.top == target:
            return path
        self._climb_from_target(path, source, target, poses, reason)
        return path

    def find_latest_common_time(self, target: int, source: int) -> int:
        """Return the latest time with transforms for all moving frames between two frames.

        The time is in nanoseconds, and 0 if all frames between the two are static.

        Raises:
            ConnectivityException: no path connects the two frames.
            LookupException: the frames' parents form a loop.
        """
        ancestors: list[tuple[int, int]] = []
        times: list[int] = []
        frame = source
        for latest in self._walk_latest_upwards(source):
            ancestors.append(latest)
            times.append(latest[0])
            frame = latest[1]
            if frame == target:
                return _find_earliest(times)
        parents = {parent: index for index, (_, parent) in reversed(list(enumerate(ancestors)))}
        times = []
        for stamp, parent in self._walk_latest_upwards(target):
            times.append(stamp)
            if parent in parents:
                return _find_earliest(times + [stamp for stamp, _ in ancestors[: parents[parent] + 1]])
            if parent == source:
                return _find_earliest(times)
        raise not_connected_error(self._names[target], self._names[source])

    def _walk_latest_upwards(self, frame: int) -> Any:
        for _ in range(MAX_DEPTH + 1):
            cache = self._caches[frame]
            latest = None if cache is None else cache.latest()
            if latest is None:
                return
            yield latest
            frame = latest[1]
        raise self._make_loop_error()

    def _climb_from_source(self, path: FramePath, source: int, target: int, poses: bool) -> str | None:
        """Climb from the source to the target or the root, and store this half in `path`.

        Returns the reason if missing data ended the climb early, otherwise None.
        """
        frame, pose = source, IDENTITY
        reason = None
        for depth in range(MAX_DEPTH + 2):
            if frame == target:
                break
            cache = self._caches[frame]
            if cache is None:
                break
            try:
                parent, step = cache.at(path.time_ns) if poses else (cache.parent_at(path.time_ns), IDENTITY)
            except NoDataError as error:
                reason = str(error)
                break
            if depth > MAX_DEPTH:
                raise self._make_loop_error()
            if poses:
                pose = compose(step, pose)
            path.up.append(frame)
            frame = parent
        path.top, path.source_pose = frame, pose
        return reason

    def _climb_from_target(self, path: FramePath, source: int, target: int, poses: bool, reason: str | None) -> None:
        frame, pose = target, IDENTITY
        for depth in range(MAX_DEPTH + 2):
            if frame == path.top:
                break
            if frame == source:
                path.up.clear()
                path.top, path.source_pose = source, IDENTITY
                break
            cache = self._caches[frame]
            if cache is None:
                break
            try:
                parent, step = cache.at(path.time_ns) if poses else (cache.parent_at(path.time_ns), IDENTITY)
            except NoDataError as error:
                raise self._extrapolation_error(str(error), source, target) from None
            if depth > MAX_DEPTH:
                raise self._make_loop_error()
            if poses:
                pose = compose(step, pose)
            path.down.append(frame)
            frame = parent
        path.target_pose = pose
        if frame != path.top:
            if reason is not None:
                raise self._extrapolation_error(reason, source, target)
            raise not_connected_error(self._names[target], self._names[source])

    def _extrapolation_error(self, reason: str, source: int, target: int) -> ExtrapolationException:
        return ExtrapolationException(
            phrase(
                "{problem}, when looking up transform from frame [{source_frame}] to frame [{target_frame}]",
                problem=reason,
                source_frame=self._names[source],
                target_frame=self._names[target],
            )
        )

    def _make_loop_error(self) -> LookupException:
        return frame_loop_error(f"\n{self._describe_frames()}\n")


def _find_earliest(times: list[int]) -> int:
    return min((time for time in times if time), default=0)
