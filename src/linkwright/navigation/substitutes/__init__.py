"""Substitutes for navigation packages that launch files use, with share directories."""
