"""Occupancy in space from point clouds."""
