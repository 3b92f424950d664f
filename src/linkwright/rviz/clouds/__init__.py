"""Point data from messages: positions, channels, and the colors of RViz's transformers."""

from linkwright.rviz.clouds.colors import AXES, TRANSFORMERS, ColorSettings, colored, supported_transformers
from linkwright.rviz.clouds.depth import DepthCamera, DepthCloudBuilder
from linkwright.rviz.clouds.points import (
    BadCloudError,
    Points,
    ScanProjector,
    decimate,
    deskew,
    points_of_cloud,
    points_of_legacy_cloud,
)

__all__ = [
    "AXES",
    "TRANSFORMERS",
    "BadCloudError",
    "ColorSettings",
    "DepthCamera",
    "DepthCloudBuilder",
    "Points",
    "ScanProjector",
    "colored",
    "decimate",
    "deskew",
    "points_of_cloud",
    "points_of_legacy_cloud",
    "supported_transformers",
]
