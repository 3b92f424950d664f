"""RViz configuration files, displays and views, and message conversion for the page."""

from typing import TYPE_CHECKING

from linkwright.loading.deferred import deferred

if TYPE_CHECKING:
    from linkwright.rviz.config.locations import find_unsaved
    from linkwright.rviz.config.rviz_config import RvizConfig
    from linkwright.rviz.robot import estimate_size, has_visuals

__all__ = ["RvizConfig", "estimate_size", "find_unsaved", "has_visuals"]

__getattr__ = deferred(
    __name__,
    {
        "config.locations": ("find_unsaved",),
        "config.rviz_config": ("RvizConfig",),
        "robot": ("has_visuals", "estimate_size"),
    },
)
"""Loads a name on first use, so that the server can serve the page before this package is loaded."""
