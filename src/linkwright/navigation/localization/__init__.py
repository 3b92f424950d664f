"""Localization on a known map by a particle filter."""
