"""Point data from messages: positions, channels, and the colors of RViz's transformers."""

from linkwright.rviz.clouds.colors import AXES, TRANSFORMERS, ColorSettings, compute_colors, find_supported_transformers
from linkwright.rviz.clouds.depth import DepthCamera, DepthCloudBuilder
from linkwright.rviz.clouds.points import (
    BadCloudError,
    Points,
    ScanProjector,
    decimate,
    deskew,
    points_from_cloud,
    points_from_legacy_cloud,
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
    "compute_colors",
    "decimate",
    "deskew",
    "find_supported_transformers",
    "points_from_cloud",
    "points_from_legacy_cloud",
]
