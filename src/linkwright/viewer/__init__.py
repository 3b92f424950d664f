"""The viewer: .rviz files, displays and their data, and the page that shows them."""

from linkwright.viewer.recovery import find_unsaved
from linkwright.viewer.rviz_config import RvizConfig
from linkwright.viewer.viewer import Viewer

__all__ = ["RvizConfig", "Viewer", "find_unsaved"]
