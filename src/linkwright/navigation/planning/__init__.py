"""Paths through costmaps."""
