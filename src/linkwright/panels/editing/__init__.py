"""Editing of a robot in the page."""
