"""Managed nodes, which have lifecycle states."""
