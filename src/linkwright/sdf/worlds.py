"""The elements ``<world>`` and ``<sdf>``: scene, position on earth, atmosphere and roads.

Other modules define the remaining elements of a world.

Source of the elements and defaults: the SDFormat specification 1.12, ``world.sdf``, ``scene.sdf``.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from linkwright.geometry.single import Vector3
from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.actors import ACTOR, Actor
from linkwright.sdf.joints import JOINT, Joint
from linkwright.sdf.lights import LIGHT, Light
from linkwright.sdf.models import FRAME, INCLUDE, MODEL, Frame, Include, Model
from linkwright.sdf.physics import PHYSICS, Physics
from linkwright.sdf.plugins import PLUGIN, Plugin
from linkwright.sdf.populations import POPULATION, Population, generate_models
from linkwright.sdf.skies import FOG, SKY, Fog, Sky
from linkwright.sdf.states import STATE, State
from linkwright.sdf.values import (
    COLOR,
    NUMBER,
    TEXT,
    TRUTH,
    VECTOR3,
    Color,
    object_rule,
    value,
    values,
    without_unreadable,
)
from linkwright.xmltree import Element


@dataclass(frozen=True, slots=True)
class Scene:
    """The appearance of a world: ambient light, background, sky and fog.

    Colors are red, green, blue and alpha from 0 to 1. `sky` and `fog` are None for a scene without them.
    """

    ambient: Color = (0.4, 0.4, 0.4, 1.0)
    background: Color = (0.7, 0.7, 0.7, 1.0)
    shadows: bool = True
    grid: bool = True
    origin_visual: bool = True
    sky: Sky | None = None
    fog: Fog | None = None
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class SphericalCoordinates:
    """The position and heading on earth of a world's origin.

    Latitude (to the north), longitude (to the east) and heading are in degrees. The elevation is in meters above the
    ellipsoid.
    """

    surface_model: str = "EARTH_WGS84"
    world_frame_orientation: str = "ENU"
    latitude_deg: float = 0.0
    longitude_deg: float = 0.0
    elevation: float = 0.0
    heading_deg: float = 0.0


@dataclass(frozen=True, slots=True)
class Atmosphere:
    """The atmosphere of a world.

    At the origin, the temperature is in kelvin and the pressure in pascals. The temperature gradient is in K/m.
    """

    type: str = "adiabatic"
    temperature: float = 288.15
    temperature_gradient: float = -0.0065
    pressure: float = 101325.0


@dataclass(frozen=True, slots=True)
class Road:
    """A road through points, with a width in meters."""

    name: str = ""
    width: float = 1.0
    points: tuple[Vector3, ...] = ()
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class World:
    """A world.

    Lengths are in meters, gravity in m/s2, the magnetic field in tesla and wind in m/s.

    Attributes:
        gravity: the gravity; None if the world does not set it (`find_gravity` then returns the effective gravity).
        states: the saved states; Gazebo classic uses the last one.
    """

    name: str = ""
    gravity: Vector3 | None = None
    magnetic_field: Vector3 = (5.5645e-6, 22.8758e-6, -42.3884e-6)
    wind: Vector3 = (0.0, 0.0, 0.0)
    physics: tuple[Physics, ...] = ()
    scene: Scene = Scene()
    spherical_coordinates: SphericalCoordinates | None = None
    atmosphere: Atmosphere = Atmosphere()
    models: tuple[Model, ...] = ()
    includes: tuple[Include, ...] = ()
    actors: tuple[Actor, ...] = ()
    lights: tuple[Light, ...] = ()
    joints: tuple[Joint, ...] = ()
    frames: tuple[Frame, ...] = ()
    plugins: tuple[Plugin, ...] = ()
    roads: tuple[Road, ...] = ()
    populations: tuple[Population, ...] = ()
    states: tuple[State, ...] = ()
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Sdf:
    """The content of an SDF file: worlds, or a single model, light or actor.

    A program that adds a model to a world may send an include alone, as libsdformat allows.
    """

    version: str
    worlds: tuple[World, ...] = ()
    models: tuple[Model, ...] = ()
    lights: tuple[Light, ...] = ()
    actors: tuple[Actor, ...] = ()
    includes: tuple[Include, ...] = ()
    element: Element | None = field(default=None, compare=False, repr=False)


def find_gravity(world: World) -> Vector3:
    """Return the effective gravity of a world in m/s2.

    The world's own gravity takes precedence over the gravity of its physics (up to SDF 1.5), and over the default.
    """
    if world.gravity is not None:
        return world.gravity
    physics = find_physics(world)
    return physics.gravity or (0.0, 0.0, -9.8)


def with_populations(world: World) -> World:
    """Replace the populations of a world by copies of their models."""
    copies = (model for population in world.populations for model in generate_models(population))
    return replace(world, models=(*world.models, *copies), populations=())


def find_physics(world: World) -> Physics:
    """Return the physics settings that a world marks as default, or else the first settings.

    For a world without physics settings, return SDF's defaults.
    """
    return next(
        (physic for physic in world.physics if physic.default), world.physics[0] if world.physics else Physics()
    )


@dataclass(frozen=True, slots=True)
class _Wind:
    linear_velocity: Vector3


def _make_world(wind: _Wind | None, **properties: Any) -> World:
    return World(wind=wind.linear_velocity if wind else (0.0, 0.0, 0.0), **properties)


WORLD = ElementRule(
    "world",
    "a world",
    (AttributeRule("name", TEXT, "the name of the world", required=True, default="default"),),
    (
        value("gravity", VECTOR3, "the gravity", "m/s2"),
        value("magnetic_field", VECTOR3, "the magnetic field", "T", default="5.5645e-6 22.8758e-6 -42.3884e-6"),
        object_rule(
            _Wind,
            "wind",
            "the wind",
            value("linear_velocity", VECTOR3, "the velocity of the wind", "m/s", default="0 0 0"),
            get=lambda world: _Wind(world.wind) if any(world.wind) else None,
        ),
        PHYSICS,
        object_rule(
            Scene,
            "scene",
            "the appearance of the world",
            value("ambient", COLOR, "the ambient light", default="0.4 0.4 0.4 1"),
            value("background", COLOR, "the background color", default="0.7 0.7 0.7 1"),
            value("shadows", TRUTH, "whether there are shadows", default="true"),
            value("grid", TRUTH, "whether a grid is drawn", default="true"),
            value("origin_visual", TRUTH, "whether the origin is drawn", default="true"),
            SKY,
            FOG,
            passes_element=True,
            default=Scene(),
        ),
        object_rule(
            SphericalCoordinates,
            "spherical_coordinates",
            "the position and heading of the origin on earth",
            value("surface_model", TEXT, "the ellipsoid", default="EARTH_WGS84"),
            value("world_frame_orientation", TEXT, "the axes: ENU, NED or NWU", default="ENU"),
            value("latitude_deg", NUMBER, "the latitude, positive to the north", "deg", default="0"),
            value("longitude_deg", NUMBER, "the longitude, positive to the east", "deg", default="0"),
            value("elevation", NUMBER, "the height above the ellipsoid", "m", default="0"),
            value("heading_deg", NUMBER, "the rotation of the x axis from east", "deg", default="0"),
        ),
        ElementRule(
            "atmosphere",
            "the atmosphere",
            (AttributeRule("type", TEXT, "the model of the atmosphere", default="adiabatic"),),
            (
                value("temperature", NUMBER, "the temperature at the origin", "K", default="288.15"),
                value("temperature_gradient", NUMBER, "the temperature change with height", "K/m", default="-0.0065"),
                value("pressure", NUMBER, "the pressure at the origin", "Pa", default="101325"),
            ),
            make=Atmosphere,
            keeps_element=True,
            default=Atmosphere(),
        ),
        MODEL,
        INCLUDE,
        ACTOR,
        LIGHT,
        JOINT,
        FRAME,
        PLUGIN,
        ElementRule(
            "road",
            "a road",
            (AttributeRule("name", TEXT, "the name of the road", default=""),),
            (
                value("width", NUMBER, "the width of the road", "m", default="1"),
                values("point", VECTOR3, "a point on the road"),
            ),
            is_repeated=True,
            make=without_unreadable(Road),
            keeps_element=True,
            passes_element=True,
            field="roads",
        ),
        POPULATION,
        STATE,
    ),
    is_repeated=True,
    make=_make_world,
    keeps_element=True,
    passes_element=True,
    is_owner=True,
    field="worlds",
)

SDF = ElementRule(
    "sdf",
    "the content of the file: worlds, or a single model, light or actor",
    (AttributeRule("version", TEXT, "the version of SDF, 1.0 to 1.12", required=True, default="1.6"),),
    (WORLD, MODEL, LIGHT, ACTOR, INCLUDE),
    make=Sdf,
    keeps_element=True,
    passes_element=True,
)
