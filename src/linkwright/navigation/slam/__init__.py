"""Mapping, in which scans are matched to each other and loops are closed in a pose graph."""
