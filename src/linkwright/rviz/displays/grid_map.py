"""The display grid_map_rviz_plugin/GridMap."""

from __future__ import annotations

import colorsys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import foreign, phrase, quoted_names
from linkwright.geometry.arrays import rotate
from linkwright.page.protocol.geometry import GridSurface
from linkwright.page.protocol.message import DataContent
from linkwright.rviz.config.schema import Path, PropertySpec, Schema, alpha, topic_spec
from linkwright.rviz.displays.base.topic_display import RecentDisplay

_LAYER = "GridMapLayer"
_HEIGHTS = (_LAYER, "Layer", "Flat")
_COLORS = (_LAYER, "IntensityLayer", "ColorLayer", "FlatColor", "None")
"""RViz starts with the first one and writes it until it is changed, but does not offer it; it means the second."""

_MOST_CELLS = 400_000
"""The largest number of cells drawn; rows and columns of larger maps are skipped."""

_SIZE = "Size"


class BadGridError(ValueError):
    """Raised when a grid map cannot be drawn; the message gives the reason."""


class GridMapDisplay(RecentDisplay):
    """A display of the last grid maps of a topic as surfaces.

    One layer sets the heights, another the colours.
    """

    CLASS = "grid_map_rviz_plugin/GridMap"
    MESSAGE = "grid_map_msgs/msg/GridMap"
    LENGTH = ("History Length",)

    def schema(self) -> Schema:
        """Return the properties, named as in the plugin version that wrote the file.

        Newer versions of the plugin write *ColorMap* instead of *Rainbow*.
        """
        word = "ColorMap" if self.config.section.scalar("Use ColorMap") else "Rainbow"
        return (
            topic_spec(description=self.MESSAGE, filter_size=10),
            alpha("Opacity of the surface."),
            PropertySpec("History Length", "int", 1, "The number of maps that are shown.", minimum=1, maximum=100),
            PropertySpec("Show Grid Lines", "bool", True, "Draw lines between the centres of cells."),
            PropertySpec(
                "Height Transformer", "enum", _LAYER, "The source of the heights: a layer, or none.", options=_HEIGHTS
            ),
            PropertySpec("Height Layer", "string", "elevation", "The layer that contains the heights."),
            PropertySpec(
                "Color Transformer",
                "enum",
                _LAYER,
                "The source of the colours: the values of a layer, the colours of a layer, one colour; or no surface.",
                options=_COLORS,
            ),
            PropertySpec("Color Layer", "string", "elevation", "The layer that contains the colours."),
            PropertySpec(
                "Color", "color", "#c8c8c8", "The colour of the surface.", when=(("Color Transformer",), "FlatColor")
            ),
            PropertySpec(f"Use {word}", "bool", True, "Use the colours of the rainbow for values."),
            PropertySpec(f"Invert {word}", "bool", False, "Reverse the rainbow.", when=((f"Use {word}",), True)),
            PropertySpec(
                "Min Color", "color", "#000000", "The colour of the minimum value.", when=((f"Use {word}",), False)
            ),
            PropertySpec(
                "Max Color", "color", "#ffffff", "The colour of the maximum value.", when=((f"Use {word}",), False)
            ),
            PropertySpec(
                "Autocompute Intensity Bounds", "bool", True, "Use the minimum and maximum value of the layer."
            ),
            PropertySpec(
                "Min Intensity",
                "float",
                0.0,
                "The value that is shown in the colour of the minimum.",
                when=(("Autocompute Intensity Bounds",), False),
            ),
            PropertySpec(
                "Max Intensity",
                "float",
                10.0,
                "The value that is shown in the colour of the maximum.",
                when=(("Autocompute Intensity Bounds",), False),
            ),
        )

    def content(self, message: Any) -> DataContent | None:
        """Return the surface of a grid map, or None if the map cannot be drawn."""
        try:
            made = self._surface(message)
        except BadGridError as error:
            self.refuse(foreign(error))
            return None
        self.accept()
        return made

    def changed(self, path: Path) -> None:
        """Redraw the last map, unless the page applies the changed property itself."""
        super().changed(path)
        if path[0] not in ("Topic", "Alpha", "Show Grid Lines", "History Length"):
            self.reset()
            self.show_again()

    def _surface(self, message: Any) -> GridSurface:
        properties = self.properties
        grid = _Grid(message)
        is_flat = properties.text("Height Transformer") == "Flat"
        heights = np.zeros(grid.shape, dtype=np.float32) if is_flat else grid.layer(properties.text("Height Layer"))
        valid = np.isfinite(heights)
        for name in message.basic_layers:
            valid &= np.isfinite(grid.layer(name))
        colors = np.zeros((*grid.shape, 4), dtype=np.uint8)
        colors[..., :3] = self._colors(grid)
        colors[..., 3] = np.where(valid, 255, 0)
        step = 1
        while -(-grid.shape[0] // step) * -(-grid.shape[1] // step) > _MOST_CELLS:
            step += 1
        if step > 1:
            self.set_status_row(
                _SIZE, "warn", phrase("The map is large: 1 in {step} rows and columns is drawn", step=step)
            )
        else:
            self.delete_status_row(_SIZE)
        points = grid.points(np.where(valid, heights, 0.0))[::step, ::step]
        return GridSurface(
            points.shape[0],
            points.shape[1],
            np.ascontiguousarray(points, dtype=np.float32).reshape(-1, 3),
            np.ascontiguousarray(colors[::step, ::step]).reshape(-1, 4),
            properties.text("Color Transformer") != "None",
        )

    def _colors(self, grid: _Grid) -> NDArray[np.uint8]:
        """Return the RGB colour of each cell, shape (rows, columns, 3), or one colour, shape (3,)."""
        properties = self.properties
        transformer = properties.text("Color Transformer")
        if transformer in ("FlatColor", "None"):
            return _rgb(properties.text("Color"))
        values = grid.layer(properties.text("Color Layer"))
        if transformer == "ColorLayer":
            bits = values.view(np.uint32)
            return np.stack([bits >> shift & 255 for shift in (16, 8, 0)], axis=-1).astype(np.uint8)
        finite = values[np.isfinite(values)]
        if properties.flag("Autocompute Intensity Bounds"):
            least, most = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
        else:
            least, most = properties.number("Min Intensity"), properties.number("Max Intensity")
        span = most - least
        share = np.zeros_like(values) if span == 0.0 else np.clip((np.nan_to_num(values) - least) / span, 0.0, 1.0)
        word = "ColorMap" if self.config.section.scalar("Use ColorMap") else "Rainbow"
        if not properties.flag(f"Use {word}"):
            low, high = _rgb(properties.text("Min Color")), _rgb(properties.text("Max Color"))
            mixed = low + share[..., None] * (high.astype(np.float32) - low)
            return np.rint(mixed).astype(np.uint8)
        if properties.flag(f"Invert {word}"):
            share = 1.0 - share
        return _RAINBOW[(share * (len(_RAINBOW) - 1)).astype(np.intp)]


_RAINBOW = np.array(
    [[255 * part for part in colorsys.hsv_to_rgb(0.8 * (1.0 - step / 255.0), 1.0, 1.0)] for step in range(256)]
).astype(np.uint8)
"""The colours from violet to red."""


def _rgb(text: str) -> NDArray[np.uint8]:
    return np.array([int(text[start : start + 2], 16) for start in (1, 3, 5)], dtype=np.uint8)


class _Grid:
    """The cells of a grid_map_msgs/msg/GridMap.

    Row 0 has the largest x, and column 0 the largest y.

    Raises:
        BadGridError: the resolution, the lengths or the pose are not valid, or the numbers of layers and data differ.
    """

    def __init__(self, message: Any) -> None:
        info = message.info
        at = info.pose.position
        self._message = message
        self._middle = np.array([at.x, at.y, at.z])
        turn = info.pose.orientation
        self._turn = np.array([turn.x, turn.y, turn.z, turn.w])
        self._resolution = float(info.resolution)
        numbers = (info.resolution, info.length_x, info.length_y, *self._middle, *self._turn)
        if not np.isfinite(numbers).all() or info.resolution <= 0.0:
            raise BadGridError(phrase("The resolution, lengths or pose of the map are not valid"))
        self.shape = (round(info.length_x / info.resolution), round(info.length_y / info.resolution))
        if min(self.shape) < 1:
            raise BadGridError(
                phrase("The map has {rows} x {columns} cells", rows=self.shape[0], columns=self.shape[1])
            )
        if len(message.layers) != len(message.data):
            raise BadGridError(
                phrase(
                    "The map has {layers} layers, but data for {data}",
                    layers=len(message.layers),
                    data=len(message.data),
                )
            )

    def layer(self, name: str) -> NDArray[np.float32]:
        """Return the values of a layer, shape (rows, columns); cells without a value are not finite.

        Raises:
            BadGridError: there is no such layer, or it does not have one number for each cell.
        """
        names = list(self._message.layers)
        if name not in names:
            known = quoted_names(names) if names else phrase("none")
            raise BadGridError(phrase("The map has no layer '{name}'; its layers: {known}", name=name, known=known))
        array = self._message.data[names.index(name)]
        numbers = np.asarray(array.data, dtype=np.float32)
        rows, columns = self.shape
        if len(numbers) != rows * columns:
            raise BadGridError(
                phrase(
                    "Layer '{name}' has {numbers} numbers for {rows} x {columns} cells",
                    name=name,
                    numbers=len(numbers),
                    rows=rows,
                    columns=columns,
                )
            )
        by_rows = bool(array.layout.dim) and array.layout.dim[0].label == "row_index"
        cells = numbers.reshape(rows, columns) if by_rows else numbers.reshape(columns, rows).T
        begin = (-int(self._message.outer_start_index), -int(self._message.inner_start_index))
        return np.ascontiguousarray(np.roll(cells, begin, axis=(0, 1)))

    def points(self, heights: NDArray[np.floating[Any]]) -> NDArray[np.float64]:
        """Return the cell centres at the given heights, in the message's frame.

        The heights are in metres and relative to the map's pose. The result has the shape (rows, columns, 3).
        """
        rows, columns = self.shape
        along = (rows / 2.0 - 0.5 - np.arange(rows)) * self._resolution
        across = (columns / 2.0 - 0.5 - np.arange(columns)) * self._resolution
        points = np.empty((rows, columns, 3))
        points[..., 0], points[..., 1], points[..., 2] = along[:, None], across[None, :], heights
        if self._turn.any():
            points = rotate(self._turn / np.linalg.norm(self._turn), points)
        points += self._middle
        return points
