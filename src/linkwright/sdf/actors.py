"""``<actor>``: an animated figure that walks along a path.

Source of the elements and defaults: the SDFormat specification 1.12, ``actor.sdf``.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.joints import JOINT, Joint
from linkwright.sdf.links import LINK, Link
from linkwright.sdf.plugins import PLUGIN, Plugin
from linkwright.sdf.poses import AT_ORIGIN, POSE, RawPose
from linkwright.sdf.values import INTEGER, NUMBER, TEXT, TIME, TRUTH, name_of, object_rule, value
from linkwright.xmltree import Element


@dataclass(frozen=True, slots=True)
class Skin:
    """The mesh file of an actor, and the scale of the mesh."""

    filename: str = "__default__"
    scale: float = 1.0


@dataclass(frozen=True, slots=True)
class Animation:
    """An animation of an actor's body.

    With `interpolate_x`, the speed of the animation follows the walking speed of the actor.
    """

    name: str
    filename: str = "__default__"
    scale: float = 1.0
    interpolate_x: bool = False


@dataclass(frozen=True, slots=True)
class Waypoint:
    """A pose of the actor, and the time in seconds at which it is reached."""

    time: float = 0.0
    pose: RawPose = AT_ORIGIN


@dataclass(frozen=True, slots=True)
class Trajectory:
    """A path through waypoints.

    `type` is the name of the animation that is played along the path.

    A tension of 0 gives a round path, and a tension of 1 gives straight lines.
    """

    id: int = 0
    type: str = ""
    tension: float = 0.0
    waypoints: tuple[Waypoint, ...] = ()


@dataclass(frozen=True, slots=True)
class Script:
    """The timing of an actor's walk, and its paths.

    The walk begins `delay_start` seconds after the start of the simulation.
    """

    loop: bool = True
    delay_start: float = 0.0
    auto_start: bool = True
    trajectories: tuple[Trajectory, ...] = ()


@dataclass(frozen=True, slots=True)
class Actor:
    """A figure that walks along a path and does not collide with anything."""

    name: str
    pose: RawPose = AT_ORIGIN
    skin: Skin | None = None
    animations: tuple[Animation, ...] = ()
    script: Script = Script()
    links: tuple[Link, ...] = ()
    joints: tuple[Joint, ...] = ()
    plugins: tuple[Plugin, ...] = ()
    element: Element | None = field(default=None, compare=False, repr=False)


_FILE = value("filename", TEXT, "the path or URI of the file", default="__default__")
_SCALE = value("scale", NUMBER, "the scale factor", default="1")

ACTOR = ElementRule(
    "actor",
    "a figure that walks along a path",
    (name_of(),),
    (
        POSE,
        object_rule(Skin, "skin", "the mesh of the figure", _FILE, _SCALE),
        ElementRule(
            "animation",
            "an animation of the body",
            (name_of("the name, to which paths refer"),),
            (
                _FILE,
                _SCALE,
                value("interpolate_x", TRUTH, "whether the animation follows the walking speed", default="false"),
            ),
            is_repeated=True,
            make=Animation,
            keeps_element=True,
            field="animations",
        ),
        object_rule(
            Script,
            "script",
            "the timing and the paths of the walk",
            value("loop", TRUTH, "whether the walk is repeated", default="true"),
            value("delay_start", NUMBER, "the delay before the walk", "s", default="0"),
            value("auto_start", TRUTH, "whether the walk starts automatically", default="true"),
            ElementRule(
                "trajectory",
                "a path",
                (
                    AttributeRule("id", INTEGER, "the number of the path", default="0"),
                    AttributeRule("type", TEXT, "the name of the animation", default=""),
                    AttributeRule("tension", NUMBER, "the tension, from 0 for round to 1 for straight", default="0"),
                ),
                (
                    object_rule(
                        Waypoint,
                        "waypoint",
                        "a waypoint of the path",
                        value("time", TIME, "the time at the waypoint", "s", default="0"),
                        POSE,
                        is_repeated=True,
                        field="waypoints",
                    ),
                ),
                is_repeated=True,
                make=Trajectory,
                keeps_element=True,
                field="trajectories",
            ),
            default=Script(),
        ),
        LINK,
        JOINT,
        PLUGIN,
    ),
    is_repeated=True,
    make=Actor,
    keeps_element=True,
    passes_element=True,
    is_owner=True,
    field="actors",
)
