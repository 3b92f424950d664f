"""Occupancy grids: planes of square cells."""
