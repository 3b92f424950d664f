"""Editing a robot in the page."""
