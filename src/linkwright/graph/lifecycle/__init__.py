"""Managed nodes. They have lifecycle states."""
