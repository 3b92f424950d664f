"""Mapping: scans are matched to each other, and loops are closed in a graph of poses."""
