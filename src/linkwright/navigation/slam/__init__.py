"""Mapping: scans are matched to each other, and where a robot comes back, the loop is closed."""
