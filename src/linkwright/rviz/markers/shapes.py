"""Convert visualization_msgs/msg/Marker to the page's shapes, and store the markers.

The rules and the texts of errors are the same as in RViz.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.single import Quaternion, Transform, compose, normalized
from linkwright.page.files import IMAGE_TYPES, MESH_TYPES, MeshIndex
from linkwright.page.protocol.markers import MarkerKind, MarkerMesh, MarkersChanged, MarkerShape
from linkwright.page.protocol.message import pack_data

ADD, DELETE, DELETE_ALL = 0, 2, 3

_MARKER_KINDS: tuple[MarkerKind, ...] = get_args(MarkerKind)
"""The kinds in the order of the numbers in visualization_msgs."""
_NO_POINTS = np.empty((0, 3), dtype=np.float32)
_NO_COLORS = np.empty((0, 4), dtype=np.float32)
_NO_UVS = np.empty((0, 2), dtype=np.float32)


class BadMarkerError(ValueError):
    """Raised when a marker cannot be drawn.

    The message gives the reason.
    """


@dataclass(slots=True)
class MarkerReading:
    """The drawable form of a marker, before it is placed.

    Attributes:
        shape: the shape; its pose and frame are set when the marker is placed.
        pose: the pose in the message's frame.
        warning: a text about a probable mistake in the message, or None.
    """

    shape: MarkerShape
    pose: Transform
    warning: Phrase | None = None


def make_marker(
    namespace: str,
    name: str,
    kind: MarkerKind,
    pose: Sequence[float],
    scale: Sequence[float],
    color: Sequence[float],
    *,
    frame: str = "",
    points: NDArray[np.float32] = _NO_POINTS,
    colors: NDArray[np.float32] = _NO_COLORS,
    mesh: MarkerMesh | None = None,
) -> MarkerShape:
    """Return a drawable marker with the given values, without a message.

    Args:
        namespace: the marker's namespace.
        name: the marker's name within the namespace.
        kind: the kind of the marker's shape.
        pose: x, y, z, qx, qy, qz, qw in `frame`.
        scale: x, y, z, as in visualization_msgs/msg/Marker for this kind.
        color: red, green, blue, alpha, from 0 to 1.
        frame: the frame that the marker follows; empty for the Fixed Frame.
        points: the points, shape (N, 3), meters.
        colors: one color for each point, shape (N, 4); empty to use `color`.
        mesh: the file of a ``mesh``.
    """
    return MarkerShape(
        id=f"{namespace}/{name}",
        namespace=namespace,
        shape=kind,
        frame=frame,
        pose=list(pose),
        scale=list(scale),
        color=list(color),
        points=points,
        colors=colors,
        uvs=_NO_UVS,
        text="",
        mesh=mesh,
        texture=None,
    )


def marker_id(message: Any) -> str:
    """Return the ID of a marker, as RViz shows it in status rows: ``<namespace>/<number>``."""
    return f"{message.ns}/{message.id}"


def read_marker(message: Any, index: MeshIndex) -> MarkerReading:
    """Return the shape of a marker.

    Args:
        message: a visualization_msgs/msg/Marker with the action ADD.
        index: finds the files that the marker refers to.

    Raises:
        BadMarkerError: the marker cannot be drawn.
    """
    if not 0 <= message.type < len(_MARKER_KINDS):
        raise BadMarkerError(phrase("Unknown marker type: {type}", type=message.type))
    kind = _MARKER_KINDS[message.type]
    pose = _to_transform(message.pose)
    shape = MarkerShape(
        id=marker_id(message),
        namespace=message.ns,
        shape=kind,
        frame="",
        pose=list(pose),
        scale=[message.scale.x, message.scale.y, message.scale.z],
        color=_to_rgba(message.color),
        points=_to_point_array(message.points),
        colors=_to_color_array(message.colors),
        uvs=_NO_UVS,
        text=message.text if kind == "text" else "",
        mesh=None,
        texture=None,
    )
    _check_floats(shape)
    check_shape = _CHECKS.get(kind)
    warning = check_shape(shape) if check_shape else None
    if kind == "mesh":
        shape.mesh = _find_mesh(message, shape, index)
    elif kind == "triangle_list":
        _add_texture(message, shape, index)
    return MarkerReading(shape, pose, warning)


def marker_pose(frame: Transform, reading: MarkerReading) -> list[float]:
    """Return the marker's pose in a frame, given the pose of the message's frame in that frame."""
    return list(compose(frame, reading.pose))


def pose_to_values(pose: Any) -> list[float]:
    """Return a geometry_msgs/msg/Pose as x, y, z, qx, qy, qz, qw, with a normalized quaternion."""
    return list(_to_transform(pose))


def _to_transform(pose: Any) -> Transform:
    position = pose.position
    return (position.x, position.y, position.z, *unit_quaternion(pose.orientation))


def unit_quaternion(quaternion: Any) -> Quaternion:
    """Return a geometry_msgs/msg/Quaternion, normalized to unit length.

    A quaternion that is not set becomes the identity, as in RViz.
    """
    return normalized(quaternion.x, quaternion.y, quaternion.z, quaternion.w)


def _to_rgba(color: Any) -> list[float]:
    return [color.r, color.g, color.b, color.a]


def _to_point_array(points: Any) -> NDArray[np.float32]:
    if not points:
        return _NO_POINTS
    return np.array([(point.x, point.y, point.z) for point in points], dtype=np.float32).reshape(-1, 3)


def _to_color_array(colors: Any) -> NDArray[np.float32]:
    if not colors:
        return _NO_COLORS
    return np.array([(color.r, color.g, color.b, color.a) for color in colors], dtype=np.float32).reshape(-1, 4)


def _check_floats(shape: MarkerShape) -> None:
    is_finite = all(map(math.isfinite, (*shape.pose, *shape.scale, *shape.color)))
    if not is_finite or any(len(array) and not np.isfinite(array).all() for array in (shape.points, shape.colors)):
        raise BadMarkerError(phrase("Contains invalid floating point values (nans or infs)"))


def _check_arrow(shape: MarkerShape) -> Phrase | None:
    if len(shape.points) == 1:
        raise BadMarkerError(
            phrase("Arrow marker [{id}] only specified one point of a point to point arrow.", id=shape.id)
        )
    if len(shape.points) == 2:
        return phrase("Scale of 0 in both x and y") if shape.scale[0] + shape.scale[1] == 0.0 else None
    return _check_scale(shape)


def _check_arrow_strip(shape: MarkerShape) -> Phrase | None:
    if len(shape.points) < 2:
        raise BadMarkerError(phrase("Arrow strip marker [{id}] needs at least two points.", id=shape.id))
    return phrase("Scale of 0 in both x and y") if shape.scale[0] + shape.scale[1] == 0.0 else None


def _check_scale(shape: MarkerShape) -> Phrase | None:
    return phrase("Scale of 0 in one of x/y/z") if math.prod(shape.scale) == 0.0 else None


def _check_line_list(shape: MarkerShape) -> Phrase | None:
    if len(shape.points) % 2:
        raise BadMarkerError(phrase("Line list marker [{id}] has an odd number of points.", id=shape.id))
    return None


def _check_dots(shape: MarkerShape) -> Phrase | None:
    has_colors = len(shape.colors) > 0 and len(shape.colors) == len(shape.points)
    if has_colors and not shape.colors[:, 3].any():
        return phrase("All points have a zero alpha value.")
    return None


def _check_triangles(shape: MarkerShape) -> Phrase | None:
    count = len(shape.points)
    if count == 0:
        raise BadMarkerError(phrase("TriMesh marker [{id}] has no points.", id=shape.id))
    if count % 3:
        raise BadMarkerError(
            phrase(
                "TriMesh marker [{id}] has a point count which is not divisible by 3 [{count}]",
                id=shape.id,
                count=count,
            )
        )
    return _check_scale(shape)


_CHECKS: dict[MarkerKind, Callable[[MarkerShape], Phrase | None]] = {
    "arrow": _check_arrow,
    "arrow_strip": _check_arrow_strip,
    "cube": _check_scale,
    "sphere": _check_scale,
    "cylinder": _check_scale,
    "line_list": _check_line_list,
    "cube_list": _check_dots,
    "sphere_list": _check_dots,
    "points": _check_dots,
    "triangle_list": _check_triangles,
}


def _find_mesh(message: Any, shape: MarkerShape, index: MeshIndex) -> MarkerMesh:
    """Return the mesh in the message, or the file that the message refers to.

    Messages can contain meshes since ROS 2 Iron.
    """
    name = message.mesh_resource
    embedded_file = message.mesh_file
    if embedded_file.filename and len(embedded_file.data):
        data = np.frombuffer(bytes(embedded_file.data), dtype=np.uint8)
        return MarkerMesh(_get_extension(embedded_file.filename), None, data, message.mesh_use_embedded_materials)
    located = index.locate(name, None, MESH_TYPES)
    if located.url is None:
        raise BadMarkerError(
            phrase(
                "Mesh resource marker [{id}] could not load [{name}]: {reason}",
                id=shape.id,
                name=name,
                reason=located.problem,
            )
        )
    return MarkerMesh(_get_extension(name), located.url, None, message.mesh_use_embedded_materials)


def _add_texture(message: Any, shape: MarkerShape, index: MeshIndex) -> None:
    if not message.texture_resource or not message.uv_coordinates:
        return
    count = len(message.uv_coordinates)
    if count != len(shape.points):
        raise BadMarkerError(
            phrase(
                "TriMesh marker [{id}] has {count} uv coordinates for {points} points",
                id=shape.id,
                count=count,
                points=len(shape.points),
            )
        )
    located = index.locate(message.texture_resource, None, IMAGE_TYPES)
    if located.url is None:
        raise BadMarkerError(
            phrase(
                "Could not load texture '{name}': {reason}",
                name=message.texture_resource,
                reason=located.problem,
            )
        )
    shape.texture = located.url
    shape.uvs = np.array([(uv.u, uv.v) for uv in message.uv_coordinates], dtype=np.float32)


def _get_extension(name: str) -> str:
    return name.rpartition(".")[2].lower()


_MAX_REMOVED_IDS = 5000
"""The maximum number of stored removals. A page that missed more removals receives all markers again."""


class MarkerStore:
    """The markers of a display by ID, with a revision number for each change.

    A page receives only the changes since the last revision that it has. The store implements `outbox.Changes`.

    Args:
        display: the ID of the display.
    """

    def __init__(self, display: str) -> None:
        self.key = f"data {display}"
        self._display = display
        self._markers: dict[str, tuple[int, MarkerShape]] = {}
        self._removed_ids: dict[str, int] = {}
        self._revision = 0
        self._oldest_revision = 0
        self._packed: tuple[int, int, bytes] | None = None

    def __len__(self) -> int:
        return len(self._markers)

    def __contains__(self, identity: str) -> bool:
        return identity in self._markers

    @property
    def shapes(self) -> list[MarkerShape]:
        """The markers that are shown."""
        return [shape for _, shape in self._markers.values()]

    def put(self, shape: MarkerShape) -> None:
        """Add a marker, replacing any marker with the same ID."""
        self._revision += 1
        self._removed_ids.pop(shape.id, None)
        self._markers.pop(shape.id, None)  # so that the dict is ordered by revision
        self._markers[shape.id] = (self._revision, shape)

    def remove(self, identity: str) -> bool:
        """Remove a marker, and return whether the store contained it."""
        if self._markers.pop(identity, None) is None:
            return False
        self._revision += 1
        self._removed_ids.pop(identity, None)
        self._removed_ids[identity] = self._revision
        if len(self._removed_ids) > _MAX_REMOVED_IDS:
            self._oldest_revision = self._removed_ids.pop(next(iter(self._removed_ids)))
        return True

    def clear(self) -> None:
        """Remove all markers."""
        self._revision += 1
        self._oldest_revision = self._revision
        self._markers.clear()
        self._removed_ids.clear()

    def since(self, seen: int) -> tuple[bytes | None, int]:
        """Return the packed changes since a revision, or None, and the current revision.

        None means that nothing has changed.

        `seen` is the last revision that the page has. If it is 0 or too old, all markers are packed.
        """
        if seen == self._revision:
            return None, seen
        if self._packed is None or self._packed[:2] != (seen, self._revision):
            self._packed = (seen, self._revision, self._pack(seen))
        return self._packed[2], self._revision

    def _pack(self, page_revision: int) -> bytes:
        sends_all = page_revision < self._oldest_revision or page_revision == 0
        return pack_data(
            self._display,
            MarkersChanged(
                everything=sends_all,
                removed_ids=[] if sends_all else _find_newer(self._removed_ids, page_revision),
                markers=[shape for revision, shape in self._markers.values() if sends_all or revision > page_revision],
            ),
        )


def _find_newer(revisions: dict[str, int], page_revision: int) -> list[str]:
    return [identity for identity, revision in revisions.items() if revision > page_revision]
