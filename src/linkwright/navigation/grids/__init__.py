"""Occupancy grids: grids of square cells with a pose in a frame."""
