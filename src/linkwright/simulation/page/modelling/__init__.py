"""Modelling a world in the page."""
