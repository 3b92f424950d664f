"""Ways through the tree of frames at a time, by tf2's rules: from the source up, and from the target up to meet it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.geometry.single import IDENTITY, Transform, compose, invert
from linkwright.graph.transforms.cache import FrameCache, NoDataError
from linkwright.graph.transforms.errors import ExtrapolationException, LookupException, loop, not_connected

MAX_DEPTH = 1000
"""How many frames a way may have before it counts as a loop (tf2 ``MAX_GRAPH_DEPTH``)."""


@dataclass(slots=True)
class Way:
    """A way from a source frame to a target frame.

    Attributes:
        time_ns: the time it holds at.
        up: numbers of the frames from the source upwards, without the last one.
        down: numbers of the frames from the target upwards, without the last one, which is that of `up`.
        top: the last one.
        source_pose: pose of the source in the last frame.
        target_pose: pose of the target in it.
    """

    time_ns: int
    top: int = 0
    up: list[int] = field(default_factory=list)
    down: list[int] = field(default_factory=list)
    source_pose: Transform = IDENTITY
    target_pose: Transform = IDENTITY

    def pose(self) -> Transform:
        """The pose of the source in the target."""
        if not self.down:
            return self.source_pose
        inverse = invert(self.target_pose)
        return compose(inverse, self.source_pose) if self.up else inverse

    def chain(self) -> list[int]:
        """Numbers of the frames from the source to the target, both included."""
        up, down = list(self.up), list(self.down)
        top = self.top
        # Both may have gone up beyond the frame where they meet.
        while up and down and up[-1] == down[-1]:
            top = up.pop()
            down.pop()
        return [*up, top, *reversed(down)]


class Walker:
    """Finds ways among frames.

    Args:
        caches: the transforms of each frame, by number; None for frames without a parent. It may grow.
        names: of the frames, by number.
        shape: gives the text that shows all frames, for messages.
    """

    def __init__(self, caches: list[FrameCache | None], names: list[str], shape: Callable[[], str]) -> None:
        self._caches = caches
        self._names = names
        self._shape = shape

    def way(self, target: int, source: int, time_ns: int, *, poses: bool = True) -> Way:
        """The way from a source to a target.

        Args:
            target: number of the target frame.
            source: number of the source frame, another one.
            time_ns: the time, 0 for the latest that all frames on the way have.
            poses: whether to compute the poses.

        Raises:
            ConnectivityException: there is none.
            ExtrapolationException: there is none at that time.
            LookupException: parents go round in a loop.
        """
        if time_ns == 0:
            time_ns = self.latest_common_time(target, source)
        way = Way(time_ns)
        trouble = self._climb_from_source(way, source, target, poses)
        if way.top == target:
            return way
        self._climb_from_target(way, source, target, poses, trouble)
        return way

    def latest_common_time(self, target: int, source: int) -> int:
        """The latest time that all moving frames between two have; 0 when none of them moves.

        Raises:
            ConnectivityException: no way leads from one to the other.
            LookupException: parents go round in a loop.
        """
        seen: list[tuple[int, int]] = []
        times: list[int] = []
        frame = source
        for latest in self._latest_upwards(source):
            seen.append(latest)
            times.append(latest[0])
            frame = latest[1]
            if frame == target:
                return _earliest(times)
        parents = {parent: place for place, (_, parent) in reversed(list(enumerate(seen)))}
        times = []
        for stamp, parent in self._latest_upwards(target):
            times.append(stamp)
            if parent in parents:
                return _earliest(times + [stamp for stamp, _ in seen[: parents[parent] + 1]])
            if parent == source:
                return _earliest(times)
        raise not_connected(self._names[target], self._names[source])

    def _latest_upwards(self, frame: int) -> Any:
        for _ in range(MAX_DEPTH + 1):
            cache = self._caches[frame]
            latest = None if cache is None else cache.latest()
            if latest is None:
                return
            yield latest
            frame = latest[1]
        raise self._loop()

    def _climb_from_source(self, way: Way, source: int, target: int, poses: bool) -> str | None:
        """Climb until the target or the top; gives the reason for a stop, where that was a lack of data."""
        frame, pose = source, IDENTITY
        trouble = None
        for depth in range(MAX_DEPTH + 2):
            if frame == target:
                break
            cache = self._caches[frame]
            if cache is None:
                break
            try:
                parent, step = cache.at(way.time_ns) if poses else (cache.parent_at(way.time_ns), IDENTITY)
            except NoDataError as error:
                trouble = str(error)
                break
            if depth > MAX_DEPTH:
                raise self._loop()
            if poses:
                pose = compose(step, pose)
            way.up.append(frame)
            frame = parent
        way.top, way.source_pose = frame, pose
        return trouble

    def _climb_from_target(self, way: Way, source: int, target: int, poses: bool, trouble: str | None) -> None:
        frame, pose = target, IDENTITY
        for depth in range(MAX_DEPTH + 2):
            if frame == way.top:
                break
            if frame == source:
                way.up.clear()
                way.top, way.source_pose = source, IDENTITY
                break
            cache = self._caches[frame]
            if cache is None:
                break
            try:
                parent, step = cache.at(way.time_ns) if poses else (cache.parent_at(way.time_ns), IDENTITY)
            except NoDataError as error:
                raise self._extrapolation(str(error), source, target) from None
            if depth > MAX_DEPTH:
                raise self._loop()
            if poses:
                pose = compose(step, pose)
            way.down.append(frame)
            frame = parent
        way.target_pose = pose
        if frame != way.top:
            if trouble is not None:
                raise self._extrapolation(trouble, source, target)
            raise not_connected(self._names[target], self._names[source])

    def _extrapolation(self, trouble: str, source: int, target: int) -> ExtrapolationException:
        return ExtrapolationException(
            phrase(
                "{trouble}, when looking up transform from frame [{names}] to frame [{other_names}]",
                trouble=trouble,
                names=self._names[source],
                other_names=self._names[target],
            )
        )

    def _loop(self) -> LookupException:
        return loop(f"\n{self._shape()}\n")


def _earliest(times: list[int]) -> int:
    return min((time for time in times if time), default=0)
