"""Markers: what visualization_msgs says, as pages draw it."""

from linkwright.viewer.markers.shapes import BadMarkerError, MarkerReading, read_marker
from linkwright.viewer.markers.store import MarkerStore

__all__ = ["BadMarkerError", "MarkerReading", "MarkerStore", "read_marker"]
