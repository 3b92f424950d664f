"""Expansions that are traced, for what they tell: arguments, the provenance of elements, the log of properties."""
