"""Nodes that hear commands and carry them out."""
