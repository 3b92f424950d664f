"""The viewer: .rviz files, displays and their data, and the page that shows them."""

from linkwright.viewer.config.locations import find_unsaved
from linkwright.viewer.config.rviz_config import RvizConfig
from linkwright.viewer.robot import has_visuals
from linkwright.viewer.size import size_of
from linkwright.viewer.viewer import Viewer

__all__ = ["RvizConfig", "Viewer", "find_unsaved", "has_visuals", "size_of"]
