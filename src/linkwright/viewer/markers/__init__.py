"""Markers: what visualization_msgs says, as pages draw it."""

from linkwright.viewer.markers.shapes import BadMarkerError, MarkerReading, MarkerStore, read_marker

__all__ = ["BadMarkerError", "MarkerReading", "MarkerStore", "read_marker"]
