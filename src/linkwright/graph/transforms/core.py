"""The tf buffer with history, for lookups at any time in the last seconds.

The methods are those of ``tf2_py.BufferCore``. Behavior and messages follow tf2. Displays, which need the current
poses of all frames, use `TransformBuffer` instead.
"""

from __future__ import annotations

import threading
import time as system_time
from math import isnan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.single import IDENTITY, Transform, Vector3, compose
from linkwright.graph.log.console import print_to_console
from linkwright.graph.log.logger import Logger
from linkwright.graph.time.values import Duration, Time
from linkwright.graph.transforms.cache import FrameCache, MovingCache, Sample, StaticCache, format_time
from linkwright.graph.transforms.errors import (
    ConnectivityException,
    ExtrapolationException,
    LookupException,
    find_frame_name_problem,
    frame_name_error,
    unknown_frame_error,
)
from linkwright.graph.transforms.report import FrameFacts, frames_as_dot, frames_as_text, frames_as_yaml
from linkwright.graph.transforms.velocity import compute_velocity
from linkwright.graph.transforms.walk import Walker
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

DEFAULT_CACHE_TIME = Duration(seconds=10)
_QUATERNION_TOLERANCE = 10e-3
"""The maximum deviation of a quaternion's squared length from 1."""
_OLD_DATA_PERIOD_S = 2.0
"""The minimum time between two warnings about old data, in seconds.

Two publishers whose clocks differ would otherwise cause a warning for every message.
"""
_MAX_RESOLVED_FRAME_LISTS = 64
"""The maximum number of lists of frames that are kept resolved. Publishers usually send the same lists."""

_Entries = list[tuple["FrameCache | None", int]]
"""For each transform of a message, the cache of the child frame and the number of the parent frame."""

_NOT_DEFINED_REASON = "Source or target frame is not yet defined"


class BufferCore:
    """A buffer that stores transforms for a limited time.

    Any thread may use the buffer. Times are ``Time`` objects or messages of builtin_interfaces; zero requests the
    latest transform.

    Args:
        cache_time: how long transforms are stored, counted back from the latest one of each frame.
        logger: reports refused transforms; a logger named ``tf2`` by default.
    """

    def __init__(self, cache_time: Any = None, *, logger: Logger | None = None) -> None:
        self._span_ns: int = (DEFAULT_CACHE_TIME if cache_time is None else cache_time).nanoseconds
        self._logger = logger or Logger("tf2", print_to_console, system_time.time_ns)
        self._lock = threading.RLock()
        self._numbers: dict[str, int] = {}
        self._names = ["NO_PARENT"]
        self._caches: list[FrameCache | None] = [None]
        self._authorities: dict[int, str] = {}
        self._resolved_frames: dict[tuple[tuple[str, ...], tuple[str, ...], str, bool], _Entries] = {}
        self._walker = Walker(self._caches, self._names, self.all_frames_as_string)

    def set_transform(self, transform: Any, authority: str) -> None:
        """Store a geometry_msgs/msg/TransformStamped.

        A transform that tf2 would refuse is dropped, and the reason is logged.

        Args:
            transform: the message.
            authority: the name of the sender, for reports.
        """
        self._set_message(transform, authority, static=False)

    def set_transform_static(self, transform: Any, authority: str) -> None:
        """Store a static transform. See `set_transform`."""
        self._set_message(transform, authority, static=True)

    def update(self, message: Any, *, static: bool, now_ns: int = 0, authority: str = "default_authority") -> None:
        """Store the transforms of a tf2_msgs/msg/TFMessage.

        Args:
            message: the transforms.
            static: whether the message was received on ``/tf_static``.
            now_ns: not used here; `TransformBuffer` needs the current time.
            authority: the name of the sender, for reports.
        """
        columns = message.columns()
        if columns is None:
            for transform in message.transforms:
                self._set_message(transform, authority, static=static)
            return
        parents, children, stamps, poses = columns
        if not _are_usable(poses):
            for parent, child, stamp_ns, pose in zip(parents, children, stamps, poses.tolist(), strict=True):
                self._store(parent, child, stamp_ns, tuple(pose), authority, static=static)
            return
        with self._lock:
            entries = self._resolve_frames(parents, children, authority, static)
            for row, ((cache, parent_number), stamp_ns) in enumerate(zip(entries, stamps, strict=True)):
                if cache is None or not cache.add(stamp_ns, Sample(parent_number, poses, row)):
                    pose = tuple(poses[row].tolist())
                    self._store(parents[row], children[row], stamp_ns, pose, authority, static=static)

    def lookup_transform_core(self, target_frame: str, source_frame: str, time: Any) -> Any:
        """Return the pose of the source frame in the target frame, as a TransformStamped message.

        The pose transforms points from the source frame to the target frame.

        Args:
            target_frame: the frame to transform to.
            source_frame: the frame to transform from.
            time: the time; zero for the latest time for which all frames between the two have transforms.

        Raises:
            LookupException: a frame is not known.
            ConnectivityException: no transforms connect the two frames.
            ExtrapolationException: there are no transforms for that time.
            InvalidArgumentException: a name is empty or starts with a slash.
        """
        pose, time_ns = self.lookup(target_frame, source_frame, to_nanoseconds(time))
        return _to_message(target_frame, source_frame, time_ns, pose)

    def lookup_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Any:
        """Return the pose of the source frame at one time in the target frame at another time.

        The result is a TransformStamped message. The fixed frame is assumed not to move between the two times.

        Raises:
            TransformException: as for `lookup_transform_core`.
        """
        with self._lock:
            for argument, frame in (("target", target_frame), ("source", source_frame), ("fixed", fixed_frame)):
                self._find_frame_number(f"lookupTransform argument {argument}_frame", frame)
            source_in_fixed, _ = self.lookup(fixed_frame, source_frame, to_nanoseconds(source_time))
            fixed_in_target, time_ns = self.lookup(target_frame, fixed_frame, to_nanoseconds(target_time))
        return _to_message(target_frame, source_frame, time_ns, compose(fixed_in_target, source_in_fixed))

    def lookup(self, target: str, source: str, time_ns: int) -> tuple[Transform, int]:
        """Return the pose of the source frame in the target frame, and its time in nanoseconds.

        Raises:
            TransformException: as for `lookup_transform_core`.
        """
        with self._lock:
            if target == source:
                cache = self._caches[self._numbers.get(target, 0)]
                latest = None if cache is None or time_ns else cache.latest()
                return IDENTITY, latest[0] if latest else time_ns
            target_number = self._find_frame_number("lookupTransform argument target_frame", target)
            source_number = self._find_frame_number("lookupTransform argument source_frame", source)
            path = self._walker.find_path(target_number, source_number, time_ns)
            return path.pose(), path.time_ns

    def can_transform_core(self, target_frame: str, source_frame: str, time: Any) -> tuple[bool, str]:
        """Return whether a lookup would succeed, and the reason if not, with tf2's wording."""
        if target_frame == source_frame:
            return True, ""
        with self._lock:
            for argument, frame in (("target", target_frame), ("source", source_frame)):
                reason = self._find_frame_id_problem(f"canTransform argument {argument}_frame", frame)
                if reason:
                    return False, reason
            return self._can_transform(target_frame, source_frame, to_nanoseconds(time))

    def can_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> tuple[bool, str]:
        """Return whether a lookup with a fixed frame would succeed, and the reason if not."""
        frames = (("target", target_frame), ("source", source_frame), ("fixed", fixed_frame))
        with self._lock:
            for argument, frame in frames:
                reason = self._find_frame_id_problem(f"canTransform argument {argument}_frame", frame)
                if reason:
                    return False, reason
            result = self._can_transform(target_frame, fixed_frame, to_nanoseconds(target_time))
            return self._can_transform(fixed_frame, source_frame, to_nanoseconds(source_time)) if result[0] else result

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """Return the latest time with transforms for all moving frames between two frames.

        The result is zero if all frames between them are static.

        Raises:
            LookupException: a frame is not known.
            ConnectivityException: no transforms connect the two frames.
        """
        with self._lock:
            target = self._find_frame_number("getLatestCommonTime argument target_frame", target_frame)
            source = self._find_frame_number("getLatestCommonTime argument source_frame", source_frame)
            if target == source:
                cache = self._caches[target]
                latest = None if cache is None else cache.latest()
                time_ns = latest[0] if latest else 0
            else:
                time_ns = self._walker.find_latest_common_time(target, source)
        return Time(nanoseconds=time_ns)

    def lookup_velocity(
        self,
        tracking_frame: str,
        observation_frame: str,
        reference_frame: str,
        reference_point: Vector3,
        reference_point_frame: str,
        time: Any,
        averaging_interval: Any,
    ) -> tuple[Vector3, Vector3]:
        """Return the linear and angular velocity of a frame. See `compute_velocity`.

        Raises:
            TransformException: as for `lookup_transform_core`.
        """
        with self._lock:
            latest_ns = self.get_latest_common_time(observation_frame, tracking_frame).nanoseconds
            return compute_velocity(
                self,
                tracking_frame,
                observation_frame,
                (reference_frame, reference_point, reference_point_frame),
                (to_nanoseconds(time), latest_ns, to_nanoseconds(averaging_interval)),
            )

    def clear(self) -> None:
        """Remove all transforms except the static ones."""
        with self._lock:
            for cache in self._caches:
                if cache is not None:
                    cache.clear()

    def all_frames_as_yaml(self, time: Any = None) -> str:
        """Return all frames with their parents, rates and times, as YAML.

        If `time` is given, the text includes the delay of each frame at that time.
        """
        with self._lock:
            return frames_as_yaml(self._collect_frame_facts(), to_nanoseconds(time) if time is not None else 0)

    def all_frames_as_string(self) -> str:
        """Return all frames with their parents, one per line."""
        with self._lock:
            return frames_as_text(self._collect_frame_facts(with_empty=True))

    def frame_names(self) -> list[str]:
        """Return the names of all frames, in the order in which they were first seen."""
        with self._lock:
            return self._names[1:]

    def chain(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> list[str]:
        """Return the names of the frames from the source through the fixed frame to the target.

        Raises:
            TransformException: as for `lookup_transform_core`.
        """
        with self._lock:
            names = [
                *self._find_chain_names(fixed_frame, source_frame, to_nanoseconds(source_time)),
                *self._find_chain_names(target_frame, fixed_frame, to_nanoseconds(target_time)),
            ]
        chain_names: list[str] = []
        for name in names:
            if not chain_names or chain_names[-1] != name:
                chain_names.append(name)
        return chain_names

    def all_frames_as_dot(self, time: Any = None) -> str:
        """Return all frames as a Graphviz graph.

        If `time` is given, the graph includes ages.
        """
        with self._lock:
            return frames_as_dot(self._collect_frame_facts(), to_nanoseconds(time) if time is not None else 0)

    # tf2_py's names of these methods
    _chain = chain
    _getFrameStrings = frame_names  # noqa: N815
    _frameYAML = all_frames_as_yaml  # noqa: N815
    _allFramesAsDot = all_frames_as_dot  # noqa: N815

    lookupVelocityFullCore = lookup_velocity  # noqa: N815

    def lookupVelocityCore(  # noqa: N802
        self, tracking_frame: str, observation_frame: str, time: Any, averaging_interval: Any
    ) -> tuple[Vector3, Vector3]:
        """Return the velocity of the origin of a frame, expressed in the frame that observes it.

        See `lookup_velocity`.
        """
        reference = (observation_frame, (0.0, 0.0, 0.0), tracking_frame)
        return self.lookup_velocity(tracking_frame, observation_frame, *reference, time, averaging_interval)

    def _frameExists(self, frame_id: str) -> bool:  # noqa: N802
        return frame_id in self._numbers

    def _set_message(self, message: Any, authority: str, *, static: bool) -> None:
        header, transform = message.header, message.transform
        translation, rotation = transform.translation, transform.rotation
        pose = (
            translation.x, translation.y, translation.z, rotation.x, rotation.y, rotation.z, rotation.w,
        )  # fmt: skip
        self._store(
            header.frame_id, message.child_frame_id, to_nanoseconds(header.stamp), pose, authority, static=static
        )

    def _store(self, parent: str, child: str, stamp_ns: int, pose: Transform, authority: str, *, static: bool) -> None:
        parent, child = parent.removeprefix("/"), child.removeprefix("/")
        problem = _find_transform_problem(parent, child, pose, authority)
        if problem is not None:
            self._logger.error(problem)
            return
        with self._lock:
            number = self._add_frame(child)
            cache = self._get_cache(number, static)
            if cache.add(stamp_ns, Sample(self._add_frame(parent), pose)):
                self._authorities[number] = authority
                return
        self._logger.warning(
            f"TF_OLD_DATA ignoring data from the past for frame {child} at time {format_time(stamp_ns)} according to "
            f"authority {authority}\nPossible reasons are listed at http://wiki.ros.org/tf/Errors%20explained",
            throttle_duration_sec=_OLD_DATA_PERIOD_S,
        )

    def _resolve_frames(
        self, parents: tuple[str, ...], children: tuple[str, ...], authority: str, static: bool
    ) -> _Entries:
        """Return, for each transform, the cache of the child frame and the number of its parent.

        The result is computed once for all messages with these frames. The cache is None for a transform that is
        refused, which must be logged.
        """
        key = (parents, children, authority, static)
        known_entries = self._resolved_frames.get(key)
        if known_entries is not None:
            return known_entries
        entries: _Entries = []
        for parent, child in zip(parents, children, strict=True):
            parent, child = parent.removeprefix("/"), child.removeprefix("/")
            if not parent or not child or parent == child:
                entries.append((None, 0))
                continue
            number = self._add_frame(child)
            entries.append((self._get_cache(number, static), self._add_frame(parent)))
            self._authorities[number] = authority
        if len(self._resolved_frames) >= _MAX_RESOLVED_FRAME_LISTS:
            self._resolved_frames.clear()
        self._resolved_frames[key] = entries
        return entries

    def _get_cache(self, frame_number: int, static: bool) -> FrameCache:
        """Return the cache of a frame.

        A frame that changes between static and moving gets a new cache.
        """
        cache = self._caches[frame_number]
        if cache is None or isinstance(cache, StaticCache) is not static:
            cache = self._caches[frame_number] = StaticCache() if static else MovingCache(self._span_ns)
            self._resolved_frames.clear()
        return cache

    def _add_frame(self, frame: str) -> int:
        number = self._numbers.get(frame)
        if number is None:
            number = self._numbers[frame] = len(self._names)
            self._names.append(frame)
            self._caches.append(None)
        return number

    def _find_frame_number(self, argument: str, frame: str) -> int:
        error = frame_name_error(argument, frame)
        if error is not None:
            raise error
        number = self._numbers.get(frame)
        if number is None:
            raise unknown_frame_error(argument, frame, self._numbers)
        return number

    def _find_frame_id_problem(self, argument: str, frame: str) -> str | None:
        reason: str | None = find_frame_name_problem(frame)
        if reason is None and frame not in self._numbers:
            reason = "frame does not exist"
        return None if reason is None else f'Invalid frame ID "{frame}" passed to {argument} - {reason}'

    def _can_transform(self, target: str, source: str, time_ns: int) -> tuple[bool, str]:
        target_number, source_number = self._numbers.get(target, 0), self._numbers.get(source, 0)
        if not target_number or not source_number:
            return False, _NOT_DEFINED_REASON
        if target_number == source_number:
            return True, ""
        try:
            self._walker.find_path(target_number, source_number, time_ns, poses=False)
        except (ConnectivityException, ExtrapolationException, LookupException) as error:
            return False, str(error)
        return True, ""

    def _find_chain_names(self, target: str, source: str, time_ns: int) -> list[str]:
        target_number = self._find_frame_number("_chainAsVector argument target_frame", target)
        source_number = self._find_frame_number("_chainAsVector argument source_frame", source)
        if target_number == source_number:
            return [target]
        path = self._walker.find_path(target_number, source_number, time_ns, poses=False)
        return [self._names[number] for number in path.chain()]

    def _collect_frame_facts(self, *, with_empty: bool = False) -> list[FrameFacts]:
        frames = []
        for index, cache in enumerate(self._caches):
            if cache is None:
                continue
            latest = cache.latest()
            if latest is None and not with_empty:
                continue
            stamp_ns, parent = latest or (0, 0)
            frames.append(
                FrameFacts(
                    self._names[index],
                    self._names[parent],
                    self._authorities.get(index, "no recorded authority"),
                    len(cache),
                    stamp_ns,
                    cache.oldest_ns(),
                )
            )
        return frames


def _are_usable(poses: NDArray[np.float64]) -> bool:
    """Return whether tf2 accepts all of these poses: no NaN, and quaternions of unit length."""
    rotations = poses[:, 3:]
    squared_lengths = np.einsum("ni,ni->n", rotations, rotations)
    return bool((np.abs(squared_lengths - 1.0) < _QUATERNION_TOLERANCE).all() and not np.isnan(poses[:, :3]).any())


def to_nanoseconds(time: Any) -> int:
    """Return the nanoseconds of a ``Time``, a ``Duration`` or a builtin_interfaces message.

    Raises:
        TypeError: `time` is none of these; the error message is tf2's.
    """
    if hasattr(time, "nanosec"):
        return int(time.sec) * NANOSECONDS_PER_SECOND + int(time.nanosec)
    if not hasattr(time, "nanoseconds"):
        raise TypeError(f"time must have sec and nanosec, or nanoseconds. It is {time!r}")
    return int(time.nanoseconds)


def _find_transform_problem(parent: str, child: str, pose: Transform, authority: str) -> str | None:
    """Return the reason for refusing a transform, with tf2's wording, or None."""
    x, y, z, w = pose[3:]
    # The comparison is false for NaN and infinite numbers, too, so this single test covers the usual case.
    is_unit = abs(x * x + y * y + z * z + w * w - 1.0) < _QUATERNION_TOLERANCE
    if is_unit and parent and child and parent != child and not any(map(isnan, pose[:3])):
        return None
    if child == parent:
        return (
            f'TF_SELF_TRANSFORM: Ignoring transform from authority "{authority}" with frame_id and  '
            f'child_frame_id "{child}" because they are the same'
        )
    if not child:
        return f'TF_NO_CHILD_FRAME_ID: Ignoring transform from authority "{authority}" because child_frame_id not set '
    if not parent:
        return (
            f'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "{child}"  from authority "{authority}" '
            "because frame_id not set"
        )
    position = " ".join(f"{value:f}" for value in pose[:3])
    rotation = " ".join(f"{value:f}" for value in pose[3:])
    if any(map(isnan, pose)):
        return (
            f'TF_NAN_INPUT: Ignoring transform for child_frame_id "{child}" from authority "{authority}" because of a '
            f"nan value in the transform ({position}) ({rotation})"
        )
    return (
        f'TF_DENORMALIZED_QUATERNION: Ignoring transform for child_frame_id "{child}" from authority "{authority}" '
        f"because of an invalid quaternion in the transform ({rotation})"
    )


def _to_message(target: str, source: str, time_ns: int, pose: Transform) -> Any:
    from linkwright.messages import TransformStamped

    message = TransformStamped()
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(time_ns, NANOSECONDS_PER_SECOND)
    message.header.frame_id = target
    message.child_frame_id = source
    translation, rotation = message.transform.translation, message.transform.rotation
    translation.x, translation.y, translation.z, rotation.x, rotation.y, rotation.z, rotation.w = pose
    return message
