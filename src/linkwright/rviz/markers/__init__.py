"""Markers: visualization_msgs in the form that pages draw."""

from linkwright.rviz.markers.shapes import BadMarkerError, MarkerReading, MarkerStore, read_marker

__all__ = ["BadMarkerError", "MarkerReading", "MarkerStore", "read_marker"]
