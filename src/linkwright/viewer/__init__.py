"""The viewer, a node of the graph whose window is a browser page, and views of recordings."""

from typing import TYPE_CHECKING

from linkwright.loading.deferred import deferred

if TYPE_CHECKING:
    from linkwright.viewer.viewer import Viewer

__all__ = ["Viewer"]

__getattr__ = deferred(__name__, {"viewer": ("Viewer",)})
"""Deferred, so that the server can serve the page while the rest is loaded."""
