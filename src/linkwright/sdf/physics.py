"""The element ``<physics>``: the time step and the solver of a physics engine.

Source of the elements and defaults: the SDFormat specification 1.12, ``physics.sdf``.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from linkwright.geometry.single import Vector3
from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.values import INTEGER, NUMBER, TEXT, TRUTH, VECTOR3, value
from linkwright.xmltree import Element


@dataclass(frozen=True, slots=True)
class Physics:
    """The settings of a physics engine.

    Attributes:
        type: the engine for which the settings were written, such as ``ode``.
        default: whether to use these settings if the world has several.
        max_step_size: the maximum time step in seconds.
        real_time_factor: the maximum number of simulated seconds per real second.
        real_time_update_rate: steps per real second in Gazebo classic; 0 for as many as possible.
        max_contacts: the maximum number of contact points between two shapes.
        gravity: the gravity in m/s2, up to SDF 1.5; None if not specified.
    """

    name: str = "default_physics"
    type: str = "ode"
    default: bool = False
    max_step_size: float = 0.001
    real_time_factor: float = 1.0
    real_time_update_rate: float = 1000.0
    max_contacts: int = 20
    gravity: Vector3 | None = None
    element: Element | None = field(default=None, compare=False, repr=False)


PHYSICS = ElementRule(
    "physics",
    "the time step, and the speed relative to real time",
    (
        AttributeRule("name", TEXT, "the name of the settings", default="default_physics"),
        AttributeRule("type", TEXT, "the physics engine for which the world was written", default="ode"),
        AttributeRule("default", TRUTH, "whether to use these settings if there are several", default="false"),
    ),
    (
        value("max_step_size", NUMBER, "the maximum time step", "s", default="0.001"),
        value("real_time_factor", NUMBER, "the maximum number of simulated seconds per real second", default="1"),
        value(
            "real_time_update_rate", NUMBER, "steps per real second; 0 for as many as possible", "Hz", default="1000"
        ),
        value("max_contacts", INTEGER, "the maximum number of contact points between two shapes", default="20"),
        value("gravity", VECTOR3, "the gravity, up to SDF 1.5", "m/s2"),
    ),
    is_repeated=True,
    make=Physics,
    keeps_element=True,
    passes_element=True,
)
