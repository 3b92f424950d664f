"""Traced expansions, for the arguments, the provenance of elements and the log of properties."""
