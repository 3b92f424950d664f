"""Enrolled words of any language, recognized by their distance from the recordings."""
