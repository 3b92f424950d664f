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

_LAYER_MODE = "GridMapLayer"
_HEIGHT_MODES = (_LAYER_MODE, "Layer", "Flat")
_COLOR_MODES = (_LAYER_MODE, "IntensityLayer", "ColorLayer", "FlatColor", "None")
"""The first option is RViz's initial value. It means the same as the second option, and RViz does not offer it."""

_MAX_CELLS = 400_000
"""The largest number of cells that are drawn. Some rows and columns of larger maps are skipped."""

_SIZE_ROW = "Size"


class BadGridError(ValueError):
    """Raised when a grid map cannot be drawn.

    The message gives the reason.
    """


class GridMapDisplay(RecentDisplay):
    """A display of the last grid maps of a topic as surfaces.

    One layer sets the heights, another the colors.
    """

    CLASS = "grid_map_rviz_plugin/GridMap"
    MESSAGE = "grid_map_msgs/msg/GridMap"
    LENGTH = ("History Length",)

    def schema(self) -> Schema:
        """Return the properties, named as in the plugin version that wrote the file.

        Newer versions of the plugin write *ColorMap* instead of *Rainbow*.
        """
        rainbow_word = "ColorMap" if self.config.section.scalar("Use ColorMap") else "Rainbow"
        return (
            topic_spec(description=self.MESSAGE, filter_size=10),
            alpha("Opacity of the surface."),
            PropertySpec("History Length", "int", 1, "The number of maps that are shown.", minimum=1, maximum=100),
            PropertySpec("Show Grid Lines", "bool", True, "Draw lines between the centers of cells."),
            PropertySpec(
                "Height Transformer",
                "enum",
                _LAYER_MODE,
                "The source of the heights: a layer, or none.",
                options=_HEIGHT_MODES,
            ),
            PropertySpec("Height Layer", "string", "elevation", "The layer that contains the heights."),
            PropertySpec(
                "Color Transformer",
                "enum",
                _LAYER_MODE,
                "The source of the colors: the values of a layer, the colors of a layer, one color; or no surface.",
                options=_COLOR_MODES,
            ),
            PropertySpec("Color Layer", "string", "elevation", "The layer that contains the colors."),
            PropertySpec(
                "Color", "color", "#c8c8c8", "The color of the surface.", when=(("Color Transformer",), "FlatColor")
            ),
            PropertySpec(f"Use {rainbow_word}", "bool", True, "Use the colors of the rainbow for values."),
            PropertySpec(
                f"Invert {rainbow_word}", "bool", False, "Reverse the rainbow.", when=((f"Use {rainbow_word}",), True)
            ),
            PropertySpec(
                "Min Color",
                "color",
                "#000000",
                "The color of the minimum value.",
                when=((f"Use {rainbow_word}",), False),
            ),
            PropertySpec(
                "Max Color",
                "color",
                "#ffffff",
                "The color of the maximum value.",
                when=((f"Use {rainbow_word}",), False),
            ),
            PropertySpec(
                "Autocompute Intensity Bounds", "bool", True, "Use the minimum and maximum value of the layer."
            ),
            PropertySpec(
                "Min Intensity",
                "float",
                0.0,
                "The value that is shown in the color of the minimum.",
                when=(("Autocompute Intensity Bounds",), False),
            ),
            PropertySpec(
                "Max Intensity",
                "float",
                10.0,
                "The value that is shown in the color of the maximum.",
                when=(("Autocompute Intensity Bounds",), False),
            ),
        )

    def content(self, message: Any) -> DataContent | None:
        """Return the surface of a grid map, or None if the map cannot be drawn."""
        try:
            surface = self._make_surface(message)
        except BadGridError as error:
            self.refuse(foreign(error))
            return None
        self.accept()
        return surface

    def on_property_changed(self, path: Path) -> None:
        """Redraw the last map, unless the page applies the changed property itself."""
        super().on_property_changed(path)
        if path[0] not in ("Topic", "Alpha", "Show Grid Lines", "History Length"):
            self.reset()
            self.show_again()

    def _make_surface(self, message: Any) -> GridSurface:
        properties = self.properties
        grid = _Grid(message)
        is_flat = properties.text("Height Transformer") == "Flat"
        heights = np.zeros(grid.shape, dtype=np.float32) if is_flat else grid.layer(properties.text("Height Layer"))
        valid = np.isfinite(heights)
        for name in message.basic_layers:
            valid &= np.isfinite(grid.layer(name))
        colors = np.zeros((*grid.shape, 4), dtype=np.uint8)
        colors[..., :3] = self._compute_colors(grid)
        colors[..., 3] = np.where(valid, 255, 0)
        step = 1
        while -(-grid.shape[0] // step) * -(-grid.shape[1] // step) > _MAX_CELLS:
            step += 1
        if step > 1:
            self.set_status_row(
                _SIZE_ROW, "warn", phrase("The map is large: 1 in {step} rows and columns is drawn", step=step)
            )
        else:
            self.delete_status_row(_SIZE_ROW)
        points = grid.points(np.where(valid, heights, 0.0))[::step, ::step]
        return GridSurface(
            points.shape[0],
            points.shape[1],
            np.ascontiguousarray(points, dtype=np.float32).reshape(-1, 3),
            np.ascontiguousarray(colors[::step, ::step]).reshape(-1, 4),
            properties.text("Color Transformer") != "None",
        )

    def _compute_colors(self, grid: _Grid) -> NDArray[np.uint8]:
        """Return the RGB color of each cell, shape (rows, columns, 3), or one color, shape (3,)."""
        properties = self.properties
        transformer = properties.text("Color Transformer")
        if transformer in ("FlatColor", "None"):
            return _parse_rgb(properties.text("Color"))
        values = grid.layer(properties.text("Color Layer"))
        if transformer == "ColorLayer":
            bits = values.view(np.uint32)
            return np.stack([bits >> shift & 255 for shift in (16, 8, 0)], axis=-1).astype(np.uint8)
        finite = values[np.isfinite(values)]
        if properties.flag("Autocompute Intensity Bounds"):
            minimum, maximum = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
        else:
            minimum, maximum = properties.number("Min Intensity"), properties.number("Max Intensity")
        span = maximum - minimum
        fractions = (
            np.zeros_like(values) if span == 0.0 else np.clip((np.nan_to_num(values) - minimum) / span, 0.0, 1.0)
        )
        rainbow_word = "ColorMap" if self.config.section.scalar("Use ColorMap") else "Rainbow"
        if not properties.flag(f"Use {rainbow_word}"):
            low, high = _parse_rgb(properties.text("Min Color")), _parse_rgb(properties.text("Max Color"))
            colors = low + fractions[..., None] * (high.astype(np.float32) - low)
            return np.rint(colors).astype(np.uint8)
        if properties.flag(f"Invert {rainbow_word}"):
            fractions = 1.0 - fractions
        return _RAINBOW[(fractions * (len(_RAINBOW) - 1)).astype(np.intp)]


_RAINBOW = np.array(
    [[255 * channel for channel in colorsys.hsv_to_rgb(0.8 * (1.0 - step / 255.0), 1.0, 1.0)] for step in range(256)]
).astype(np.uint8)
"""The colors from violet to red."""


def _parse_rgb(text: str) -> NDArray[np.uint8]:
    return np.array([int(text[start : start + 2], 16) for start in (1, 3, 5)], dtype=np.uint8)


class _Grid:
    """The cells of a grid_map_msgs/msg/GridMap.

    Row 0 has the largest x, and column 0 has the largest y.

    Raises:
        BadGridError: the resolution, the lengths or the pose are not valid, or the numbers of layers and data differ.
    """

    def __init__(self, message: Any) -> None:
        info = message.info
        position = info.pose.position
        self._message = message
        self._center = np.array([position.x, position.y, position.z])
        orientation = info.pose.orientation
        self._quaternion = np.array([orientation.x, orientation.y, orientation.z, orientation.w])
        self._resolution = float(info.resolution)
        numbers = (info.resolution, info.length_x, info.length_y, *self._center, *self._quaternion)
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
                    "The map has {layers} layers, but data for {data} layers",
                    layers=len(message.layers),
                    data=len(message.data),
                )
            )

    def layer(self, name: str) -> NDArray[np.float32]:
        """Return the values of a layer, shape (rows, columns).

        The value of an unknown cell is not finite.

        Raises:
            BadGridError: there is no such layer, or it does not have one number for each cell.
        """
        names = list(self._message.layers)
        if name not in names:
            layer_names = quoted_names(names) if names else phrase("none")
            raise BadGridError(
                phrase("The map has no layer '{name}'; its layers are {known}", name=name, known=layer_names)
            )
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
        is_row_major = bool(array.layout.dim) and array.layout.dim[0].label == "row_index"
        cells = numbers.reshape(rows, columns) if is_row_major else numbers.reshape(columns, rows).T
        shift = (-int(self._message.outer_start_index), -int(self._message.inner_start_index))
        return np.ascontiguousarray(np.roll(cells, shift, axis=(0, 1)))

    def points(self, heights: NDArray[np.floating[Any]]) -> NDArray[np.float64]:
        """Return the cell centers at the given heights, in the message's frame.

        The heights are in meters and relative to the map's pose. The result has the shape (rows, columns, 3).
        """
        rows, columns = self.shape
        x_coordinates = (rows / 2.0 - 0.5 - np.arange(rows)) * self._resolution
        y_coordinates = (columns / 2.0 - 0.5 - np.arange(columns)) * self._resolution
        points = np.empty((rows, columns, 3))
        points[..., 0], points[..., 1], points[..., 2] = x_coordinates[:, None], y_coordinates[None, :], heights
        if self._quaternion.any():
            points = rotate(self._quaternion / np.linalg.norm(self._quaternion), points)
        points += self._center
        return points
