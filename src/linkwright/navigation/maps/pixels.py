"""Conversion between image pixels and cells of an occupancy grid, as in nav2_map_server."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.grids.grid import FREE, OCCUPIED, UNKNOWN
from linkwright.navigation.maps.images import MapImage
from linkwright.navigation.maps.map_yaml import MapMode, MapYaml

_FREE_GRAY, _UNKNOWN_GRAY = 254, 205
UNKNOWN_DARKNESS = 1.0 - _UNKNOWN_GRAY / 255.0
"""The darkness of pixels for unknown cells in the mode ``trinary``; a higher ``free_thresh`` reads them as free."""
_OPAQUE = 255


def cells_of_image(image: MapImage, map_yaml: MapYaml) -> NDArray[np.int8]:
    """Convert the pixels of an image to cells of an occupancy grid.

    Args:
        image: the pixels, from the top row down.
        map_yaml: the thresholds, the mode and whether black is free.

    Returns:
        Per cent or `UNKNOWN`, from the lowest row up, of the image's shape.
    """
    shade, opacity = image.shade[::-1], None if image.opacity is None else image.opacity[::-1]
    if map_yaml.mode is MapMode.RAW:
        gray = np.floor(shade * 255.0 + 0.5)
        return np.where(gray <= OCCUPIED, gray, UNKNOWN).astype(np.int8)
    if map_yaml.mode is MapMode.TRINARY and opacity is not None:
        shade = (shade * 3.0 + opacity) / 4.0  # nav2 counts opacity as a fourth color channel.
    darkness = shade if map_yaml.negate else 1.0 - shade
    if map_yaml.mode is MapMode.SCALE:
        threshold_span = map_yaml.occupied_thresh - map_yaml.free_thresh
        undecided = (
            np.rint((darkness - map_yaml.free_thresh) / threshold_span * 100.0)
            if threshold_span > 0.0
            else np.zeros_like(darkness)
        )
    else:
        undecided = np.full_like(darkness, UNKNOWN)
    cells = np.where(
        darkness > map_yaml.occupied_thresh, OCCUPIED, np.where(darkness < map_yaml.free_thresh, FREE, undecided)
    )
    if map_yaml.mode is MapMode.SCALE and opacity is not None:
        cells = np.where(opacity < 1.0, UNKNOWN, cells)
    return cells.astype(np.int8)


def pixels_of_cells(
    cells: NDArray[np.int8], mode: MapMode, occupied_thresh: float, free_thresh: float
) -> NDArray[np.uint8]:
    """Convert cells of an occupancy grid to the pixels of an image, from the top row down.

    Args:
        cells: the cells, percent or `UNKNOWN`, from the lowest row up.
        mode: the meaning of the pixels.
        occupied_thresh: the minimum probability of an occupied cell in the mode ``trinary``, 0 to 1.
        free_thresh: the maximum probability of a free cell in the mode ``trinary``, 0 to 1.

    Returns:
        Gray pixels, of the shape of the cells; in the mode ``scale``, gray and opacity, of shape (rows, columns, 2).
    """
    values = cells[::-1].astype(np.int16)
    is_known = (values >= 0) & (values <= 100)
    if mode is MapMode.RAW:
        return np.where(is_known, values, 255).astype(np.uint8)
    if mode is MapMode.SCALE:
        gray = np.where(is_known, np.rint((100 - values) / 100.0 * 255.0), 128)
        return np.stack((gray, np.where(is_known, _OPAQUE, 0)), axis=-1).astype(np.uint8)
    is_free = is_known & (values <= round(free_thresh * 100.0))
    is_occupied = is_known & (values >= round(occupied_thresh * 100.0))
    gray = np.where(is_free, _FREE_GRAY, np.where(is_occupied, 0, _UNKNOWN_GRAY))
    return gray.astype(np.uint8)
