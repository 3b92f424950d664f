"""Enrolled words of any language, recognised by their distance from the recordings."""
