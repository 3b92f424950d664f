"""Mapping by matching scans to each other and closing loops in a pose graph."""
