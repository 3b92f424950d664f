"""The displays Marker and MarkerArray, and a base class for displays drawn as markers."""

from __future__ import annotations

import asyncio
from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from linkwright.diagnostics import foreign, phrase
from linkwright.geometry.single import Transform
from linkwright.graph import TransformException
from linkwright.page.files import MeshIndex
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import FIXED_FRAME, Path, PropertySpec, Schema, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.base.stored_markers import StoredMarkersDisplay
from linkwright.rviz.displays.base.topic_display import TOPIC
from linkwright.rviz.markers import BadMarkerError, MarkerReading, read_marker
from linkwright.rviz.markers.shapes import ADD, DELETE, DELETE_ALL, marker_id, marker_pose

_NAMESPACES = "Namespaces"
_MIN_LIFETIME_NS = 100_000
"""A marker whose lifetime in ns is at most this value never expires, as in RViz."""

_EXPIRY_PERIOD_S = 0.1
"""Seconds between checks for expired markers while any marker has a lifetime."""

_DUPLICATES_ROW = "Duplicate Marker Check"
_MESSAGE_ROW = "Message"


class _Marker:
    """A received marker, and the time of the node's clock in ns at which it expires, or None."""

    def __init__(self, reading: MarkerReading, message: Any, expires_ns: int | None) -> None:
        self.reading = reading
        self.frame: str = message.header.frame_id.removeprefix("/")
        self.stamp_ns: int = message.header.stamp.nanoseconds
        self.locked: bool = message.frame_locked
        self.expires_ns = expires_ns


class MarkerDisplay(StoredMarkersDisplay):
    """A display of the markers of a topic.

    A marker whose frame has no known pose is shown once the pose is known. At most ``Filter size`` markers are queued
    until their poses are known. The oldest are dropped first.
    """

    CLASS = "rviz_default_plugins/Marker"
    MESSAGE = "visualization_msgs/msg/Marker"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(default="visualization_marker", description="visualization_msgs/msg/Marker", filter_size=10),
    )
    FOLLOWS_TRANSFORMS = True

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self._namespaces: list[str] = []
        super().__init__(host, identity, config)
        self._markers: dict[str, _Marker] = {}
        self._unplaced_ids: set[str] = set()
        self._pending_ids: dict[str, None] = {}  # markers that never had a known pose, oldest first
        self._frame_poses: dict[tuple[str, int], Transform] = {}  # a cache, because thousands of markers may share a
        # key
        self._expiry_timer: asyncio.TimerHandle | None = None
        self._clock = host.context.node.get_clock()

    def schema(self) -> Schema:
        """Return the topic property, and a check box for each namespace received so far."""
        check_boxes = tuple(
            PropertySpec(name, "bool", True, "Show the markers of this namespace.") for name in self._namespaces
        )
        return (
            *self.SCHEMA,
            PropertySpec(_NAMESPACES, "bool", True, "Enable or disable all namespaces.", children=check_boxes),
        )

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Apply the action of a marker: add, delete, or delete all."""
        self._apply_marker(message)
        while len(self._pending_ids) > self.max_waiting_messages():
            self._remove(next(iter(self._pending_ids)))
        self._show()

    def on_property_changed(self, path: Path) -> None:
        """Subscribe again if necessary, or enable or disable all namespaces."""
        super().on_property_changed(path)
        if path == (_NAMESPACES,):
            value = self.properties.flag(_NAMESPACES)
            for name in self._namespaces:
                self.properties.set((_NAMESPACES, name), value)
            self.publish_properties()

    def reset(self) -> None:
        """Discard the markers."""
        self._markers.clear()
        self._unplaced_ids.clear()
        self._pending_ids.clear()
        self._store.clear()
        self._meshes = MeshIndex(self.context.finder)
        self._show()

    def stop(self) -> None:
        """Unsubscribe, and end the pages' access to the files of the markers."""
        super().stop()
        if self._expiry_timer is not None:
            self._expiry_timer.cancel()
            self._expiry_timer = None

    def on_frames_changed(self) -> None:
        """Place the markers in the new Fixed Frame."""
        if self._check_fixed_frame_change():
            for identity, marker in self._markers.items():
                self._place_marker(identity, marker)
            self._show()

    def on_transforms_received(self) -> None:
        """Place the markers whose transforms were not available until now."""
        if self._unplaced_ids:
            for identity in list(self._unplaced_ids):
                self._place_marker(identity, self._markers[identity])
            self._show()

    # --- actions -----------------------------------------------------------------------------------------------

    def _apply_marker(self, message: Any) -> None:
        if message.action == ADD:
            self._add(message)
        elif message.action == DELETE:
            self._remove(marker_id(message))
        elif message.action == DELETE_ALL:
            for identity in [
                candidate
                for candidate, marker in self._markers.items()
                if message.ns in ("", marker.reading.shape.namespace)
            ]:
                self._remove(identity)
        else:
            self.set_status_row(
                marker_id(message), "error", phrase("Unknown marker action: {action}", action=message.action)
            )

    def _add(self, message: Any) -> None:
        identity = marker_id(message)
        try:
            reading = read_marker(message, self._meshes)
        except BadMarkerError as error:
            self._remove(identity)
            self.set_status_row(identity, "error", foreign(error))
            return
        if message.ns not in self._namespaces:
            self._namespaces = sorted([*self._namespaces, message.ns])
            self.publish_properties()
        lifetime_ns = message.lifetime.nanoseconds
        expires_ns = self._clock.now_ns() + lifetime_ns if lifetime_ns > _MIN_LIFETIME_NS else None
        self._markers[identity] = marker = _Marker(reading, message, expires_ns)
        if expires_ns is not None:
            self._schedule_expiry()
        self._place_marker(identity, marker)
        self._pending_ids.pop(identity, None)
        if identity in self._unplaced_ids:
            self._pending_ids[identity] = None

    def _remove(self, identity: str) -> None:
        self._markers.pop(identity, None)
        self._unplaced_ids.discard(identity)
        self._pending_ids.pop(identity, None)
        self._store.remove(identity)
        self.delete_status_row(identity)

    def _place_marker(self, identity: str, marker: _Marker) -> None:
        fixed_frame = self.host.frames.fixed_frame
        marker_frame = fixed_frame if marker.frame == FIXED_FRAME else marker.frame
        shape = marker.reading.shape
        try:
            frame = self._find_frame_pose(fixed_frame, marker_frame, 0 if marker.locked else marker.stamp_ns)
        except TransformException as error:
            reason = error.diagnostics[0].message
            text = phrase(
                "For frame [{frame}]: No transform to fixed frame [{fixed_frame}].  TF error: [{reason}]",
                frame=marker_frame,
                fixed_frame=fixed_frame,
                reason=reason,
            )
            self.set_status_row(identity, "error", text)
            self._unplaced_ids.add(identity)
            self._store.remove(identity)
            return
        self._unplaced_ids.discard(identity)
        self._pending_ids.pop(identity, None)
        if marker.reading.warning:
            self.set_status_row(identity, "warn", marker.reading.warning)
        else:
            self.delete_status_row(identity)
        if marker.locked:
            shape.frame, shape.pose = marker_frame, list(marker.reading.pose)
        else:
            shape.frame, shape.pose = "", marker_pose(frame, marker.reading)
        self._store.put(shape)

    def _find_frame_pose(self, fixed_frame: str, frame: str, stamp_ns: int) -> Transform:
        pose = self._frame_poses.get((frame, stamp_ns))
        if pose is None:
            pose = self._frame_poses[frame, stamp_ns] = tuple(
                self.context.transforms.pose(fixed_frame, frame, stamp_ns).tolist()
            )
        return pose

    def _show(self) -> None:
        """Send all pending changes to markers together."""
        self._frame_poses.clear()
        self.show_markers()

    # --- lifetimes ---------------------------------------------------------------------------------------------

    def _schedule_expiry(self) -> None:
        if self._expiry_timer is None:
            self._expiry_timer = asyncio.get_running_loop().call_later(_EXPIRY_PERIOD_S, self._remove_expired)

    def _remove_expired(self) -> None:
        self._expiry_timer = None
        now_ns = self._clock.now_ns()
        expiry_times = {
            marker_id: marker.expires_ns for marker_id, marker in self._markers.items() if marker.expires_ns is not None
        }
        expired = [marker_id for marker_id, expires_ns in expiry_times.items() if expires_ns <= now_ns]
        for identity in expired:
            self._remove(identity)
        if expired:
            self._show()
        if len(expiry_times) > len(expired):
            self._schedule_expiry()


class MarkerArrayDisplay(MarkerDisplay):
    """A display of markers that are received in arrays.

    Any number of markers are queued until their poses are known, whereas RViz drops such markers.
    """

    CLASS = "rviz_default_plugins/MarkerArray"
    MESSAGE = "visualization_msgs/msg/MarkerArray"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(default="visualization_marker_array", description="visualization_msgs/msg/MarkerArray"),
    )

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Apply the actions of the markers in order."""
        self._check_duplicates(message.markers)
        for marker in message.markers:
            self._apply_marker(marker)
        self._show()

    def _check_duplicates(self, markers: Any) -> None:
        seen_keys: set[tuple[str, int]] = set()
        for marker in markers:
            key = (marker.ns, marker.id)
            if key in seen_keys:
                text = phrase(
                    "Multiple Markers in the same MarkerArray message had the same ns and id: ({namespace}, {id})",
                    namespace=marker.ns,
                    id=marker.id,
                )
                self.set_status_row(_DUPLICATES_ROW, "error", text)
                return
            seen_keys.add(key)
        self.delete_status_row(_DUPLICATES_ROW)


class MessageMarkersDisplay(MarkerArrayDisplay, ABC):
    """A base class for displays of other packages that draw messages of any type as markers.

    A subclass sets `CLASS`, `MESSAGE` and `SCHEMA`, with a `topic_spec`, and overrides `markers`.
    """

    DRAWN_AS = MarkerArrayDisplay.CLASS
    SCHEMA: ClassVar[Schema] = (topic_spec(),)

    @abstractmethod
    def markers(self, message: Any) -> Iterable[Any]:
        """Return the markers for a message.

        They replace the markers of the previous message.

        Args:
            message: a message of the type `MESSAGE`; it must not be changed.

        Returns:
            Messages of type visualization_msgs/msg/Marker, each with a unique pair of namespace and ID. A marker
            without a frame is placed in the frame of the message's header, at its time, or in the Fixed Frame if the
            message has no header. ``<Fixed Frame>``, the default of properties of kind ``frame``, is the Fixed Frame.
        """

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Replace the markers of the previous message with the markers of this message."""
        markers_to_show = list(self.markers(message))
        header = getattr(message, "header", None)
        for marker in markers_to_show:
            if marker.header.frame_id:
                continue
            if header is None:
                marker.header.frame_id = FIXED_FRAME
            else:
                marker.header = header
        self._check_duplicates(markers_to_show)
        for identity in self._markers.keys() - {marker_id(marker) for marker in markers_to_show}:
            self._remove(identity)
        for marker in markers_to_show:
            self._apply_marker(marker)
        self._show()

    def is_finite(self, *numbers: ArrayLike) -> bool:
        """Return whether all numbers of a message are finite, and show an error in the status if not."""
        if all(np.isfinite(number).all() for number in numbers):
            self.delete_status_row(_MESSAGE_ROW)
            return True
        text = phrase("Message contained invalid floating point values (nans or infs)")
        self.set_status_row(_MESSAGE_ROW, "error", text)
        return False

    def on_property_changed(self, path: Path) -> None:
        """Apply a changed property, and draw the last message again."""
        super().on_property_changed(path)
        if path[0] not in (TOPIC, _NAMESPACES):
            self.show_again()
