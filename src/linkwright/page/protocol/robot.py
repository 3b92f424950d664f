"""The robot: the content of RobotModel displays, and the sliders of its joints."""

from __future__ import annotations

from typing import ClassVar, Literal

from msgspec import field

from linkwright.page.protocol.configuration import Place
from linkwright.page.protocol.description import LinkInertia
from linkwright.page.protocol.message import Floats, PageMessage, Record, ServerMessage


class JointControl(Record):
    """A row of the Joints panel.

    `mimic` is the joint that it follows, position = multiplier * position of that + offset; the user cannot move it.
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
    """The rows of the Joints panel; None closes the panel."""

    controls: list[JointControl] | None


class JointPositions(ServerMessage):
    """Positions of the Joints panel's joints, rad or m, including mimicking ones."""

    positions: dict[str, float]


class SetJoint(PageMessage):
    """The user moved a joint, rad or m."""

    name: str
    position: float


class SetJoints(PageMessage):
    """A pose was recalled, or a sweep advances: several joints at once, rad or m."""

    positions: dict[str, float]


class RandomizeJoints(PageMessage):
    """The Randomize button."""


class CenterJoints(PageMessage):
    """The Center button."""


ShapeKind = Literal[
    "box", "cylinder", "capsule", "sphere", "mesh", "ellipsoid", "cone", "plane", "polyline", "heightmap"
]
"""The kinds of shapes; those from ``ellipsoid`` on occur only in worlds."""


class Submesh(Record):
    """The part of a mesh file that is drawn, by its name there; `center` moves it to the origin."""

    name: str
    center: bool


class Surface(Record):
    """The material of a shape of a world: roughness and metalness from 0 to 1, and addresses of images.

    `emissive_map` is its own light, `occlusion_map` (red) darkens places that ambient light does not reach.
    """

    roughness: float
    metalness: float
    normal_map: str | None = None
    roughness_map: str | None = None
    metalness_map: str | None = None
    emissive_map: str | None = None
    occlusion_map: str | None = None


class Shape(Record):
    """A shape to draw, posed in its link's frame.

    `size` is x, y, z for a box; radius, length for a cylinder or capsule (along z); radius for a sphere; scale x, y, z
    for a mesh. `url` and `format` (the file ending, lower case) are set for a mesh. `color` is None where the URDF
    gives no colour: then a mesh keeps its own materials and another shape is RViz's red. With `repaints` colour and
    texture take the place of the mesh's own.

    Of worlds: `size` is the radii of an ellipsoid; radius, length of a cone (its tip above); x, y of a plane; the
    height of a polyline, whose `outlines` (x, y, x, y, ...) cut holes into each other; x, y, z of a heightmap, the
    offset of its middle, and the edge length of its texture; `heights` are shares of z, shape (rows, columns), from
    the least x and y on along x.
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
    """A link to draw in the frame of its name."""

    name: str
    frame: str
    parent_joint: str | None
    visuals: list[Shape]
    collisions: list[Shape]
    place: Place | None = None
    inertia: LinkInertia | None = None


class JointScene(Record):
    """A joint, posed in its parent link's frame; `axis` is in the joint's own. SI units.

    `lower` and `upper` are None if there is no limit, or if it is not finite.
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
    """The robot of a RobotModel display; `revision` counts descriptions. An empty list of links means no robot."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    revision: int
    name: str
    links: list[LinkScene]
    joints: list[JointScene] = field(default_factory=list)


class MeshStatus(PageMessage):
    """The outcome of loading a mesh in the page; `error` is None if it is drawn."""

    display: str
    link: str
    url: str
    error: str | None


class AskProvenance(PageMessage):
    """The user selected a link of a RobotModel display; ask for its place in the files."""

    display: str
    link: str


class LinkProvenance(ServerMessage):
    """The place of a link with its macro calls and their values, as lines; answers `AskProvenance`."""

    display: str
    link: str
    lines: list[str]
