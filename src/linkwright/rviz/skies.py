"""Conversion of the sky and the fog of a world to the page's form."""

from __future__ import annotations

from math import isfinite

from linkwright.page.protocol.worlds import FogScene
from linkwright.sdf.skies import Fog, Sky

_TWILIGHT = 1.0
"""Hours between bright and dark."""


def daylight(sky: Sky | None) -> float | None:
    """Return the brightness of a sky, from 0 at night to 1, or None if there is no sky."""
    if sky is None:
        return None
    time = sky.time % 24.0
    risen, left = (time - sky.sunrise) / _TWILIGHT, (sky.sunset - time) / _TWILIGHT
    return max(0.0, min(1.0, risen + 0.5, left + 0.5))


def fog_of(fog: Fog | None) -> FogScene | None:
    """Return the fog in the page's form, or None if there is no fog."""
    if fog is None or fog.type.strip() in ("", "none") or not all(map(isfinite, (fog.start, fog.end, fog.density))):
        return None
    density = None if fog.type.strip() == "linear" else max(fog.density, 0.0)
    return FogScene(list(fog.color[:3]), fog.start, max(fog.end, fog.start), density)
