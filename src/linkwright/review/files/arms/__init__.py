"""Compare the semantic descriptions and planning groups of MoveIt."""
