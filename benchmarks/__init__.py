"""Measurements of what the project promises; none of them is a test."""
