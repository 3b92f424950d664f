"""Robots: the content of RobotModel displays, and the sliders of joints."""

from __future__ import annotations

from typing import ClassVar, Literal

from msgspec import field

from linkwright.page.protocol.configuration import Place
from linkwright.page.protocol.description import LinkInertia
from linkwright.page.protocol.message import Floats, PageMessage, Record, ServerMessage


class JointControl(Record):
    """A row of the Joints panel.

    `mimic` is the name of the joint that this joint follows, with position = multiplier * position of that joint +
    offset. The user cannot move a mimic joint.
    """

    name: str
    kind: Literal["revolute", "continuous", "prismatic"]
    lower: float
    upper: float
    zero: float
    mimic: str | None = None
    multiplier: float = 1.0
    offset: float = 0.0


class Joints(ServerMessage):
    """The rows of the Joints panel. None closes the panel."""

    controls: list[JointControl] | None


class JointPositions(ServerMessage):
    """The positions of the joints in the Joints panel, including mimic joints, in rad or m."""

    positions: dict[str, float]


class SetJoint(PageMessage):
    """A position to which the user has moved a joint, in rad or m."""

    name: str
    position: float


class SetJoints(PageMessage):
    """New positions of several joints, in rad or m, when a pose is restored or a sweep advances."""

    positions: dict[str, float]


class RandomizeJoints(PageMessage):
    """A press of the Randomize button."""


class CenterJoints(PageMessage):
    """A press of the Center button."""


ShapeKind = Literal[
    "box", "cylinder", "capsule", "sphere", "mesh", "ellipsoid", "cone", "plane", "polyline", "heightmap"
]
"""The kinds of shapes. ``ellipsoid`` and the following kinds occur only in worlds."""


class Submesh(Record):
    """The part of a mesh file to draw, by its name in the file.

    If `center` is true, the part is moved to the origin.
    """

    name: str
    center: bool


class Surface(Record):
    """The material of a shape in a world: roughness and metalness, 0 to 1, and image addresses.

    `emissive_map` is the light that the surface emits. `occlusion_map` (its red channel) darkens regions that ambient
    light does not reach.
    """

    roughness: float
    metalness: float
    normal_map: str | None = None
    roughness_map: str | None = None
    metalness_map: str | None = None
    emissive_map: str | None = None
    occlusion_map: str | None = None


class Shape(Record):
    """A shape to draw, with its pose in the frame of the link.

    `size` is x, y, z for a box; radius, length for a cylinder or capsule (along z); radius for a sphere; scale x, y, z
    for a mesh. `url` and `format` (the file extension, lower case) are set for a mesh. `color` is None if the URDF
    gives no color. A mesh then has the materials in its file, and any other shape is red as in RViz. If `repaints` is
    true, color and texture replace the materials of a mesh.

    In worlds, `size` is the radii of an ellipsoid; radius, length of a cone (tip up); x, y of a plane; the height of a
    polyline. The `outlines` of a polyline (x, y, x, y, ...) cut holes into each other. For a heightmap, `size` is x, y,
    z, the offset of its center, and the edge length of its texture. `heights` are fractions of z, shape (rows,
    columns), in rows along x from the minimum x and y.
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
    repaints: bool = False
    submesh: Submesh | None = None
    outlines: list[list[float]] = field(default_factory=list)
    heights: Floats | None = None
    columns: int = 0
    surface: Surface | None = None


class LinkScene(Record):
    """A link to draw at the pose of a frame."""

    name: str
    frame: str
    parent_joint: str | None
    visuals: list[Shape]
    collisions: list[Shape]
    place: Place | None = None
    inertia: LinkInertia | None = None


class JointScene(Record):
    """A joint with its pose in the frame of the parent link. SI units.

    `axis` is in the frame of the joint.

    `lower` and `upper` are None if the joint has no limit, or if the limit is not finite.
    """

    name: str
    kind: Literal["revolute", "continuous", "prismatic", "fixed", "floating", "planar"]
    parent: str
    child: str
    position: list[float]
    quaternion: list[float]
    axis: list[float]
    lower: float | None
    upper: float | None


class RobotScene(ServerMessage):
    """The robot of a RobotModel display. `revision` counts the display's descriptions so far.

    The list of links is empty if there is no robot.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    revision: int
    name: str
    links: list[LinkScene]
    joints: list[JointScene] = field(default_factory=list)


class MeshStatus(PageMessage):
    """The outcome of loading a mesh in the page. `error` is None if the mesh is drawn."""

    display: str
    link: str
    url: str
    error: str | None


class RequestProvenance(PageMessage):
    """A request for the source positions of a link selected in a RobotModel display."""

    display: str
    link: str


class LinkProvenance(ServerMessage):
    """The source positions of a link and its macro calls, as lines. Response to `RequestProvenance`."""

    display: str
    link: str
    lines: list[str]
