"""The element ``<state>``: the poses of models and lights in a saved world.

Source of the elements and defaults: the SDFormat specification 1.12, ``state.sdf``.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from linkwright.geometry.single import Vector3
from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.lights import LIGHT, Light
from linkwright.sdf.models import MODEL, Model
from linkwright.sdf.poses import POSE, RawPose
from linkwright.sdf.values import INTEGER, TEXT, TIME, VECTOR3, name_of, object_rule, value, values, without_unreadable
from linkwright.xmltree import Element


@dataclass(frozen=True, slots=True)
class LinkState:
    """The state of a link in a saved world.

    Its pose is in the frame of the world.
    """

    name: str
    pose: RawPose | None = None


@dataclass(frozen=True, slots=True)
class ModelState:
    """The state of a model, its links and its nested models in a saved world.

    Poses are in the frame of the world.
    """

    name: str
    pose: RawPose | None = None
    scale: Vector3 = (1.0, 1.0, 1.0)
    links: tuple[LinkState, ...] = ()
    models: tuple[ModelState, ...] = ()
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class LightState:
    """The state of a light in a saved world.

    Its pose is in the frame of the world.
    """

    name: str
    pose: RawPose | None = None


@dataclass(frozen=True, slots=True)
class Insertions:
    """The models and lights that were inserted after the simulation started."""

    models: tuple[Model, ...] = ()
    lights: tuple[Light, ...] = ()


@dataclass(frozen=True, slots=True)
class Deletions:
    """The names of models and lights that were deleted after the simulation started."""

    names: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class State:
    """A saved state of Gazebo classic, overriding the poses in the rest of the world file.

    Attributes:
        world_name: the name of the world.
        sim_time: the simulated time in seconds when the world was saved.
        iterations: the number of simulation steps up to then.
    """

    world_name: str = ""
    sim_time: float = 0.0
    iterations: int = 0
    models: tuple[ModelState, ...] = ()
    lights: tuple[LightState, ...] = ()
    insertions: Insertions = Insertions()
    deletions: Deletions = Deletions()
    element: Element | None = field(default=None, compare=False, repr=False)


_STATE_POSE = replace(POSE, default=None)

_LINK_STATE = ElementRule(
    "link",
    "the state of a link",
    (name_of("the name"),),
    (_STATE_POSE,),
    is_repeated=True,
    make=LinkState,
    keeps_element=True,
    field="links",
)

_MODEL_STATE = ElementRule(
    "model",
    "the state of a model",
    (name_of("the name"),),
    (_STATE_POSE, value("scale", VECTOR3, "the scale", default="1 1 1"), _LINK_STATE),
    is_repeated=True,
    make=ModelState,
    keeps_element=True,
    passes_element=True,
    is_recursive=True,
    field="models",
)

STATE = ElementRule(
    "state",
    "the state of the world when it was saved",
    (AttributeRule("world_name", TEXT, "the name of the world", default=""),),
    (
        value("sim_time", TIME, "the simulated time", "s", default="0"),
        value("iterations", INTEGER, "the number of steps", default="0"),
        _MODEL_STATE,
        ElementRule(
            "light",
            "the state of a light",
            (name_of("the name"),),
            (_STATE_POSE,),
            is_repeated=True,
            make=LightState,
            keeps_element=True,
            field="lights",
        ),
        object_rule(
            Insertions, "insertions", "the models and lights that were added later", MODEL, LIGHT, default=Insertions()
        ),
        object_rule(
            without_unreadable(Deletions),
            "deletions",
            "the models and lights that were deleted later",
            values("name", TEXT, "the name of a model or light"),
            default=Deletions(),
        ),
    ),
    is_repeated=True,
    make=State,
    keeps_element=True,
    passes_element=True,
    field="states",
)
