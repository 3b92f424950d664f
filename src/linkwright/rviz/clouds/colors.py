"""RViz's color transformers: selection by the fields of a cloud, and point colors."""

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

_MAX_INTENSITY = 999999.0
"""The largest absolute intensity that RViz uses as a computed bound."""

_RAINBOW_STEPS = 5 * 255
"""The number of steps of the rainbow from magenta to red, along five edges of the color cube."""

_MIX_STEPS = 255

Colors = NDArray[np.uint8]
"""Shape (N, 4): red, green, blue, alpha. It has no rows if all points have the color of the display."""


@dataclass(frozen=True, slots=True)
class ColorSettings:
    """The settings of the color transformers.

    Colors are RGB, 0 to 255.

    Attributes:
        transformer: one of `TRANSFORMERS`.
        channel: the name of the channel that ``Intensity`` uses.
        rainbow: whether ``Intensity`` uses the rainbow instead of a gradient from `darkest` to `brightest`.
        inverted: whether the rainbow of ``Intensity`` is reversed.
        darkest: the color of the minimum intensity.
        brightest: the color of the maximum intensity.
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


def find_supported_transformers(points: Points) -> tuple[str, ...]:
    """Return the transformers that can color these points.

    The transformer that RViz selects by default is the first.
    """
    transformers = [INTENSITY, AXIS, FLAT]
    if packed := _find_packed_channel(points):
        values = points.channels[packed]
        if values.dtype.kind + str(values.dtype.itemsize) in ("i4", "u4", "f4"):
            transformers.insert(0, RGB8)
    parts = [points.channels.get(name) for name in "rgb"]
    if all(channel is not None for channel in parts) and parts[0] is not None and parts[0].dtype.str[1:] == "f4":
        transformers.append(RGBF32)
    return tuple(transformers)


def compute_colors(
    points: Points, settings: ColorSettings, pose: NDArray[np.float64] | None = None
) -> tuple[Colors, tuple[float, float] | None]:
    """Return the colors of the points, and the computed bounds or None.

    With ``FlatColor`` the colors have no rows, because all points have the color of the display. Bounds are the
    minimum and maximum of the intensity or coordinate. They are computed if the settings do not contain them.

    Args:
        points: the points.
        settings: the color settings; the points must support the transformer.
        pose: the pose of the points' frame in the Fixed Frame, x y z qx qy qz qw; None if the points are in the Fixed
            Frame.
    """
    if settings.transformer == INTENSITY:
        return _color_by_intensity(points, settings)
    if settings.transformer == AXIS:
        return _color_by_axis(points, settings, pose)
    if settings.transformer == RGB8:
        return _unpack_colors(points), None
    if settings.transformer == RGBF32:
        parts = [np.clip(np.nan_to_num(points.channels[name]), 0.0, 1.0) * 255.0 for name in "rgb"]
        colors = np.full((len(points), 4), 255, np.uint8)
        colors[:, :3] = np.stack(parts, axis=1)
        return colors, None
    return np.empty((0, 4), np.uint8), None


def _color_by_intensity(points: Points, settings: ColorSettings) -> tuple[Colors, tuple[float, float] | None]:
    values = points.values(settings.channel)
    if values is None and settings.channel == "intensity":
        values = points.values("intensities")
    if values is None:  # white, as in RViz when the channel is missing
        return np.full((len(points), 4), 255, np.uint8), None
    computed_bounds = None
    if settings.intensities is None:
        computed_bounds = _find_bounds(values, _MAX_INTENSITY)
    minimum, maximum = computed_bounds or settings.intensities or (0.0, 0.0)
    span = maximum - minimum or 1e20
    if settings.rainbow:
        table = make_rainbow()[::-1] if not settings.inverted else make_rainbow()
    else:
        table = _make_two_color_gradient(settings.darkest, settings.brightest)
    return _colors_from_table(table, values, minimum, span), computed_bounds


def _color_by_axis(
    points: Points, settings: ColorSettings, pose: NDArray[np.float64] | None
) -> tuple[Colors, tuple[float, float] | None]:
    if settings.in_fixed_frame and pose is not None:
        row = rotation_matrix(normalized(*pose[3:]))[settings.axis].astype(np.float32)
        values = points.positions @ row + np.float32(pose[settings.axis])
    else:
        values = points.positions[:, settings.axis]
    computed_bounds = None
    if settings.values is None:
        computed_bounds = _find_bounds(values, 9999.0)
    minimum, maximum = computed_bounds or settings.values or (0.0, 0.0)
    return _colors_from_table(make_rainbow()[::-1], values, minimum, maximum - minimum or 0.001), computed_bounds


def _find_bounds(values: NDArray[Any], limit: float) -> tuple[float, float]:
    """Return the minimum and maximum of the finite values, clipped to ±`limit`.

    Both are 0 if no value is finite.
    """
    if values.size == 0:
        return 0.0, 0.0
    minimum, maximum = float(values.min()), float(values.max())
    if not np.isfinite(minimum + maximum):
        finite = values[np.isfinite(values)]
        if finite.size == 0:
            return 0.0, 0.0
        minimum, maximum = float(finite.min()), float(finite.max())
    return max(-limit, minimum), min(limit, maximum)


def _colors_from_table(table: NDArray[np.uint32], values: NDArray[Any], minimum: float, span: float) -> Colors:
    steps = len(table) - 1
    with np.errstate(all="ignore"):
        index = values.astype(np.float32) if values.dtype != np.float32 else values
        index = (index - np.float32(minimum)) * np.float32(steps / span)
        index += np.float32(0.5)
        np.nan_to_num(index, copy=False, nan=0.0, posinf=steps, neginf=0.0)
    np.clip(index, 0, steps, out=index)
    colors: Colors = table[index.astype(np.intp)].view(np.uint8).reshape(-1, 4)
    return colors


@cache
def make_rainbow() -> NDArray[np.uint32]:
    """Return RViz's rainbow as packed colors, from magenta at 0 through blue to red."""
    corners = np.array([(1, 0, 1), (0, 0, 1), (0, 1, 1), (0, 1, 0), (1, 1, 0), (1, 0, 0)]) * 255.0
    return _make_gradient(corners, _RAINBOW_STEPS)


def _make_two_color_gradient(darkest: tuple[int, int, int], brightest: tuple[int, int, int]) -> NDArray[np.uint32]:
    return _make_gradient(np.array([darkest, brightest], dtype=np.float64), _MIX_STEPS)


def _make_gradient(corners: NDArray[np.float64], steps: int) -> NDArray[np.uint32]:
    """Return a table of opaque packed colors, interpolated evenly between corner colors."""
    positions = np.linspace(0, len(corners) - 1, steps + 1)
    table = np.full((steps + 1, 4), 255, np.uint8)
    for channel in range(3):
        table[:, channel] = np.rint(np.interp(positions, np.arange(len(corners)), corners[:, channel]))
    packed: NDArray[np.uint32] = table.view(np.uint32).ravel()
    return packed


def _find_packed_channel(points: Points) -> str | None:
    """Return the last channel named ``rgb`` or ``rgba``, as in RViz, or None if there is none."""
    return next((name for name in reversed(list(points.channels)) if name in ("rgb", "rgba")), None)


def _unpack_colors(points: Points) -> Colors:
    """Return the packed colors of the points as red, green, blue and alpha, shape (N, 4).

    The channel is ``rgb``, or ``rgba`` if there is no ``rgb``.

    From the lowest byte, a packed value consists of blue, green, red and alpha. The alpha of ``rgb`` is ignored.
    """
    name = "rgb" if "rgb" in points.channels else "rgba"
    values = points.channels[name]
    packed = np.ascontiguousarray(values.astype(values.dtype.newbyteorder("<"))).view(np.uint8).reshape(-1, 4)
    colors: Colors = packed[:, [2, 1, 0, 3]]
    if name == "rgb":
        colors[:, 3] = 255
    return colors
