"""The viewer: .rviz files, displays and their data, and the page that shows them."""

from typing import TYPE_CHECKING

from linkwright.deferred import deferred

if TYPE_CHECKING:
    from linkwright.viewer.config.locations import find_unsaved
    from linkwright.viewer.config.rviz_config import RvizConfig
    from linkwright.viewer.robot import has_visuals
    from linkwright.viewer.size import size_of
    from linkwright.viewer.viewer import Viewer

__all__ = ["RvizConfig", "Viewer", "find_unsaved", "has_visuals", "size_of"]

__getattr__ = deferred(
    __name__,
    {
        "config.locations": ("find_unsaved",),
        "config.rviz_config": ("RvizConfig",),
        "robot": ("has_visuals",),
        "size": ("size_of",),
        "viewer": ("Viewer",),
    },
)
"""Deferred, so that the server can serve the page while the rest is loaded."""
