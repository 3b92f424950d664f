"""Costmaps: the cost of each cell for a robot, computed from maps and sensors in layers as in nav2."""
