"""Convert the sky and the fog of a world to the page's form."""

from __future__ import annotations

from math import isfinite

from linkwright.page.protocol.worlds import FogScene
from linkwright.sdf.skies import Fog, Sky

_TWILIGHT_HOURS = 1.0
"""The duration of dawn and of dusk, in hours."""


def compute_daylight(sky: Sky | None) -> float | None:
    """Return the brightness of a sky, from 0 at night to 1, or None if there is no sky."""
    if sky is None:
        return None
    hour = sky.time % 24.0
    hours_since_sunrise, hours_to_sunset = (hour - sky.sunrise) / _TWILIGHT_HOURS, (sky.sunset - hour) / _TWILIGHT_HOURS
    return max(0.0, min(1.0, hours_since_sunrise + 0.5, hours_to_sunset + 0.5))


def convert_fog(fog: Fog | None) -> FogScene | None:
    """Return the fog in the page's form, or None if there is no fog."""
    if fog is None or fog.type.strip() in ("", "none") or not all(map(isfinite, (fog.start, fog.end, fog.density))):
        return None
    density = None if fog.type.strip() == "linear" else max(fog.density, 0.0)
    return FogScene(list(fog.color[:3]), fog.start, max(fog.end, fog.start), density)
