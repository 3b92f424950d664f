"""Transforms over time, as in tf2, with broadcasters, listeners and buffers."""
