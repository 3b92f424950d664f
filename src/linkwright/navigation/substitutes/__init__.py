"""Substitutes for the navigation packages that launch files include: a prefix with their share directories."""
