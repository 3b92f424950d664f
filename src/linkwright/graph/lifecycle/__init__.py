"""Managed nodes: nodes with lifecycle states."""
