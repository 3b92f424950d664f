"""Traced expansions, which yield the arguments, the provenance of elements and the log of properties."""
