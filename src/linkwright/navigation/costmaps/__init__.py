"""Costmaps: the cost for a robot to be in a cell, from maps and sensors, in layers as nav2 has them."""
