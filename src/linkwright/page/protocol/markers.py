"""Markers: content of the Marker and MarkerArray displays, and interactive markers."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import Bytes, DataContent, Floats, PageMessage, Record

MarkerKind = Literal[
    "arrow",
    "cube",
    "sphere",
    "cylinder",
    "line_strip",
    "line_list",
    "cube_list",
    "sphere_list",
    "points",
    "text",
    "mesh",
    "triangle_list",
    "arrow_strip",
]
"""The kinds in the order of the numbers in visualization_msgs. The last one exists since Jazzy."""


class MarkerMesh(Record):
    """The file of a mesh marker: an address, or the bytes contained in the message.

    `embedded` is whether the materials in the mesh file are used, tinted by the color of the marker.
    """

    format: str
    url: str | None
    data: Bytes | None
    embedded: bool


class MarkerShape(Record):
    """A marker with the fields of visualization_msgs/msg/Marker.

    `id` is ``<namespace>/<number>``. `pose` (x y z qx qy qz qw) is in the Fixed Frame or, if `frame` is not empty, in
    this frame, and the marker then follows the frame. `scale` is x, y, z. `color` is RGBA. `points` has shape (N, 3),
    `colors` (N, 4) or is empty, `uvs` (N, 2) or is empty. `texture` is the address of an image.
    """

    id: str
    namespace: str
    shape: MarkerKind
    frame: str
    pose: list[float]
    scale: list[float]
    color: list[float]
    points: Floats
    colors: Floats
    uvs: Floats
    text: str
    mesh: MarkerMesh | None
    texture: str | None


class MarkersChanged(DataContent):
    """The new and changed markers of Marker and MarkerArray, and the IDs of removed markers.

    If `everything` is set, all earlier markers are removed.
    """

    everything: bool
    removed_ids: list[str]
    markers: list[MarkerShape]


OrientationMode = Literal["inherit", "fixed", "view_facing"]
"""The modes in the order of the numbers in visualization_msgs, like `InteractionMode`."""

InteractionMode = Literal[
    "none",
    "menu",
    "button",
    "move_axis",
    "move_plane",
    "rotate_axis",
    "move_rotate",
    "move_3d",
    "rotate_3d",
    "move_rotate_3d",
]
FeedbackEvent = Literal["pose_update", "menu_select", "button_click", "mouse_down", "mouse_up"]


class InteractiveControl(Record):
    """A control of an interactive marker.

    The control's axis is the x axis of `orientation` (x y z w, in the frame that the orientation mode selects). The
    poses of `markers` are in the frame of the control, or in the frame of the interactive marker if
    `independent_orientation` is true.
    """

    name: str
    description: str
    mode: InteractionMode
    orientation_mode: OrientationMode
    orientation: list[float]
    always_visible: bool
    independent_orientation: bool
    markers: list[MarkerShape]


class MarkerMenuEntry(Record):
    """An entry of a marker's menu. `parent` is 0 for a top-level entry."""

    id: int
    parent: int
    title: str


class InteractiveMarkerShape(DataContent, tag="interactive_marker"):
    """An interactive marker in the frame of the content.

    `pose` is x y z qx qy qz qw, and `scale` is in meters.
    """

    name: str
    description: str
    pose: list[float]
    scale: float
    controls: list[InteractiveControl]
    menu: list[MarkerMenuEntry]


class InteractiveMarkerMoved(DataContent):
    """The new pose of an interactive marker in the frame of the content."""

    name: str
    pose: list[float]


class MarkerFeedback(PageMessage):
    """An action of the user on an interactive marker.

    Poses and points are in the frame of the marker.

    `mouse_point` is the point of the marker under the mouse, or empty.
    """

    display: str
    marker: str
    control: str
    event: FeedbackEvent
    pose: list[float]
    menu_entry: int
    mouse_point: list[float]
