"""Occupancy grids: planes of square cells in a frame."""
