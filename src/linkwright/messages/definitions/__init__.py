"""Finds and parses the definitions of interfaces, and computes their hashes."""
