"""Worlds and models: reading SDF, resolving includes, and computing poses."""
