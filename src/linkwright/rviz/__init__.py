"""RViz configuration files, displays and views, and the conversion of messages for the page."""

from typing import TYPE_CHECKING

from linkwright.loading.deferred import deferred

if TYPE_CHECKING:
    from linkwright.rviz.config.locations import find_unsaved
    from linkwright.rviz.config.rviz_config import RvizConfig
    from linkwright.rviz.robot import has_visuals, size_of

__all__ = ["RvizConfig", "find_unsaved", "has_visuals", "size_of"]

__getattr__ = deferred(
    __name__,
    {
        "config.locations": ("find_unsaved",),
        "config.rviz_config": ("RvizConfig",),
        "robot": ("has_visuals", "size_of"),
    },
)
"""Loads a name on first use, so that the server can serve the page before this package is loaded."""
