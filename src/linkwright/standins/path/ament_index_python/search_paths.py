"""Stands in for ``ament_index_python.search_paths``."""

from linkwright.workspace.ament_resources import get_search_paths

__all__ = ["get_search_paths"]
