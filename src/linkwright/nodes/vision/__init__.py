"""Nodes of object detection: boxes in pictures, positions in space, seeking."""
