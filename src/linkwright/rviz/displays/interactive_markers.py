"""The display rviz_default_plugins/InteractiveMarkers."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from linkwright.diagnostics import LinkwrightError, Phrase, foreign, phrase
from linkwright.geometry.single import Transform
from linkwright.graph import TransformException
from linkwright.messages import get_message
from linkwright.page.files import MeshIndex
from linkwright.page.protocol.configuration import StatusLevel
from linkwright.page.protocol.markers import InteractiveMarkerMoved, MarkerFeedback
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec
from linkwright.rviz.displays.base.display import DataDisplay, DisplayHost, Pose
from linkwright.rviz.markers import BadMarkerError
from linkwright.rviz.markers.interactive import ClientEvents, InteractiveMarkerClient, read_interactive_marker
from linkwright.rviz.markers.shapes import pose_to_values

_NAMESPACE_PROPERTY = "Interactive Markers Namespace"
_TRANSPARENCY_PROPERTY = "Enable Transparency"
_CLIENT_ROW = "Interactive Marker Client"

_EVENT_TYPES = {"pose_update": 1, "menu_select": 2, "button_click": 3, "mouse_down": 4, "mouse_up": 5}


class InteractiveMarkersDisplay(DataDisplay):
    """A display of the markers of an interactive marker server.

    It sends the user's actions to the server.
    """

    CLASS = "rviz_default_plugins/InteractiveMarkers"
    MESSAGE = "visualization_msgs/msg/InteractiveMarkerUpdate"
    TOPIC = (_NAMESPACE_PROPERTY,)
    SCHEMA = (
        PropertySpec(_NAMESPACE_PROPERTY, "string", "", "The namespace of the interactive marker server."),
        PropertySpec("Show Descriptions", "bool", True, "Show the description above each marker."),
        PropertySpec("Show Axes", "bool", False, "Show the axes of each marker."),
        PropertySpec("Show Visual Aids", "bool", False, "Show the axis along or about which a marker moves."),
        PropertySpec(_TRANSPARENCY_PROPERTY, "bool", True, "Whether the default arrows and rings are transparent."),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._client: InteractiveMarkerClient | None = None
        self._release: Any = None
        self._markers: dict[str, Any] = {}
        self._poses: dict[str, list[float]] = {}
        self._unplaced_names: set[str] = set()
        self._queued_updates: list[Callable[[], None]] = []
        self._index = MeshIndex(host.context.finder)

    @classmethod
    def topic_value(cls, topic: str) -> str:
        """Return the namespace of the interactive marker server that publishes updates on a topic."""
        return topic.rpartition("/")[0]

    # --- lifecycle ---------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Connect to the server if the display is enabled."""
        if self.enabled:
            self._connect()

    def stop(self) -> None:
        """Disconnect, and end the pages' access to the files of the markers."""
        self._disconnect()
        self.context.meshes.replace(self.id, {})

    def on_property_changed(self, path: Path) -> None:
        """Connect again and recreate the markers if the namespace or the transparency changed."""
        if path in ((_NAMESPACE_PROPERTY,), (_TRANSPARENCY_PROPERTY,)):
            self.reset()

    def on_enabled_changed(self) -> None:
        """Connect to the server if the display is enabled, or disconnect."""
        self.reset()

    def reset(self) -> None:
        """Discard all markers, and connect again if the display is enabled."""
        self._disconnect()
        if self.enabled:
            self._connect()

    def on_frames_changed(self) -> None:
        """Place the markers in the new Fixed Frame."""
        for name in list(self._markers):
            self._show(name)

    def on_time_changed(self) -> None:
        """Apply the updates from the server that were queued while time was paused."""
        if not self.host.time.paused:
            queued_updates, self._queued_updates = self._queued_updates, []
            for handle in queued_updates:
                handle()

    def receive(self, message: Any) -> None:
        """Send the user's action on a marker to the server."""
        if not isinstance(message, MarkerFeedback) or self._client is None:
            return
        marker = self._markers.get(message.marker)
        if marker is None or len(message.pose) != 7:
            return
        if message.event == "pose_update":
            self._poses[message.marker] = message.pose
        feedback = get_message("visualization_msgs/msg/InteractiveMarkerFeedback")()
        feedback.header = marker.header
        feedback.client_id = self.context.node.get_fully_qualified_name() + "/" + self.id
        feedback.marker_name = message.marker
        feedback.control_name = message.control
        feedback.event_type = _EVENT_TYPES[message.event]
        feedback.menu_entry_id = max(0, min(message.menu_entry, 2**32 - 1))
        _set_pose(feedback.pose, message.pose)
        feedback.mouse_point_valid = len(message.mouse_point) == 3
        if feedback.mouse_point_valid:
            feedback.mouse_point.x, feedback.mouse_point.y, feedback.mouse_point.z = message.mouse_point
        self._client.publish(feedback)

    def _connect(self) -> None:
        namespace = self.properties.text(_NAMESPACE_PROPERTY).strip()
        if not namespace:
            self.set_status_row(_CLIENT_ROW, "error", phrase("Error connecting: empty namespace"))
            return
        self._release = self.context.transforms.add_listener(self._on_transforms)
        events = ClientEvents(
            on_all_markers=lambda markers: self._apply_or_queue(partial(self._apply_all, markers)),
            on_update=lambda update: self._apply_or_queue(partial(self._apply_update, update)),
            on_all_removed=self._clear,
            on_status=self._client_status,
        )
        try:
            self._client = InteractiveMarkerClient(self.context.node, namespace, events)
        except LinkwrightError as error:
            self.set_status_row(
                _CLIENT_ROW, "error", phrase("Error connecting: {message}", message=error.diagnostics[0].message)
            )

    def _disconnect(self) -> None:
        if self._client is not None:
            self._client.close()
            self._client = None
        if self._release is not None:
            self._release()
            self._release = None
        self._clear()
        self.delete_status_row()

    # --- from the server ---------------------------------------------------------------------------------------

    def _client_status(self, level: StatusLevel, text: Phrase) -> None:
        self.set_status_row(_CLIENT_ROW, level, text)

    def _apply_or_queue(self, handle: Callable[[], None]) -> None:
        """Handle an update from the server immediately or, while time is paused, after the pause."""
        if self.host.time.paused:
            self._queued_updates.append(handle)
        else:
            handle()

    def _clear(self) -> None:
        self._queued_updates.clear()
        for name in self._markers:
            self.delete_status_row(name)
        self._markers.clear()
        self._poses.clear()
        self._unplaced_names.clear()
        self.remove_content()

    def _apply_all(self, markers: list[Any]) -> None:
        self._clear()
        for marker in markers:
            self._apply_marker(marker)

    def _apply_update(self, update: Any) -> None:
        for marker in update.markers:
            self._apply_marker(marker)
        for pose_update in update.poses:
            self._move(pose_update)
        for name in update.erases:
            self._erase(name)

    def _apply_marker(self, marker: Any) -> None:
        self._markers[marker.name] = marker
        self._poses[marker.name] = pose_to_values(marker.pose)
        self._data.pop(f"pose {marker.name}", None)
        self._show(marker.name)

    def _move(self, pose_update: Any) -> None:
        marker = self._markers.get(pose_update.name)
        if marker is None:
            self.set_status_row(
                pose_update.name,
                "error",
                phrase("Pose received for non-existing marker '{name}'", name=pose_update.name),
            )
            return
        pose = pose_to_values(pose_update.pose)
        self._poses[pose_update.name] = pose
        is_same_frame = pose_update.header.frame_id in ("", marker.header.frame_id) and _is_latest(
            pose_update
        ) == _is_latest(marker)
        if pose_update.header.frame_id:
            marker.header = pose_update.header
        if not is_same_frame or not _is_latest(marker):
            self._show(pose_update.name)  # the pose is relative to another frame or time
        elif pose_update.name not in self._unplaced_names:
            content = InteractiveMarkerMoved(pose_update.name, pose)
            self.send(content, key=f"pose {pose_update.name}", frame=marker.header.frame_id.removeprefix("/"))

    def _erase(self, name: str) -> None:
        self._markers.pop(name, None)
        self._poses.pop(name, None)
        self._unplaced_names.discard(name)
        self._data.pop(f"pose {name}", None)
        self.remove_content(f"marker {name}")
        self.delete_status_row(name)

    # --- to pages ----------------------------------------------------------------------------------------------

    def _show(self, name: str) -> None:
        marker = self._markers[name]
        frame = marker.header.frame_id.removeprefix("/")
        try:
            frame_pose = self._find_frame_pose(marker, frame)
            shape = read_interactive_marker(
                marker, self._index, self._find_relative_pose, transparent=self.properties.flag(_TRANSPARENCY_PROPERTY)
            )
        except TransformException as error:
            self._unplaced_names.add(name)
            self.set_status_row(name, "error", error.diagnostics[0].message)
            self.remove_content(f"marker {name}")
            return
        except BadMarkerError as error:
            self.set_status_row(name, "error", foreign(error))
            self.remove_content(f"marker {name}")
            return
        self._unplaced_names.discard(name)
        self.delete_status_row(name)
        shape.pose = self._poses[name]
        self.context.meshes.replace(self.id, self._index.folders)
        self.send(shape, key=f"marker {name}", frame=frame, pose=frame_pose)

    def _find_frame_pose(self, marker: Any, frame: str) -> Pose | None:
        """Return the pose of a marker's frame at its stamp, or None for the latest transform.

        Raises:
            TransformException: the transform is not available.
        """
        fixed_frame = self.host.frames.fixed_frame
        stamp = marker.header.stamp
        pose = self.context.transforms.pose(fixed_frame, frame, stamp.nanoseconds)
        return None if _is_latest(marker) else pose

    def _find_relative_pose(self, reference: str, frame: str) -> Transform:
        x, y, z, qx, qy, qz, qw = self.context.transforms.pose(reference, frame, 0).tolist()
        return x, y, z, qx, qy, qz, qw

    def _on_transforms(self) -> None:
        for name in list(self._unplaced_names):
            self._show(name)


def _is_latest(message: Any) -> bool:
    return bool(message.header.stamp.sec == 0 and message.header.stamp.nanosec == 0)


def _set_pose(message: Any, pose: list[float]) -> None:
    position, orientation = message.position, message.orientation
    position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, orientation.w = pose
