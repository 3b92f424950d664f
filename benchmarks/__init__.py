"""Measurements of the project's promised figures, which are not tests."""
