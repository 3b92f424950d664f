"""The element ``<link>``: inertial, visuals, collisions and sensors.

Source of the elements and defaults: the SDFormat specification 1.12, ``link.sdf`` and the files of its parts.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.lights import LIGHT, Light
from linkwright.sdf.materials import MATERIAL, Material
from linkwright.sdf.plugins import PLUGIN, Plugin
from linkwright.sdf.poses import AT_ORIGIN, POSE, RawPose
from linkwright.sdf.sensors import SENSOR, Sensor
from linkwright.sdf.shapes import GEOMETRY, NO_SHAPE, Shape
from linkwright.sdf.surfaces import DEFAULT_SURFACE, SURFACE, Surface
from linkwright.sdf.values import INTEGER, NUMBER, TRUTH, name_of, object_rule, value
from linkwright.xmltree import Element


@dataclass(frozen=True, slots=True)
class Inertia:
    """The inertia tensor about the center of mass, in kg m2.

    Its axes are those of the inertial frame.
    """

    ixx: float = 1.0
    iyy: float = 1.0
    izz: float = 1.0
    ixy: float = 0.0
    ixz: float = 0.0
    iyz: float = 0.0


@dataclass(frozen=True, slots=True)
class Inertial:
    """The mass properties of a link.

    Attributes:
        mass: the mass in kg.
        pose: the center of mass and the axes of the inertia tensor, in the frame of the link.
        inertia: the inertia tensor.
        auto: whether the mass properties are computed from the collisions and their densities (SDF 1.11).
        density: the density in kg/m3 for `auto`; None for the density of each collision.
    """

    mass: float = 1.0
    pose: RawPose = AT_ORIGIN
    inertia: Inertia = Inertia()
    auto: bool = False
    density: float | None = None
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Visual:
    """A shape of a link that is rendered.

    Attributes:
        transparency: the transparency, from 0 for opaque to 1 for invisible.
        laser_retro: the intensity with which the visual reflects a laser; None if not specified.
        visibility_flags: bits that a camera compares with its visibility mask to decide whether to show the visual.
    """

    name: str
    geometry: Shape = NO_SHAPE
    pose: RawPose = AT_ORIGIN
    material: Material | None = None
    transparency: float = 0.0
    cast_shadows: bool = True
    laser_retro: float | None = None
    visibility_flags: int = 0xFFFFFFFF
    plugins: tuple[Plugin, ...] = ()
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Collision:
    """A shape of a link that collides with other shapes.

    Attributes:
        density: the density in kg/m3 from which the mass of the link may be computed; None for the density of water.
        laser_retro: the intensity with which the collision reflects a laser; None if not specified.
        max_contacts: the maximum number of contact points with another shape.
    """

    name: str
    geometry: Shape = NO_SHAPE
    pose: RawPose = AT_ORIGIN
    surface: Surface = DEFAULT_SURFACE
    density: float | None = None
    laser_retro: float | None = None
    max_contacts: int = 10
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Decay:
    """Velocity damping: the fractions of the velocities that are lost in each step."""

    linear: float = 0.0
    angular: float = 0.0


@dataclass(frozen=True, slots=True)
class Link:
    """A rigid body of a model.

    Attributes:
        pose: the pose of the link in the frame of its model.
        inertial: the mass properties; None if not specified, which means 1 kg and 1 kg m2.
        gravity: whether gravity acts on the link.
        enable_wind: whether wind acts on the link.
        self_collide: whether the link collides with other links of its model; None for the setting of the model.
        kinematic: whether the link moves without reacting to forces.
    """

    name: str
    pose: RawPose = AT_ORIGIN
    inertial: Inertial | None = None
    visuals: tuple[Visual, ...] = ()
    collisions: tuple[Collision, ...] = ()
    sensors: tuple[Sensor, ...] = ()
    lights: tuple[Light, ...] = ()
    gravity: bool = True
    enable_wind: bool = False
    self_collide: bool | None = None
    kinematic: bool = False
    velocity_decay: Decay = Decay()
    element: Element | None = field(default=None, compare=False, repr=False)


_TENSOR = (
    value("ixx", NUMBER, "the xx component", "kg m2", default="1", usually_written=True),
    value("iyy", NUMBER, "the yy component", "kg m2", default="1", usually_written=True),
    value("izz", NUMBER, "the zz component", "kg m2", default="1", usually_written=True),
    value("ixy", NUMBER, "the xy component", "kg m2", default="0"),
    value("ixz", NUMBER, "the xz component", "kg m2", default="0"),
    value("iyz", NUMBER, "the yz component", "kg m2", default="0"),
)

INERTIAL = ElementRule(
    "inertial",
    "the mass properties",
    (AttributeRule("auto", TRUTH, "whether to compute the mass properties from the collisions", default="false"),),
    (
        value("mass", NUMBER, "the mass", "kg", default="1", usually_written=True),
        POSE,
        object_rule(
            Inertia,
            "inertia",
            "the inertia tensor about the center of mass, in the axes of the inertial frame",
            *_TENSOR,
            default=Inertia(),
        ),
        value("density", NUMBER, "the density for computed mass properties", "kg/m3"),
    ),
    make=Inertial,
    keeps_element=True,
    passes_element=True,
)

VISUAL = ElementRule(
    "visual",
    "a shape that is rendered",
    (name_of(),),
    (
        POSE,
        GEOMETRY,
        MATERIAL,
        value("transparency", NUMBER, "the transparency, from 0 for opaque to 1 for invisible", default="0"),
        value("cast_shadows", TRUTH, "whether the visual casts a shadow", default="true"),
        value("laser_retro", NUMBER, "the intensity with which a laser is reflected"),
        value("visibility_flags", INTEGER, "the bits that visibility masks of cameras select", default="4294967295"),
        PLUGIN,
    ),
    is_repeated=True,
    make=Visual,
    keeps_element=True,
    passes_element=True,
    is_owner=True,
    field="visuals",
)

COLLISION = ElementRule(
    "collision",
    "a shape that collides",
    (name_of(),),
    (
        POSE,
        GEOMETRY,
        SURFACE,
        value("density", NUMBER, "the density for computed mass properties", "kg/m3"),
        value("laser_retro", NUMBER, "the intensity with which a laser is reflected"),
        value("max_contacts", INTEGER, "the maximum number of contact points with another shape", default="10"),
    ),
    is_repeated=True,
    make=Collision,
    keeps_element=True,
    passes_element=True,
    is_owner=True,
    field="collisions",
)

LINK = ElementRule(
    "link",
    "a rigid body",
    (name_of(),),
    (
        POSE,
        INERTIAL,
        VISUAL,
        COLLISION,
        SENSOR,
        LIGHT,
        value("gravity", TRUTH, "whether gravity acts on the link", default="true"),
        value("enable_wind", TRUTH, "whether wind acts on the link", default="false"),
        value("self_collide", TRUTH, "whether the link collides with other links of its model"),
        value("kinematic", TRUTH, "whether the link moves without reacting to forces", default="false"),
        object_rule(
            Decay,
            "velocity_decay",
            "the fractions of velocity that are lost in each step",
            value("linear", NUMBER, "the fraction of linear velocity", default="0"),
            value("angular", NUMBER, "the fraction of angular velocity", default="0"),
            default=Decay(),
        ),
    ),
    is_repeated=True,
    make=Link,
    keeps_element=True,
    passes_element=True,
    is_owner=True,
    field="links",
)
