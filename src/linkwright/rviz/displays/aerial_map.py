"""The display rviz_satellite/AerialMap, with tiles of a local folder."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.messages import get_message
from linkwright.rviz.config.schema import FIXED_FRAME, PropertySpec, alpha, topic_spec
from linkwright.rviz.displays.message_drawing import Marker, make_marker
from linkwright.rviz.displays.placed_markers import PlacedMarkersDisplay

_UV = get_message("visualization_msgs/msg/UVCoordinate")
_NO_FIX = get_message("sensor_msgs/msg/NavSatStatus").STATUS_NO_FIX
_URI = "Object URI"
_MAP = "Map"
_EQUATOR_M = 2 * math.pi * 6378137.0
"""The length of the equator of WGS 84, on which the tiles of the Web Mercator projection are based."""

_MAX_LATITUDE_DEG = 85.05
_MAX_ZOOM = 22
_HALF_PIXEL = 0.5 / 256
"""Half of a pixel of a tile, relative to its side."""

_CORNERS = ((0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1))
"""The corners of the two triangles of a tile: the shares of its width to the east, and of its height to the south."""


class AerialMapDisplay(PlacedMarkersDisplay):
    """A display of aerial images around a position of GNSS, on the ground, with x to the east and y to the north.

    Tiles come from a local folder only: no request goes to a server of maps.
    """

    CLASS = "rviz_satellite/AerialMap"
    MESSAGE = "sensor_msgs/msg/NavSatFix"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        alpha("Opacity of the images.", 0.7),
        PropertySpec(
            _URI,
            "string",
            "",
            "The files of the tiles, such as file:///home/me/tiles/{z}/{x}/{y}.png; no server is asked.",
        ),
        PropertySpec("Zoom", "int", 16, "The level of the tiles.", minimum=0, maximum=_MAX_ZOOM),
        PropertySpec("Blocks", "int", 3, "The number of tiles around the one in the middle.", minimum=0, maximum=8),
    )

    def markers(self, message: Any) -> Iterator[Any]:
        """Return the tiles around the position."""
        latitude, longitude, zoom = message.latitude, message.longitude, int(self.properties.number("Zoom"))
        if message.status.status == _NO_FIX or not self.is_finite(latitude, longitude):
            return
        if abs(latitude) > _MAX_LATITUDE_DEG:
            self.set_status_row(_MAP, "error", phrase("There are no tiles so close to a pole"))
            return
        if not self._is_local():
            text = phrase(
                "Only tiles of a local folder are drawn: set {property} to file:///folder/{pattern}.png",
                property=_URI,
                pattern="{z}/{x}/{y}",
            )
            self.set_status_row(_MAP, "error", text)
            return
        x, y = compute_tile_position(latitude, longitude, zoom)
        size = _EQUATOR_M * math.cos(math.radians(latitude)) / 2**zoom
        blocks, count = int(self.properties.number("Blocks")), 2**zoom
        missing, number = [], 0
        for row in range(max(0, int(y) - blocks), min(count, int(y) + blocks + 1)):
            for column in range(int(x) - blocks, int(x) + blocks + 1):
                address = self._find_address(zoom, column % count, row)
                if _is_missing(address):
                    missing.append(address)
                else:
                    yield self._make_tile(number, (column - x) * size, (y - row) * size, size, address)
                number += 1
        self._report(missing, number)

    def _report(self, missing: list[str], count: int) -> None:
        """Show in the status how many of the tiles are missing."""
        if not missing:
            self.delete_status_row(_MAP)
            return
        text = phrase(
            "{missing} of {count} tiles are missing, such as {address}",
            missing=len(missing),
            count=count,
            address=missing[0],
        )
        self.set_status_row(_MAP, "error" if len(missing) == count else "warn", text)

    def _find_address(self, zoom: int, column: int, row: int) -> str:
        text = self.properties.text(_URI).strip()
        for key, index in (("z", zoom), ("x", column), ("y", row)):
            text = text.replace(f"{{{key}}}", str(index))
        return text

    def _make_tile(self, number: int, east: float, north: float, size: float, address: str) -> Any:
        """Return a tile, whose north-west corner is at a distance from the position."""
        shares = np.array(_CORNERS, dtype=np.float64)
        corners = np.column_stack([east + size * shares[:, 0], north - size * shares[:, 1], np.zeros(len(shares))])
        corners += self.frame_pose[:3]
        colors = np.tile((1.0, 1.0, 1.0, self.properties.number("Alpha")), (len(corners), 1))
        white = (1.0, 1.0, 1.0, 1.0)
        marker = make_marker(
            "tiles", number, Marker.TRIANGLE_LIST, white, scale=(1, 1, 1), points=corners, colors=colors
        )
        marker.header.frame_id = FIXED_FRAME
        marker.texture_resource = address
        marker.uv_coordinates = [_UV(u=_inset(right), v=_inset(1 - down)) for right, down in _CORNERS]
        return marker

    def _is_local(self) -> bool:
        text = self.properties.text(_URI).strip()
        return text.startswith(("file://", "package://", "/")) and "{x}" in text and "{y}" in text


def _is_missing(address: str) -> bool:
    """Return whether a tile of a folder does not exist; addresses of packages are found later."""
    return not address.startswith("package://") and not Path(address.removeprefix("file://")).is_file()


def _inset(share: float) -> float:
    """Return a place in an image, half a pixel from its edge, because textures repeat beyond it."""
    return _HALF_PIXEL + share * (1 - 2 * _HALF_PIXEL)


def compute_tile_position(latitude: float, longitude: float, zoom: int) -> tuple[float, float]:
    """Return the position of a place in tiles of the Web Mercator projection, from the north-west corner of the map.

    Args:
        latitude: degrees to the north.
        longitude: degrees to the east.
        zoom: the level, at which the map has 2 ** `zoom` tiles in each direction.
    """
    count = 2**zoom
    x = (longitude + 180.0) / 360.0 * count
    y = (1.0 - math.asinh(math.tan(math.radians(latitude))) / math.pi) / 2.0 * count
    return x, y
