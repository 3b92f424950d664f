"""Substitutes for the navigation packages that launch files include, with their share directories."""
