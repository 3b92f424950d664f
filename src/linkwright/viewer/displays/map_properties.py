"""The properties of the Map display, those among them that only tell what the map is."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from linkwright.viewer.displays.look_properties import alpha
from linkwright.viewer.displays.topic_properties import topic_spec
from linkwright.viewer.property_store import Path, Schema
from linkwright.viewer.schema import PropertySpec

UPDATE_TOPIC = "Update Topic"
USE_TIMESTAMP = "Use Timestamp"
_BINARY = "Binary representation"


def _told(name: str, axes: str, description: str) -> PropertySpec:
    rest = tuple(PropertySpec(axis, "float", 1.0 if axis == "W" else 0.0, read_only=True) for axis in axes)
    return PropertySpec(name, "group", description=description, children=rest)


MAP_SCHEMA: Schema = (
    topic_spec(description="nav_msgs/msg/OccupancyGrid", filter_size=10),
    topic_spec(
        UPDATE_TOPIC,
        description="map_msgs/msg/OccupancyGridUpdate: the topic with updates of parts of the map; without one, the "
        "map's topic with '_updates' behind it.",
        messages=("map_msgs/msg/OccupancyGridUpdate",),
    ),
    alpha("Opacity of the map: 0 is invisible.", 0.7),
    PropertySpec(
        "Color Scheme", "enum", "map", "What colours the values of the cells have.", options=("map", "costmap", "raw")
    ),
    PropertySpec("Draw Behind", "bool", False, "Draw the map behind everything else, wherever it is."),
    PropertySpec("Resolution", "float", 0.0, "Side of a cell, in metres.", read_only=True),
    PropertySpec("Width", "int", 0, "Cells along x.", read_only=True),
    PropertySpec("Height", "int", 0, "Cells along y.", read_only=True),
    _told("Position", "XYZ", "Where the lower left corner is in the map's frame, in metres."),
    _told("Orientation", "XYZW", "How the map is turned in its frame."),
    PropertySpec(
        USE_TIMESTAMP, "bool", False, "Place the map where its frame was at the map's time, not where it is now."
    ),
    PropertySpec(_BINARY, "bool", False, "Show free and occupied only."),
    PropertySpec(
        "Binary threshold",
        "int",
        100,
        "The least value that counts as occupied.",
        minimum=0,
        maximum=100,
    ),
)


def readings(info: Any) -> Iterator[tuple[Path, float | int]]:
    """What the read-only properties show of a nav_msgs/msg/MapMetaData."""
    yield ("Resolution",), float(info.resolution)
    yield ("Width",), info.width
    yield ("Height",), info.height
    for name, part, axes in (
        ("Position", info.origin.position, "xyz"),
        ("Orientation", info.origin.orientation, "xyzw"),
    ):
        for axis in axes:
            yield (name, axis.upper()), float(getattr(part, axis))
