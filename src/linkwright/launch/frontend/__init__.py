"""Readers of launch files (Python, XML, YAML) and of the substitutions in them."""
