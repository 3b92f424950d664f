"""Which class of display draws what a .rviz file names.

A display is imported when the first one of its class is made: most configurations have a few of them, and the program
is to be there at once.
"""

from __future__ import annotations

from importlib import import_module

from linkwright.viewer.displays.base import Stage, ViewerDisplay
from linkwright.viewer.displays.unsupported import UnsupportedDisplay
from linkwright.viewer.rviz_config import DisplayConfig

_PLUGINS = {
    "AccelStamped": "screws.AccelDisplay",
    "Axes": "axes.AxesDisplay",
    "Camera": "camera.CameraDisplay",
    "DepthCloud": "depth_cloud.DepthCloudDisplay",
    "Effort": "effort.EffortDisplay",
    "FluidPressure": "scalar_points.FluidPressureDisplay",
    "Grid": "grid.GridDisplay",
    "GridCells": "grid_cells.GridCellsDisplay",
    "Illuminance": "scalar_points.IlluminanceDisplay",
    "Image": "image.ImageDisplay",
    "InteractiveMarkers": "interactive_markers.InteractiveMarkersDisplay",
    "LaserScan": "laser_scan.LaserScanDisplay",
    "Map": "map.MapDisplay",
    "Marker": "marker.MarkerDisplay",
    "MarkerArray": "marker.MarkerArrayDisplay",
    "Odometry": "odometry.OdometryDisplay",
    "Path": "path.PathDisplay",
    "PointCloud": "point_cloud.PointCloudDisplay",
    "PointCloud2": "point_cloud2.PointCloud2Display",
    "PointStamped": "point_stamped.PointStampedDisplay",
    "Polygon": "polygon.PolygonDisplay",
    "Pose": "poses.PoseDisplay",
    "PoseArray": "poses.PoseArrayDisplay",
    "PoseWithCovariance": "poses.PoseWithCovarianceDisplay",
    "Range": "range.RangeDisplay",
    "RelativeHumidity": "scalar_points.RelativeHumidityDisplay",
    "RobotModel": "robot_model.RobotModelDisplay",
    "TF": "tf.TfDisplay",
    "Temperature": "scalar_points.TemperatureDisplay",
    "TwistStamped": "screws.TwistDisplay",
    "Wrench": "screws.WrenchDisplay",
}
"""For each display of rviz_default_plugins the module and the class that show it."""

_PLACES = {
    **{f"rviz_default_plugins/{name}": place for name, place in _PLUGINS.items()},
    "rviz_common/Group": "group.GroupDisplay",
}


def has_display(cls: str) -> bool:
    """Whether displays of a class are drawn, or are groups."""
    return cls in _PLACES


def display_classes() -> list[type[ViewerDisplay]]:
    """The classes of displays that are drawn, and groups."""
    return [_display_class(cls) for cls in _PLACES]


def make_display(stage: Stage, identity: str, config: DisplayConfig) -> ViewerDisplay:
    """The display for an entry of the file; an `UnsupportedDisplay` for a class that is not drawn."""
    made = _display_class(config.cls) if has_display(config.cls) else UnsupportedDisplay
    return made(stage, identity, config)


def _display_class(cls: str) -> type[ViewerDisplay]:
    module, _, name = _PLACES[cls].partition(".")
    found: type[ViewerDisplay] = getattr(import_module(f"linkwright.viewer.displays.{module}"), name)
    return found
