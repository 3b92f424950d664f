"""Costmaps: what it costs a robot to be in a cell, from a map and from what sensors see."""
