"""Worlds and models: reading SDF, finding what it includes, and where everything stands."""
