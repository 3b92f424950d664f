"""Convert the message about the surface of the water to the page's form."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.page.protocol.worlds import WorldWater

_HEADER_SIZE, _WAVE_SIZE = 2, 6


def convert_water(message: Any) -> WorldWater | None:
    """Return the surface of the water, or None if the message describes none.

    Args:
        message: the ``std_msgs/msg/Float64MultiArray`` that the simulator publishes on ``/world_water``.
    """
    values = np.asarray(message.data, dtype=np.float64)
    wave_values_count = values.size - _HEADER_SIZE
    if wave_values_count < 0 or wave_values_count % _WAVE_SIZE or not np.isfinite(values).all():
        return None
    level, growth_time, *waves = values.tolist()
    return WorldWater(level, growth_time, waves)
