"""The elements ``<sky>`` and ``<fog>`` of a scene.

Source of the elements and defaults: the SDFormat specification 1.12, ``scene.sdf``.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from linkwright.sdf.values import COLOR, NUMBER, TEXT, Color, object_rule, value
from linkwright.xmltree import Element


@dataclass(frozen=True, slots=True)
class Sky:
    """A sky with the time of day, sunrise and sunset, in hours from 0 to 24."""

    time: float = 10.0
    sunrise: float = 6.0
    sunset: float = 20.0
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Fog:
    """Fog in a scene.

    Attributes:
        color: the color of the fog.
        type: ``none``; ``linear`` for fog from `start` to `end`; or ``constant`` or ``quadratic`` for fog by `density`,
            which Gazebo calls ``exp`` and ``exp2``.
        start: the distance in m at which linear fog begins.
        end: the distance in m beyond which linear fog hides everything.
        density: the density in 1/m.
    """

    color: Color = (1.0, 1.0, 1.0, 1.0)
    type: str = "none"
    start: float = 1.0
    end: float = 100.0
    density: float = 1.0


SKY = object_rule(
    Sky,
    "sky",
    "a sky instead of the background",
    value("time", NUMBER, "the time of day", "h", default="10"),
    value("sunrise", NUMBER, "the time of sunrise", "h", default="6"),
    value("sunset", NUMBER, "the time of sunset", "h", default="20"),
    passes_element=True,
)
FOG = object_rule(
    Fog,
    "fog",
    "fog",
    value("color", COLOR, "the color", default="1 1 1 1"),
    value("type", TEXT, "the type: none, linear, constant or quadratic", default="none"),
    value("start", NUMBER, "the distance at which linear fog begins", "m", default="1"),
    value("end", NUMBER, "the distance beyond which linear fog hides everything", "m", default="100"),
    value("density", NUMBER, "the density, unless the fog is linear", "1/m", default="1"),
)
