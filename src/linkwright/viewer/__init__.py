"""The viewer: a node of the graph with a page in the browser, and views of recordings."""

from typing import TYPE_CHECKING

from linkwright.loading.deferred import deferred

if TYPE_CHECKING:
    from linkwright.viewer.viewer import Viewer

__all__ = ["Viewer"]

__getattr__ = deferred(__name__, {"viewer": ("Viewer",)})
"""Loads a name on first use, so that the server can serve the page before this package is loaded."""
