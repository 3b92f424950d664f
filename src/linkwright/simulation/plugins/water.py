"""The surface of the water on which plugins float bodies, for drawing it.

The simulator publishes it as ``std_msgs/msg/Float64MultiArray``: the level and the time constant of the growth, then
a row for each wave.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.messages import get_message

WATER_TOPIC = "/world_water"
WATER_TYPE = "std_msgs/msg/Float64MultiArray"
_WAVE_SIZE = 6


@dataclass(frozen=True, slots=True)
class WaterSurface:
    """The surface of the water.

    Attributes:
        level: the height of calm water in the world, in m.
        growth_time: the time constant in s with which the waves grow from the simulated time 0; 0 for grown waves.
        waves: the Gerstner waves: amplitude in m, angular frequency in rad/s, wavenumber in rad/m, steepness from 0
            to 1, and x and y of the direction.
    """

    level: float
    growth_time: float = 0.0
    waves: tuple[tuple[float, float, float, float, float, float], ...] = ()


def create_water_message(water: WaterSurface | None) -> Any:
    """Return the message that describes the surface of the water, or, without data, that there is none."""
    if water is None:
        return get_message(WATER_TYPE)()
    dimension_class = get_message("std_msgs/msg/MultiArrayDimension")
    count = len(water.waves)
    layout = get_message("std_msgs/msg/MultiArrayLayout")(
        dim=[
            dimension_class(label="waves", size=count, stride=count * _WAVE_SIZE),
            dimension_class(label="values", size=_WAVE_SIZE, stride=_WAVE_SIZE),
        ],
        data_offset=2,
    )
    values = [water.level, water.growth_time, *(value for wave in water.waves for value in wave)]
    return get_message(WATER_TYPE)(layout=layout, data=values)
