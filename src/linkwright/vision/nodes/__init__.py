"""Nodes of object detection: boxes in images, positions in space, seeking."""
