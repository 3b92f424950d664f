"""Compare worlds and models in SDF, also as templates."""
