"""The robot model: the typed contents of a URDF file.

Units are SI: meters, radians, kilograms, seconds, newtons. Every pose is the pose of a child frame in its parent
frame. Every part stores its XML element with its position in the file, even if the file was expanded by
xacro. The sources are the XML specification of the ROS package ``urdf``, and urdfdom's interpretation of it.
"""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.geometry.shapes import MAX_COORDINATE, SimpleShape
from linkwright.geometry.single import IDENTITY_POSE, Pose, Vector3
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.loading.lean_typing import TYPE_CHECKING, Literal
from linkwright.xmltree import Element

if TYPE_CHECKING:
    from linkwright.geometry.mass import MassProperties

_MAX_MASS = 1e30
"""The largest mass in kg, and moment of inertia in kg m2, to compute with. The sun has 2e30 kg."""

JointType = Literal["revolute", "continuous", "prismatic", "fixed", "floating", "planar"]


@dataclass(frozen=True, slots=True)
class Mesh:
    """A mesh file by its URI, with scale factors along x, y, z.

    The URI begins with ``package://`` or ``file://``, or is a path.
    """

    filename: str
    scale: Vector3 = (1.0, 1.0, 1.0)


Geometry = SimpleShape | Mesh


@dataclass(frozen=True, slots=True)
class Material:
    """A material with a color, a texture URI, or both.

    The color is red, green, blue, alpha, each from 0 to 1. Color and texture are None in a reference to a material by
    name.
    """

    name: str
    rgba: tuple[float, float, float, float] | None = None
    texture: str | None = None
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Visual:
    """A shape to display.

    By urdfdom's rules, `material` is the first definition of its name in the file, or None if there is none.
    """

    geometry: Geometry
    origin: Pose = IDENTITY_POSE
    name: str = ""
    material_name: str = ""
    material: Material | None = None
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Collision:
    """A shape for collision detection."""

    geometry: Geometry
    origin: Pose = IDENTITY_POSE
    name: str = ""
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Inertial:
    """The mass properties of a link.

    These are the mass in kg, the pose of the center of mass in the link frame, and the inertia tensor about the center
    of mass in kg m2.
    """

    mass: float
    ixx: float
    ixy: float
    ixz: float
    iyy: float
    iyz: float
    izz: float
    origin: Pose = IDENTITY_POSE
    element: Element | None = field(default=None, compare=False, repr=False)

    @property
    def is_computable(self) -> bool:
        """Whether the numbers are small enough to avoid overflow, even if physically invalid."""
        numbers = (self.mass, self.ixx, self.ixy, self.ixz, self.iyy, self.iyz, self.izz)
        return max(map(abs, numbers)) <= _MAX_MASS and max(map(abs, self.origin.xyz)) <= MAX_COORDINATE

    @property
    def has_mass(self) -> bool:
        """Whether the mass is usable, so that it can be distributed over a shape."""
        from linkwright.geometry.mass import MIN_MASS

        return self.is_computable and self.mass > MIN_MASS

    @property
    def properties(self) -> MassProperties:
        """The mass properties in the link frame."""
        import numpy as np  # here, because most users of a robot do not compute with its masses

        from linkwright.geometry.mass import MassProperties

        rows = ((self.ixx, self.ixy, self.ixz), (self.ixy, self.iyy, self.iyz), (self.ixz, self.iyz, self.izz))
        return MassProperties(self.mass, np.zeros(3), np.array(rows, dtype=np.float64)).moved(self.origin)

    @classmethod
    def of(cls, properties: MassProperties) -> Inertial:
        """Return the ``<inertial>`` with these mass properties, in the axes of the link frame."""
        tensor = properties.inertia
        x, y, z = (float(coordinate) for coordinate in properties.center)
        ixx, ixy, ixz, iyy, iyz, izz = (float(tensor[i, j]) for i in range(3) for j in range(i, 3))
        return cls(float(properties.mass), ixx, ixy, ixz, iyy, iyz, izz, Pose((x, y, z)))


@dataclass(frozen=True, slots=True)
class Link:
    """A rigid body, whose frame is the frame of its parent joint."""

    name: str
    inertial: Inertial | None = None
    visuals: tuple[Visual, ...] = ()
    collisions: tuple[Collision, ...] = ()
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Limit:
    """Joint limits: lower and upper in rad or m, effort in N m or N, velocity in rad/s or m/s.

    The acceleration, deceleration and jerk belong to URDF 1.2.
    """

    lower: float = 0.0
    upper: float = 0.0
    effort: float = 0.0
    velocity: float = 0.0
    acceleration: float | None = None
    deceleration: float | None = None
    jerk: float | None = None


@dataclass(frozen=True, slots=True)
class Mimic:
    """A mimic relation: position = multiplier * position of `joint` + offset (in rad or m)."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class Safety:
    """A ``safety_controller`` with gains and soft limits (in rad or m)."""

    k_velocity: float
    k_position: float = 0.0
    soft_lower_limit: float = 0.0
    soft_upper_limit: float = 0.0


@dataclass(frozen=True, slots=True)
class Dynamics:
    """Joint dynamics: damping in N m s/rad or N s/m, friction in N m or N."""

    damping: float = 0.0
    friction: float = 0.0


@dataclass(frozen=True, slots=True)
class Calibration:
    """The reference positions of a joint, in rad or m."""

    rising: float | None = None
    falling: float | None = None


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint between a parent link and a child link.

    `origin` is the pose of the joint frame in the parent link's frame. `axis` is given in the joint frame, and is not
    normalized.
    """

    name: str
    type: JointType
    parent: str
    child: str
    origin: Pose = IDENTITY_POSE
    axis: Vector3 = (1.0, 0.0, 0.0)
    limit: Limit | None = None
    mimic: Mimic | None = None
    safety: Safety | None = None
    dynamics: Dynamics | None = None
    calibration: Calibration | None = None
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Robot:
    """A complete description, with links, joints and materials in source order.

    Attributes:
        version: the file's ``version`` attribute as (major, minor), or (1, 0) if it is missing.
        root: the name of the only link without a parent joint.
        extensions: the elements for other packages: ``gazebo``, ``ros2_control``, ``transmission``, ``sensor``, ...
    """

    name: str
    root: str
    links: Mapping[str, Link]
    joints: Mapping[str, Joint]
    materials: Mapping[str, Material]
    version: tuple[int, int] = (1, 0)
    extensions: tuple[Element, ...] = field(default=(), compare=False, repr=False)
    element: Element | None = field(default=None, compare=False, repr=False)
