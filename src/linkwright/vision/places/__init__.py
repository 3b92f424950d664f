"""Positions of detected objects, tracking, and seeking."""
