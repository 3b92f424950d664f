"""Interactive markers: the client of a marker server, and the conversion to shapes.

The client receives all markers first, and then changes. After a lost change, it receives all markers again. Controls
without markers get the same arrows, rings and buttons as in the ``interactive_markers`` package.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, get_args

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.arrays import rotation_matrix
from linkwright.geometry.single import Transform, compose, invert
from linkwright.graph import Client, Node, Publisher, QoSProfile, Subscription
from linkwright.messages import get_message, get_service
from linkwright.page.files import MeshIndex
from linkwright.page.protocol.configuration import StatusLevel
from linkwright.page.protocol.markers import (
    InteractionMode,
    InteractiveControl,
    InteractiveMarkerShape,
    MarkerKind,
    MarkerMenuEntry,
    MarkerShape,
    OrientationMode,
)
from linkwright.rviz.markers.shapes import BadMarkerError, pose_to_values, read_marker, unit_quaternion

_CHECK_PERIOD_S = 0.25
"""Seconds between two checks whether the server is available."""

_UPDATE_DEPTH = 100
_UPDATE = 1


@dataclass(slots=True)
class ClientEvents:
    """Callbacks for the events of a connection to a server.

    Attributes:
        on_all_markers: called with all markers of the server, at the beginning and after a lost update.
        on_update: called with a visualization_msgs/msg/InteractiveMarkerUpdate.
        on_all_removed: called when all markers must be removed, for example because the server has disappeared.
        on_status: called with the state of the connection, for the display's status.
    """

    on_all_markers: Callable[[list[Any]], None]
    on_update: Callable[[Any], None]
    on_all_removed: Callable[[], None]
    on_status: Callable[[StatusLevel, Phrase], None]


class InteractiveMarkerClient:
    """A client of an interactive marker server.

    The client waits until the server is available, and connects again when the server returns.

    Args:
        node: the node that subscribes.
        namespace: the server's namespace.
        events: the callbacks.

    Raises:
        LinkwrightError: no valid topic name can be formed from the namespace.
    """

    def __init__(self, node: Node, namespace: str, events: ClientEvents) -> None:
        self._node = node
        self._namespace = namespace.rstrip("/")
        self._events = events
        self._sequence: int | None = None
        self._early_updates: list[Any] = []
        self._request: Any = None
        self._check_timer: asyncio.TimerHandle | None = None
        self._subscription: Subscription[Any] = node.create_subscription(
            get_message("visualization_msgs/msg/InteractiveMarkerUpdate"),
            f"{self._namespace}/update",
            self._on_received,
            QoSProfile(_UPDATE_DEPTH),
        )
        self._feedback_publisher: Publisher[Any] = node.create_publisher(
            get_message("visualization_msgs/msg/InteractiveMarkerFeedback"),
            f"{self._namespace}/feedback",
            QoSProfile(_UPDATE_DEPTH),
        )
        self._client: Client[Any, Any] = node.create_client(
            get_service("visualization_msgs/srv/GetInteractiveMarkers"), f"{self._namespace}/get_interactive_markers"
        )
        self._watch()

    def publish(self, feedback: Any) -> None:
        """Send feedback on a marker to the server."""
        self._feedback_publisher.publish(feedback)

    def close(self) -> None:
        """Disconnect from the server."""
        if self._check_timer is not None:
            self._check_timer.cancel()
            self._check_timer = None
        self._request = None
        with suppress(ValueError):  # the node may already have been destroyed
            self._node.destroy_subscription(self._subscription)
            self._node.destroy_publisher(self._feedback_publisher)
            self._node.destroy_client(self._client)

    def _watch(self) -> None:
        self._check_timer = asyncio.get_running_loop().call_later(_CHECK_PERIOD_S, self._watch)
        is_ready = self._client.service_is_ready()
        if not is_ready and (self._sequence is not None or self._request is not None):
            self._reset()
        if not is_ready:
            self._events.on_status(
                "warn", phrase("Service is not available: {name}", name=f"{self._namespace}/get_interactive_markers")
            )
        elif self._sequence is None and self._request is None:
            self._request_markers()

    def _request_markers(self) -> None:
        self._events.on_status("ok", phrase("Sending request for interactive markers"))
        request = self._request = self._client.call_async(self._client.srv_type.Request())
        request.add_done_callback(lambda future: self._on_response(request, future.result()))

    def _on_response(self, request: Any, response: Any) -> None:
        if request is not self._request or response is None:
            return  # the client was reset since the request, because the server disappeared
        self._request = None
        self._sequence = response.sequence_number
        self._events.on_all_markers(list(response.markers))
        self._events.on_status("ok", phrase("Initialized interactive marker client"))
        early_updates, self._early_updates = self._early_updates, []
        for update in early_updates:
            self._on_received(update)

    def _on_received(self, update: Any) -> None:
        if self._sequence is None:
            self._early_updates = [*self._early_updates, update][-_UPDATE_DEPTH:]
            return
        if update.seq_num <= self._sequence and update.type == _UPDATE:
            return  # the response with all markers includes this update
        expected = self._sequence + (1 if update.type == _UPDATE else 0)
        if update.seq_num != expected:
            self._reset()
            self._events.on_status(
                "warn",
                phrase(
                    "Detected lost update or server restart. Resetting. Sequence {expected} expected", expected=expected
                ),
            )
            return
        if update.type == _UPDATE:
            self._sequence = update.seq_num
            self._events.on_update(update)

    def _reset(self) -> None:
        self._sequence = self._request = None
        self._early_updates.clear()
        self._events.on_all_removed()


_MODES: tuple[InteractionMode, ...] = get_args(InteractionMode)
_ORIENTATIONS: tuple[OrientationMode, ...] = get_args(OrientationMode)

_RING_STEPS = 36
_RING_WIDTH = 0.3
"""The width of rings as a fraction of their inner radius, which is half the scale of the marker."""

_DARK_SHADE = 0.6
_NO_COLORS = np.empty((0, 4), dtype=np.float32)


FramePlacer = Callable[[str, str], Transform]
"""Returns the current pose of the second frame in the first frame. Raises a LinkwrightError if it is unknown."""


def read_interactive_marker(
    message: Any, index: MeshIndex, frames: FramePlacer, *, transparent: bool
) -> InteractiveMarkerShape:
    """Return the drawable form of an interactive marker: its shapes and controls.

    Args:
        message: a visualization_msgs/msg/InteractiveMarker.
        index: finds the files that the marker refers to.
        frames: returns the pose of one frame in another, for markers of controls that specify a frame.
        transparent: whether default arrows and rings are transparent.

    Raises:
        BadMarkerError: the marker cannot be drawn.
    """
    scale = message.scale or 1.0
    pose = pose_to_values(message.pose)
    if not all(map(math.isfinite, (*pose, scale))):
        raise BadMarkerError(phrase("Marker contains invalid floats!"))
    names: set[str] = set()
    return InteractiveMarkerShape(
        name=message.name,
        description=message.description,
        pose=pose,
        scale=scale,
        controls=[
            _read_control(
                control, message, scale, _make_unique_name(control.name, names), index, frames, transparent=transparent
            )
            for control in message.controls
        ],
        menu=[
            MarkerMenuEntry(menu_entry.id, menu_entry.parent_id, menu_entry.title)
            for menu_entry in message.menu_entries
        ],
    )


def _make_unique_name(name: str, used_names: set[str]) -> str:
    unique_name, number = name, 0
    while unique_name in used_names:
        unique_name, number = f"{name}_u{number}", number + 1
    used_names.add(unique_name)
    return unique_name


def _read_control(
    control: Any,
    message: Any,
    scale: float,
    name: str,
    index: MeshIndex,
    frames: FramePlacer,
    *,
    transparent: bool,
) -> InteractiveControl:
    if control.interaction_mode >= len(_MODES) or control.orientation_mode >= len(_ORIENTATIONS):
        raise BadMarkerError(phrase("Control '{name}' has an unknown interaction or orientation mode", name=name))
    mode = _MODES[control.interaction_mode]
    orientation_mode = _ORIENTATIONS[control.orientation_mode]
    is_independent = control.independent_marker_orientation
    orientation = list(unit_quaternion(control.orientation))
    if control.markers:
        markers = [_read_marker(marker, message, index, frames) for marker in control.markers]
    elif mode == "menu":
        markers, orientation_mode, is_independent = (
            [_make_button_marker(control.description, scale)],
            "view_facing",
            False,
        )
    else:
        markers = list(_make_default_markers(mode, orientation, scale, 0.5 if transparent else 1.0))
    for number, marker in enumerate(markers):
        marker.id = f"{message.name}/{name}/{number}"
        marker.namespace = message.name
    return InteractiveControl(
        name=name,
        description=control.description,
        mode=mode,
        orientation_mode=orientation_mode,
        orientation=orientation,
        always_visible=control.always_visible,
        independent_orientation=is_independent,
        markers=markers,
    )


def _read_marker(marker: Any, message: Any, index: MeshIndex, frames: FramePlacer) -> MarkerShape:
    shape = read_marker(marker, index).shape
    shape.scale = [length or 1.0 for length in shape.scale]
    frame = marker.header.frame_id.removeprefix("/")
    reference = message.header.frame_id.removeprefix("/")
    if frame:
        # The pose is relative to the frame in the header, but the page attaches the marker to the control.
        pose_in_reference = compose(frames(reference, frame), _to_transform(shape.pose))
        shape.pose = list(compose(invert(_to_transform(pose_to_values(message.pose))), pose_in_reference))
    return shape


def _to_transform(pose: list[float]) -> Transform:
    x, y, z, qx, qy, qz, qw = pose
    return x, y, z, qx, qy, qz, qw


def _make_default_markers(
    mode: InteractionMode, orientation: list[float], scale: float, alpha: float
) -> Iterator[MarkerShape]:
    color = [*_compute_axis_color(orientation), alpha]
    base = _make_shape("arrow", orientation, [scale] * 3, color)
    if mode == "move_axis":
        for direction in (1.0, -1.0):
            points = np.array([[direction * scale * 0.5, 0, 0], [direction * scale * 0.9, 0, 0]], dtype=np.float32)
            yield replace(base, scale=[scale * 0.15, scale * 0.25, scale * 0.2], points=points)
    elif mode in ("move_plane", "rotate_axis", "move_rotate"):
        points, shades = _make_ring_triangles(mode)
        colors = _NO_COLORS if shades is None else _apply_shades(color[:3], shades)
        yield replace(base, shape="triangle_list", points=points, colors=colors)


def _compute_axis_color(orientation: list[float]) -> list[float]:
    """Return the color of an axis: red for x, green for y, blue for z, or a mixture.

    The axis is the x axis of an orientation.
    """
    axis = np.abs(rotation_matrix(orientation)[:, 0])
    color: list[float] = (axis / axis.max()).tolist()
    return color


def _make_ring_triangles(mode: InteractionMode) -> tuple[NDArray[np.float32], NDArray[np.float64] | None]:
    """Return the triangles of a ring about x, inner radius 0.5, and their brightness or None."""
    angles = np.arange(_RING_STEPS) * (2 * np.pi / _RING_STEPS)
    inner = 0.5 * np.stack([np.zeros(_RING_STEPS), np.cos(angles), np.sin(angles)], axis=1)
    outer = (1 + _RING_WIDTH) * inner

    def after(ring: NDArray[np.float64], steps: int) -> NDArray[np.float64]:
        return np.roll(ring, -steps, axis=0)

    inner_1, outer_1, outer_2 = after(inner, 1), after(outer, 1), after(outer, 2)
    if mode == "rotate_axis":  # slanted teeth, alternately light and dark
        corners = np.stack([inner, outer_1, inner_1, inner_1, outer_1, outer_2], axis=1)
        shades = np.repeat(_DARK_SHADE + (1 - _DARK_SHADE) * (np.arange(_RING_STEPS) % 2), 2)
    elif mode == "move_rotate":  # dark points inward, light points outward
        inner_2 = after(inner, 2)
        dark = np.stack([inner, outer_1, inner_1, inner_1, outer_1, inner_2], axis=1)
        light = np.stack([outer, outer_1, inner, outer_1, outer_2, inner_2], axis=1)
        corners = np.stack([dark, light], axis=1)[::2].reshape(-1, 6, 3)
        shades = np.tile(np.repeat([_DARK_SHADE, 1.0], 2), _RING_STEPS // 2)
    else:
        corners = np.stack([inner, outer, inner_1, outer, outer_1, inner_1], axis=1)
        return corners.reshape(-1, 3).astype(np.float32), None
    return corners.reshape(-1, 3).astype(np.float32), shades


def _apply_shades(color: list[float], shades: NDArray[np.float64]) -> NDArray[np.float32]:
    rgb = shades[:, None] * np.array(color)
    return np.hstack([rgb, np.ones((len(shades), 1))]).astype(np.float32)


def _make_button_marker(text: str, scale: float) -> MarkerShape:
    size = 0.25 * scale
    shape = _make_shape("text", [0.0, 0.0, 0.0, 1.0], [size] * 3, [1.0, 1.0, 1.0, 1.0])
    shape.pose[0], shape.pose[2] = -0.1 * size, 1.2 * scale - 0.1 * size
    shape.text = text
    return shape


def _make_shape(kind: MarkerKind, orientation: list[float], scale: list[float], color: list[float]) -> MarkerShape:
    return MarkerShape(
        id="",
        namespace="",
        shape=kind,
        frame="",
        pose=[0.0, 0.0, 0.0, *orientation],
        scale=scale,
        color=color,
        points=_NO_COLORS,
        colors=_NO_COLORS,
        uvs=_NO_COLORS,
        text="",
        mesh=None,
        texture=None,
    )
