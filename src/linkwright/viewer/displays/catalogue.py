"""Which class of display draws what a .rviz file names."""

from __future__ import annotations

from linkwright.viewer.displays.base import Stage, ViewerDisplay
from linkwright.viewer.displays.grid import GridDisplay
from linkwright.viewer.displays.robot_model import RobotModelDisplay
from linkwright.viewer.displays.tf import TfDisplay
from linkwright.viewer.displays.unsupported import UnsupportedDisplay
from linkwright.viewer.rviz_config import DisplayConfig

_CLASSES: dict[str, type[ViewerDisplay]] = {
    display.CLASS: display for display in (GridDisplay, RobotModelDisplay, TfDisplay)
}


def make_display(stage: Stage, identity: str, config: DisplayConfig) -> ViewerDisplay:
    """The display for an entry of the file; an `UnsupportedDisplay` for a class that is not drawn."""
    return _CLASSES.get(config.cls, UnsupportedDisplay)(stage, identity, config)
