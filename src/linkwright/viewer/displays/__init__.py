"""The displays of the Displays panel, one file each."""

from linkwright.viewer.displays.base import Stage, ViewerDisplay, worst
from linkwright.viewer.displays.catalogue import display_classes, has_display, make_display
from linkwright.viewer.displays.grid import GridDisplay
from linkwright.viewer.displays.robot_model import RobotModelDisplay
from linkwright.viewer.displays.tf import TfDisplay
from linkwright.viewer.displays.unsupported import UnsupportedDisplay

__all__ = [
    "GridDisplay",
    "RobotModelDisplay",
    "Stage",
    "TfDisplay",
    "UnsupportedDisplay",
    "ViewerDisplay",
    "display_classes",
    "has_display",
    "make_display",
    "worst",
]
