"""RViz's colour transformers: which ones a cloud supports, and how they colour its points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import rotation_matrix
from linkwright.geometry.single import normalized
from linkwright.rviz.clouds.points import Points

INTENSITY, AXIS, FLAT, RGB8, RGBF32 = TRANSFORMERS = ("Intensity", "AxisColor", "FlatColor", "RGB8", "RGBF32")
AXES = ("X", "Y", "Z")

_LARGEST_INTENSITY = 999999.0
"""The limit of RViz's computed bounds."""

_RAINBOW_STEPS = 5 * 255
"""Steps of the rainbow from magenta to red, along five edges of the colour cube."""

_MIX_STEPS = 255

Colours = NDArray[np.uint8]
"""Shape (N, 4): red, green, blue, alpha. Without rows if all points have the display's one colour."""


@dataclass(frozen=True, slots=True)
class ColourSettings:
    """The settings of the colour transformers. Colours are RGB, 0 to 255.

    Attributes:
        transformer: one of `TRANSFORMERS`.
        channel: the name of the channel that ``Intensity`` uses.
        rainbow: whether ``Intensity`` uses the rainbow instead of a gradient from `darkest` to `brightest`.
        inverted: whether the rainbow of ``Intensity`` is reversed.
        darkest: the colour of the minimum intensity.
        brightest: the colour of the maximum intensity.
        intensities: minimum and maximum intensity, or None to compute them from the cloud.
        axis: the axis of ``AxisColor``, an index of `AXES`.
        values: minimum and maximum coordinate, or None to compute them from the cloud.
        in_fixed_frame: whether ``AxisColor`` uses coordinates in the Fixed Frame.
    """

    transformer: str = INTENSITY
    channel: str = "intensity"
    rainbow: bool = True
    inverted: bool = False
    darkest: tuple[int, int, int] = (0, 0, 0)
    brightest: tuple[int, int, int] = (255, 255, 255)
    intensities: tuple[float, float] | None = None
    axis: int = 2
    values: tuple[float, float] | None = None
    in_fixed_frame: bool = True


def supported_transformers(points: Points) -> tuple[str, ...]:
    """Return the transformers that can colour these points, with RViz's own choice first."""
    found = [INTENSITY, AXIS, FLAT]
    if packed := _packed_channel(points):
        values = points.channels[packed]
        if values.dtype.kind + str(values.dtype.itemsize) in ("i4", "u4", "f4"):
            found.insert(0, RGB8)
    parts = [points.channels.get(name) for name in "rgb"]
    if all(part is not None for part in parts) and parts[0] is not None and parts[0].dtype.str[1:] == "f4":
        found.append(RGBF32)
    return tuple(found)


def coloured(
    points: Points, settings: ColourSettings, pose: NDArray[np.float64] | None = None
) -> tuple[Colours, tuple[float, float] | None]:
    """Return the colours of the points, and the computed bounds, or None if none were computed.

    The colours have no rows for ``FlatColor``, where all points have the display's colour. Bounds are the minimum and
    maximum of the intensity or coordinate; they are computed unless the settings have them.

    Args:
        points: the points.
        settings: the colour settings; the points must support the transformer.
        pose: the pose of the points' frame in the Fixed Frame, x y z qx qy qz qw; None if the points are in the Fixed
            Frame.
    """
    if settings.transformer == INTENSITY:
        return _colour_by_intensity(points, settings)
    if settings.transformer == AXIS:
        return _colour_by_axis(points, settings, pose)
    if settings.transformer == RGB8:
        return _unpacked(points), None
    if settings.transformer == RGBF32:
        parts = [np.clip(np.nan_to_num(points.channels[name]), 0.0, 1.0) * 255.0 for name in "rgb"]
        colours = np.full((len(points), 4), 255, np.uint8)
        colours[:, :3] = np.stack(parts, axis=1)
        return colours, None
    return np.empty((0, 4), np.uint8), None


def _colour_by_intensity(points: Points, settings: ColourSettings) -> tuple[Colours, tuple[float, float] | None]:
    values = points.values(settings.channel)
    if values is None and settings.channel == "intensity":
        values = points.values("intensities")
    if values is None:  # white, as in RViz when the channel is missing
        return np.full((len(points), 4), 255, np.uint8), None
    computed = None
    if settings.intensities is None:
        computed = _bounds(values, _LARGEST_INTENSITY)
    least, largest = computed or settings.intensities or (0.0, 0.0)
    span = largest - least or 1e20
    if settings.rainbow:
        table = rainbow()[::-1] if not settings.inverted else rainbow()
    else:
        table = _mixed(settings.darkest, settings.brightest)
    return _colours_from_table(table, values, least, span), computed


def _colour_by_axis(
    points: Points, settings: ColourSettings, pose: NDArray[np.float64] | None
) -> tuple[Colours, tuple[float, float] | None]:
    if settings.in_fixed_frame and pose is not None:
        row = rotation_matrix(normalized(*pose[3:]))[settings.axis].astype(np.float32)
        values = points.positions @ row + np.float32(pose[settings.axis])
    else:
        values = points.positions[:, settings.axis]
    computed = None
    if settings.values is None:
        computed = _bounds(values, 9999.0)
    least, largest = computed or settings.values or (0.0, 0.0)
    return _colours_from_table(rainbow()[::-1], values, least, largest - least or 0.001), computed


def _bounds(values: NDArray[Any], limit: float) -> tuple[float, float]:
    """Return the minimum and maximum of the finite values within ±`limit`; 0 and 0 if none is finite."""
    if values.size == 0:
        return 0.0, 0.0
    least, largest = float(values.min()), float(values.max())
    if not np.isfinite(least + largest):
        finite = values[np.isfinite(values)]
        if finite.size == 0:
            return 0.0, 0.0
        least, largest = float(finite.min()), float(finite.max())
    return max(-limit, least), min(limit, largest)


def _colours_from_table(table: NDArray[np.uint32], values: NDArray[Any], least: float, span: float) -> Colours:
    steps = len(table) - 1
    with np.errstate(all="ignore"):
        place = values.astype(np.float32) if values.dtype != np.float32 else values
        place = (place - np.float32(least)) * np.float32(steps / span)
        place += np.float32(0.5)
        np.nan_to_num(place, copy=False, nan=0.0, posinf=steps, neginf=0.0)
    np.clip(place, 0, steps, out=place)
    colours: Colours = table[place.astype(np.intp)].view(np.uint8).reshape(-1, 4)
    return colours


@cache
def rainbow() -> NDArray[np.uint32]:
    """Return RViz's rainbow as packed colours: magenta at 0, then blue, cyan, green, yellow, red."""
    corners = np.array([(1, 0, 1), (0, 0, 1), (0, 1, 1), (0, 1, 0), (1, 1, 0), (1, 0, 0)]) * 255.0
    return _gradient(corners, _RAINBOW_STEPS)


def _mixed(darkest: tuple[int, int, int], brightest: tuple[int, int, int]) -> NDArray[np.uint32]:
    return _gradient(np.array([darkest, brightest], dtype=np.float64), _MIX_STEPS)


def _gradient(corners: NDArray[np.float64], steps: int) -> NDArray[np.uint32]:
    """Return a table of packed colours, interpolated evenly between corners, opaque."""
    places = np.linspace(0, len(corners) - 1, steps + 1)
    table = np.full((steps + 1, 4), 255, np.uint8)
    for part in range(3):
        table[:, part] = np.rint(np.interp(places, np.arange(len(corners)), corners[:, part]))
    packed: NDArray[np.uint32] = table.view(np.uint32).ravel()
    return packed


def _packed_channel(points: Points) -> str | None:
    """Return ``rgb`` or ``rgba``, whichever the cloud has; the later of both, as in RViz; or None."""
    return next((name for name in reversed(list(points.channels)) if name in ("rgb", "rgba")), None)


def _unpacked(points: Points) -> Colours:
    """Return the colours of the channel ``rgb`` or else ``rgba``, as red, green, blue, alpha.

    From the lowest byte, a packed value consists of blue, green, red and alpha. The alpha of ``rgb`` is ignored.
    """
    name = "rgb" if "rgb" in points.channels else "rgba"
    values = points.channels[name]
    packed = np.ascontiguousarray(values.astype(values.dtype.newbyteorder("<"))).view(np.uint8).reshape(-1, 4)
    colours: Colours = packed[:, [2, 1, 0, 3]]
    if name == "rgb":
        colours[:, 3] = 255
    return colours
