"""Readers for launch files (Python, XML, YAML) and for the substitutions in them."""
