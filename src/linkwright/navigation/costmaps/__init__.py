"""Costmaps, computed from maps and sensor data in layers as in nav2."""
