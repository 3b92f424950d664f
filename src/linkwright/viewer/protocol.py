"""What the server and the page say to each other, declared once.

Control messages are JSON objects with a ``type``; the TypeScript types in ``frontend/src/protocol.gen.ts`` are
generated from this module by ``tools/protocol_types.py``. Transforms travel as one binary frame, packed by
`pack_transforms`. Lengths are metres, angles radians, quaternions x, y, z, w, colours 0 to 1.

The page opens one WebSocket at ``/ws`` (same origin; the cookie set with the page lets it in). `Hello` comes first,
then `Tree`, the `RobotScene` of every RobotModel, `ViewState`, `Joints`, `JointPositions`, `Diagnostics`, `FrameTable`
and the last transforms; after that whatever changes, where only the newest of a kind waits for a slow page. A binary
frame whose revision is not that of the last `FrameTable` is to be dropped.

Property ids are ``global/<name>`` or ``<display id>/<name>/<name>...``: the names of the rows on the way, joined by
``/``; in a name ``%`` is written ``%25`` and ``/`` is ``%2F``. The page asks for a change with `SetProperty` and takes
it as made when `PropertyChanged` (or new rows) comes back; a refused value is answered with the one that stands.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

PROTOCOL_VERSION = 2
"""Raised on every change that an older page would misread; the page reloads itself when it differs."""

StatusLevel = Literal["ok", "warn", "error"]
PropertyKind = Literal["group", "bool", "int", "float", "string", "color", "enum", "frame"]
PropertyValue = bool | int | float | str | None
ShapeKind = Literal["box", "cylinder", "capsule", "sphere", "mesh"]

_TRANSFORMS_HEADER = struct.Struct("<IIIId")
TRANSFORMS_KIND = 1


# --- parts ---------------------------------------------------------------------------------------------------------


@dataclass(slots=True)
class Property:
    """One row of a property tree, as RViz shows it.

    `id` is unique in the page and stable for the life of a display. Colours are ``#rrggbb``. A `group` has no value;
    any other kind may have children too (``Line Style`` > ``Line Width``).
    """

    id: str
    name: str
    kind: PropertyKind
    value: PropertyValue = None
    description: str = ""
    options: list[str] = field(default_factory=list)
    minimum: float | None = None
    maximum: float | None = None
    read_only: bool = False
    expanded: bool = False
    children: list[Property] = field(default_factory=list)


@dataclass(slots=True)
class StatusRow:
    """One row below a display's Status."""

    name: str
    level: StatusLevel
    text: str


@dataclass(slots=True)
class Display:
    """One display of the Displays panel. `cls` is RViz's class, such as ``rviz_default_plugins/Grid``.

    `supported` is false for a class this program does not draw; it is kept and shown as such. What the rows mean:

    - RobotModel: a shape is drawn with the alpha of its colour, times ``Alpha``, times the link's ``Alpha`` below
      ``Links``. A link's row is a ``bool`` (draw its shapes) when it has any, else a ``group``.
    - TF: a frame is drawn when it has a row below ``Frames`` and that is on; frames that the filters leave out have
      none. ``Update Interval`` (seconds between updates, 0 for every frame) of both is applied by the page.
    """

    id: str
    cls: str
    name: str
    enabled: bool
    supported: bool
    level: StatusLevel
    status: list[StatusRow]
    properties: list[Property]


@dataclass(slots=True)
class Place:
    """A place in a source file, 1-based, with the way there (macro calls and includes, innermost first)."""

    file: str
    line: int
    column: int
    trail: list[str] = field(default_factory=list)


@dataclass(slots=True)
class Shape:
    """A shape to draw, posed in its link's frame.

    `size` is x, y, z for a box; radius, length for a cylinder or capsule (along z); radius for a sphere; scale x, y, z
    for a mesh. `url` and `format` (the file ending, lower case) are set for a mesh. `color` is None where the URDF
    gives no colour: then a mesh keeps its own materials and another shape is RViz's red.
    """

    kind: ShapeKind
    size: list[float]
    position: list[float]
    quaternion: list[float]
    color: list[float] | None = None
    texture: str | None = None
    url: str | None = None
    format: str | None = None
    name: str = ""


@dataclass(slots=True)
class LinkScene:
    """A link to draw in the frame of its name."""

    name: str
    frame: str
    parent_joint: str | None
    visuals: list[Shape]
    collisions: list[Shape]
    place: Place | None = None


@dataclass(slots=True)
class JointControl:
    """A row of the Joints panel. `mimic` is the joint it follows; such a row cannot be moved itself."""

    name: str
    kind: Literal["revolute", "continuous", "prismatic"]
    lower: float
    upper: float
    zero: float
    mimic: str | None = None


@dataclass(slots=True)
class DiagnosticNote:
    """A note of a diagnostic."""

    message: str
    file: str | None
    line: int | None
    column: int | None


@dataclass(slots=True)
class DiagnosticItem:
    """A diagnostic for the page; `excerpt` is the source line, if there is one."""

    code: str
    severity: Literal["error", "warning", "info"]
    message: str
    file: str | None
    line: int | None
    column: int | None
    end_line: int | None
    end_column: int | None
    excerpt: str
    notes: list[DiagnosticNote]
    hints: list[str]


@dataclass(slots=True)
class OrbitView:
    """RViz's Orbit view: eye = focal + distance (cos yaw cos pitch, sin yaw cos pitch, sin pitch)."""

    cls: str = "rviz_default_plugins/Orbit"
    name: str = "Current View"
    near_clip_distance: float = 0.01
    invert_z_axis: bool = False
    target_frame: str = "<Fixed Frame>"
    distance: float = 10.0
    yaw: float = 0.785398
    pitch: float = 0.785398
    focal_point: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    focal_shape_size: float = 0.05
    focal_shape_fixed_size: bool = True


# --- server to page ------------------------------------------------------------------------------------------------


@dataclass(slots=True)
class Hello:
    """First message on every connection."""

    protocol: int
    version: str
    title: str
    type: Literal["hello"] = "hello"


@dataclass(slots=True)
class Tree:
    """The whole Displays tree: sent at the start and whenever displays come or go."""

    global_options: list[Property]
    global_status: list[StatusRow]
    global_level: StatusLevel
    displays: list[Display]
    type: Literal["tree"] = "tree"


@dataclass(slots=True)
class DisplayProperties:
    """The property rows of one display anew (the links of a new robot, the frames of TF)."""

    display: str
    properties: list[Property]
    type: Literal["display_properties"] = "display_properties"


@dataclass(slots=True)
class PropertyChanged:
    """One value, set by any page or by the server. Enable boxes are the property ``<display>/Enabled``."""

    id: str
    value: PropertyValue
    options: list[str] | None = None
    type: Literal["property_changed"] = "property_changed"


@dataclass(slots=True)
class DisplayStatus:
    """The status rows of one display, or of ``global``."""

    display: str
    level: StatusLevel
    status: list[StatusRow]
    type: Literal["display_status"] = "display_status"


@dataclass(slots=True)
class RobotScene:
    """What one RobotModel display draws; `revision` counts descriptions. No links means no robot."""

    display: str
    revision: int
    name: str
    links: list[LinkScene]
    type: Literal["robot_scene"] = "robot_scene"


@dataclass(slots=True)
class FrameTable:
    """Names and parents (index, -1 for a root) of the frames in the binary frames with this revision."""

    revision: int
    names: list[str]
    parents: list[int]
    type: Literal["frame_table"] = "frame_table"


@dataclass(slots=True)
class ViewState:
    """The view of the configuration file; the page owns the camera from then on."""

    view: OrbitView
    type: Literal["view_state"] = "view_state"


@dataclass(slots=True)
class Joints:
    """The rows of the Joints panel; None closes the panel."""

    controls: list[JointControl] | None
    type: Literal["joints"] = "joints"


@dataclass(slots=True)
class JointPositions:
    """Positions of the Joints panel's joints, rad or m, mimicking joints included."""

    positions: dict[str, float]
    type: Literal["joint_positions"] = "joint_positions"


@dataclass(slots=True)
class Diagnostics:
    """What is wrong with the description now; none clears the list."""

    items: list[DiagnosticItem]
    type: Literal["diagnostics"] = "diagnostics"


@dataclass(slots=True)
class LinkStory:
    """Where a link was written, through which macro calls, and with which values, line by line; answers `AskStory`."""

    display: str
    link: str
    lines: list[str]
    type: Literal["link_story"] = "link_story"


# --- page to server ------------------------------------------------------------------------------------------------


@dataclass(slots=True)
class SetProperty:
    """The user edited a property."""

    id: str
    value: PropertyValue
    type: Literal["set_property"] = "set_property"


@dataclass(slots=True)
class SetJoint:
    """The user moved a joint, rad or m."""

    name: str
    position: float
    type: Literal["set_joint"] = "set_joint"


@dataclass(slots=True)
class RandomizeJoints:
    """The Randomize button."""

    type: Literal["randomize_joints"] = "randomize_joints"


@dataclass(slots=True)
class CenterJoints:
    """The Center button."""

    type: Literal["center_joints"] = "center_joints"


@dataclass(slots=True)
class ViewChanged:
    """The camera as the page has it now, at most a few times a second."""

    view: OrbitView
    type: Literal["view_changed"] = "view_changed"


@dataclass(slots=True)
class MeshStatus:
    """How loading a mesh went in the page; `error` is None when it is drawn."""

    display: str
    link: str
    url: str
    error: str | None
    type: Literal["mesh_status"] = "mesh_status"


@dataclass(slots=True)
class AskStory:
    """The user selected a link of a RobotModel display and wants to know how it came to be."""

    display: str
    link: str
    type: Literal["ask_story"] = "ask_story"


ServerMessage = (
    Hello
    | Tree
    | DisplayProperties
    | PropertyChanged
    | DisplayStatus
    | RobotScene
    | FrameTable
    | ViewState
    | Joints
    | JointPositions
    | Diagnostics
    | LinkStory
)
PageMessage = SetProperty | SetJoint | RandomizeJoints | CenterJoints | ViewChanged | MeshStatus | AskStory


def pack_transforms(revision: int, stamp: float, poses: NDArray[Any], ages: NDArray[Any]) -> bytes:
    """One binary frame: header, poses, ages, little endian.

    The header is four uint32 (kind 1, revision of the frame table, number of frames N, 0) and a float64 stamp in
    seconds; then float32 N x 7 (x y z qx qy qz qw in the fixed frame, NaN where there is no transform) and float32 N
    (seconds since each frame was last heard of; 0 for static frames).

    Args:
        revision: of the `FrameTable` that names the rows.
        stamp: time of the newest transform in it, seconds.
        poses: array, shape (N, 7).
        ages: array, shape (N,).

    Raises:
        ValueError: when the shapes do not agree.
    """
    count = len(poses)
    if poses.shape != (count, 7) or ages.shape != (count,):
        raise ValueError(f"poses must be (N, 7) and ages (N,), not {poses.shape} and {ages.shape}")
    header = _TRANSFORMS_HEADER.pack(TRANSFORMS_KIND, revision, count, 0, stamp)
    return header + poses.astype("<f4").tobytes() + np.asarray(ages).astype("<f4").tobytes()
