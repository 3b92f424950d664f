"""Point data from messages: positions, channels, and the colours of RViz's transformers."""

from linkwright.rviz.clouds.colours import AXES, TRANSFORMERS, ColourSettings, coloured, supported_transformers
from linkwright.rviz.clouds.depth import DepthCamera, DepthCloudBuilder
from linkwright.rviz.clouds.points import (
    BadCloudError,
    Points,
    ScanProjector,
    decimated,
    deskew,
    points_of_cloud,
    points_of_legacy_cloud,
)

__all__ = [
    "AXES",
    "TRANSFORMERS",
    "BadCloudError",
    "ColourSettings",
    "DepthCamera",
    "DepthCloudBuilder",
    "Points",
    "ScanProjector",
    "coloured",
    "decimated",
    "deskew",
    "points_of_cloud",
    "points_of_legacy_cloud",
    "supported_transformers",
]
