"""``<light>``: directional, point and spot lights.

Source of the elements and defaults: the SDFormat specification 1.12, ``light.sdf``.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from linkwright.geometry.single import Vector3
from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.poses import AT_ORIGIN, POSE, RawPose
from linkwright.sdf.values import COLOR, NUMBER, TRUTH, VECTOR3, Color, choice, name_of, object_rule, value
from linkwright.xmltree import Element


@dataclass(frozen=True, slots=True)
class Attenuation:
    """The decrease of light with distance.

    At d meters, the factor is 1 / (constant + linear d + quadratic d^2). Beyond `range`, in meters, there is no light.
    """

    range: float = 10.0
    constant: float = 1.0
    linear: float = 1.0
    quadratic: float = 0.0


@dataclass(frozen=True, slots=True)
class Spot:
    """The cone of a spot light, with angles in radians.

    The light has full intensity within the inner angle, and does not reach beyond the outer angle.
    """

    inner_angle: float = 0.0
    outer_angle: float = 0.0
    falloff: float = 0.0


@dataclass(frozen=True, slots=True)
class Light:
    """A light of a world or link.

    Attributes:
        type: ``point``, ``directional`` or ``spot``.
        pose: the pose in the frame of the light's world or link, unless it names another frame.
        diffuse: the color of the light.
        specular: the color of highlights.
        direction: the direction of the rays in the light's own frame, for spot and directional lights.
        attenuation: the decrease of the light with distance.
        spot: the cone of a spot light; None for other types.
        cast_shadows: whether lit objects cast shadows.
        intensity: the factor by which the color is multiplied.
        light_on: whether the light is switched on.
    """

    name: str
    type: str = "point"
    pose: RawPose = AT_ORIGIN
    diffuse: Color = (1.0, 1.0, 1.0, 1.0)
    specular: Color = (0.1, 0.1, 0.1, 1.0)
    direction: Vector3 = (0.0, 0.0, -1.0)
    attenuation: Attenuation = Attenuation()
    spot: Spot | None = None
    cast_shadows: bool = False
    intensity: float = 1.0
    light_on: bool = True
    element: Element | None = field(default=None, compare=False, repr=False)


LIGHT = ElementRule(
    "light",
    "a light",
    (
        name_of(),
        AttributeRule("type", choice("point", "directional", "spot"), "the kind of light", default="point"),
    ),
    (
        POSE,
        value("diffuse", COLOR, "the color", default="1 1 1 1"),
        value("specular", COLOR, "the color of highlights", default="0.1 0.1 0.1 1"),
        value("direction", VECTOR3, "the direction of the rays in the frame of the light", default="0 0 -1"),
        object_rule(
            Attenuation,
            "attenuation",
            "the decrease of light with distance",
            value("range", NUMBER, "the range of the light", "m", default="10"),
            value("constant", NUMBER, "the constant coefficient", default="1"),
            value("linear", NUMBER, "the coefficient of the distance", default="1"),
            value("quadratic", NUMBER, "the coefficient of the squared distance", default="0"),
            default=Attenuation(),
        ),
        object_rule(
            Spot,
            "spot",
            "the cone of a spot light",
            value("inner_angle", NUMBER, "the angle up to which the light has full intensity", "rad", default="0"),
            value("outer_angle", NUMBER, "the angle beyond which there is no light", "rad", default="0"),
            value("falloff", NUMBER, "the decrease of light between the two angles", default="0"),
        ),
        value("cast_shadows", TRUTH, "whether lit objects cast shadows", default="false"),
        value("intensity", NUMBER, "the factor for the color", default="1"),
        value("light_on", TRUTH, "whether the light is switched on", default="true"),
    ),
    is_repeated=True,
    make=Light,
    keeps_element=True,
    passes_element=True,
    is_owner=True,
    field="lights",
)
